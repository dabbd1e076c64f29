"""Turn the nodes of a launch file into processes, and run them as one system."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.exceptions import DocumentError, NotFoundError, RobolinkError
from robolink.launch.checks import absolute, flattened
from robolink.launch.copies import Copy, copies
from robolink.launch.description import LaunchDescription, NodeDescription
from robolink.launch.file import read_launch_file
from robolink.launch.together import COMMAND, Member, written
from robolink.supervisor import Process, Supervisor
from robolink.workspace import (
    VARIABLE,
    Folder,
    NodeSource,
    built_in_workspace,
    find_node,
    own_process_needed,
    user_workspace,
    workspace_of,
)
from robolink.yamlfile import Document, spell

PYTHON = (sys.executable, "-m", "robolink")


def launch(path: Path, *, workspace: Folder = None, duration: float | None = None) -> int:
    """Run a launch file until its first process ends, Ctrl-C, or `duration` seconds; give the exit code.

    Raises `DocumentError`, before anything is started, for whatever is wrong in the file.
    """
    return Supervisor(plan(path, workspace=workspace)).run(duration)


def plan(path: Path, *, workspace: Folder = None, text: str | None = None) -> list[Process]:
    """Give the processes that a launch file (or `text` in its place) stands for.

    Nodes are looked up in the launch file's own workspace, or, when it came with robolink, in the user's first.
    """
    document = read_launch_file(path, text=text)
    home = home_of(path, workspace)
    sources = [_source(document, index, home, path.parent) for index in range(len(document.value.nodes))]
    groups: dict[str, list[_Named]] = {}
    for each in _named(document, sources):
        groups.setdefault(each.process, []).append(each)
    for group in groups.values():
        _check_group(document, group)
    env = {} if home is None else {VARIABLE: str(home)}
    return [_process(group, env) for group in groups.values()]


def home_of(path: Path, workspace: Folder) -> Path | None:
    """Give the workspace in which a launch file's nodes, worlds and files are looked up first."""
    own = workspace_of(path.parent)
    return user_workspace(workspace) if own is None or own == built_in_workspace() else own


def arguments(node: NodeDescription) -> Iterator[str]:
    """Give the arguments of a node's program: its own, then those for ROS."""
    yield from map(str, node.args)
    yield "--ros-args"
    if node.name:
        yield from ("-r", f"__node:={node.name}")
    if node.namespace:
        yield from ("-r", f"__ns:={absolute(node.namespace)}")
    for name, _, value in flattened(node.parameters):
        yield from ("-p", f"{name}:={spell(value)}")
    for match, replacement in node.remappings.items():
        yield from ("-r", f"{match}:={replacement}")


class _Named(NamedTuple):
    """A node to start, under the name by which users are told of it."""

    name: str
    copy: Copy
    source: NodeSource

    @property
    def process(self) -> str:
        """The name of the process that it runs in."""
        return self.copy.node.process or self.name


def _process(group: list[_Named], env: dict[str, str]) -> Process:
    (name, copy, source), own = group[0], group[0].process
    if not copy.node.process:
        command = [*PYTHON, "run", source.spec, "--", *arguments(copy.node)]
        return Process(name, command, env=env, interactive=copy.node.interactive)
    members = [Member(each.name, each.source.spec, list(arguments(each.copy.node))) for each in group]
    return Process(own, [*PYTHON, COMMAND], env=env, input=written(members))


def _source(document: Document[LaunchDescription], index: int, home: Path | None, folder: Path) -> NodeSource:
    """Find a node; a file that has no workspace around it is looked for beside the launch file too."""
    name = document.value.nodes[index].node
    beside = folder / name
    if home is None and name.endswith(".py") and beside.is_file():
        return NodeSource(beside.stem, beside.resolve())
    try:
        return find_node(name, workspace=home)
    except NotFoundError as error:
        raise document.error(["nodes", index, "node"], str(error)) from None


def _named(document: Document[LaunchDescription], sources: list[NodeSource]) -> list[_Named]:
    """Give each node the name under which its lines are printed; two nodes cannot have the same."""
    named: dict[str, _Named] = {}
    for copy in copies(document):
        source = sources[copy.entry]
        namespace, own = copy.node.namespace.strip("/"), copy.node.name or source.name
        name = f"{namespace}/{own}" if namespace else own
        if name in named:
            raise _twice(document, copy, named[name].copy, name)
        named[name] = _Named(name, copy, source)
    return list(named.values())


def _twice(document: Document[LaunchDescription], copy: Copy, other: Copy, name: str) -> DocumentError:
    if copy.entry == other.entry:
        reason = f"two of the copies are called '{name}': put {{i}} into `name` or `namespace`"
        return document.error([*copy.place, "count"], reason)
    at = "name" if copy.written.name else "node"
    return document.error([*copy.place, at], f"two nodes are called '{name}': give this one another `name`")


def _check_group(document: Document[LaunchDescription], group: list[_Named]) -> None:
    """Refuse a process that is called as a node is which has its own, and nodes that cannot share one."""
    sharing = [each for each in group if each.copy.node.process]
    if sharing and len(sharing) < len(group):
        reason = f"'{sharing[0].process}' is what a node is called that has its own process: give another name"
        raise document.error([*sharing[0].copy.place, "process"], reason)
    for index, source in {each.copy.entry: each.source for each in sharing}.items():
        try:
            reason = own_process_needed(source)
        except RobolinkError as error:
            reason = str(error)
        if reason:
            raise document.error(["nodes", index, "node"], reason)
