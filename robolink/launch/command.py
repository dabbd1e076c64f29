"""Turn the nodes of a launch file into processes, and run them as one system."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from robolink.exceptions import DocumentError, NotFoundError
from robolink.launch.file import LaunchDescription, NodeDescription, absolute, parameters_of, read_launch_file
from robolink.supervisor import Process, Supervisor
from robolink.workspace import VARIABLE, Folder, NodeSource, built_in_workspace, find_node, user_workspace, workspace_of
from robolink.yamlfile import Document


def launch(path: Path, *, workspace: Folder = None, duration: float | None = None) -> int:
    """Run a launch file until its first node ends, Ctrl-C, or `duration` seconds; give the exit code.

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
    names = _names(document, sources)
    env = {} if home is None else {VARIABLE: str(home)}
    nodes = zip(names, document.value.nodes, sources, strict=True)
    return [
        Process(name, list(command(node, source)), env=env, interactive=node.interactive)
        for name, node, source in nodes
    ]


def home_of(path: Path, workspace: Folder) -> Path | None:
    """Give the workspace in which a launch file's nodes, worlds and files are looked up first."""
    own = workspace_of(path.parent)
    return user_workspace(workspace) if own is None or own == built_in_workspace() else own


def command(node: NodeDescription, source: NodeSource) -> Iterator[str]:
    """Give the command line that runs one node."""
    yield from (sys.executable, "-m", "robolink", "run", source.spec, "--", *map(str, node.args), "--ros-args")
    if node.name:
        yield from ("-r", f"__node:={node.name}")
    if node.namespace:
        yield from ("-r", f"__ns:={absolute(node.namespace)}")
    for name, value in parameters_of(node):
        yield from ("-p", f"{name}:={value}")
    for match, replacement in node.remappings.items():
        yield from ("-r", f"{match}:={replacement}")


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


def _names(document: Document[LaunchDescription], sources: list[NodeSource]) -> list[str]:
    """Give each node the name under which its lines are printed; two nodes cannot have the same."""
    names: list[str] = []
    for index, node in enumerate(document.value.nodes):
        namespace = node.namespace.strip("/")
        own = node.name or sources[index].name
        name = f"{namespace}/{own}" if namespace else own
        if name in names:
            raise _twice(document, index, name)
        names.append(name)
    return names


def _twice(document: Document[LaunchDescription], index: int, name: str) -> DocumentError:
    at = "name" if document.value.nodes[index].name else "node"
    return document.error(["nodes", index, at], f"two nodes are called '{name}': give this one another `name`")
