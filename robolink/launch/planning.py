"""Process planning: groups the entries of a launch file into processes with command line, environment and rules."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

from robolink.arguments.command_line import CHILD_PARAMETER, WIDE_PARAMETER
from robolink.documents.yamlfile import spell
from robolink.exceptions import DocumentError, RobolinkError
from robolink.launch.entry import Entry, NodeToStart, Respawn
from robolink.launch.readiness import Awaited, awaited
from robolink.launch.reading.entries import read_launch_file
from robolink.launch.shared_process import COMMAND, Member, written
from robolink.networks.request import NETWORK
from robolink.supervisor import Process
from robolink.supervisor.policy import Restarts, Rules
from robolink.system.processes import Variables, own_command
from robolink.workspace import VARIABLE, Folder, NodeSource, own_process_needed

_ROOM = 16_000
"""Longest command line, in characters: Windows allows 32,767 with quotes, Linux 131,071 for each argument."""

LIMITS = "ROBOLINK_LIMITS"
"""Environment variable of the limits of slow links."""

SHARED = ("respawn", "on_exit", "env", "cpu", "enclave")
"""Launch keys that belong to a process, so that all nodes of a shared one must agree on them."""


@dataclass(frozen=True)
class Launched:
    """A planned process of a system: one or more nodes, or a command.

    `name` is unique in the system. `entries` are the nodes or the command of the launch file, `members` the nodes as
    the process is told of them. `rules` say when it starts again and what its end means. An `interactive` one reads the
    keyboard; `cpu` has the cores, from 0, on which it may run, none for all.
    """

    name: str
    entries: tuple[Entry, ...]
    members: tuple[Member, ...]
    command: tuple[str, ...]
    """The command and its arguments; empty where there are members."""
    env: Variables
    """Variables that are added to the environment; None takes one out."""
    rules: Rules
    held_by: tuple[Awaited, ...]
    """Nodes, topics and services that must be announced before it is started."""
    interactive: bool
    cpu: tuple[int, ...]
    prefix: tuple[str, ...] = ()
    """Words before the command line, such as those of a debugger."""
    cwd: str = ""
    """Working directory; '' is the launcher's."""


def core_errors(entries: Iterable[Entry]) -> Iterator[DocumentError]:
    """Yield an error for each node that is bound to a CPU core which this computer does not have."""
    from robolink.supervisor.processes.affinity import CoreError, check_cores

    for each in entries:
        try:
            if each.node.cpu:
                check_cores(each.node.cpu)
        except CoreError as error:
            yield each.error(["cpu"], str(error))


def plan(
    path: Path, given: Mapping[str, str] | None = None, *, workspace: Folder = None, text: str | None = None
) -> list[Process]:
    """Read a launch file and return its processes for a `Supervisor`.

    Args:
        path: The launch file.
        given: Launch arguments by name, as people type them; None gives none.
        workspace: Folder in which nodes are looked up; None finds the nearest one.
        text: Content to read in place of the file's.

    Raises:
        DocumentError: for a mistake in the file, with `file:line:column`.
        NotFoundError: for a `workspace` that is not a folder.
    """
    entries = read_launch_file(path, given or {}, workspace=workspace, text=text)
    network = network_of(entries, os.environ)
    return [_on(network, as_process(each)) for each in processes(entries)]


def network_of(entries: Sequence[Entry], environ: Mapping[str, str]) -> dict[str, str]:
    """Return the variables of its launch file's network and limits that the environment has not set already."""
    said = {NETWORK: entries[0].network, LIMITS: entries[0].limits} if entries else {}
    return {name: value for name, value in said.items() if value and not environ.get(name)}


def _on(network: Mapping[str, str], process: Process) -> Process:
    return replace(process, env={**network, **process.env}) if network else process


def processes(entries: Iterable[Entry]) -> list[Launched]:
    """Return the processes in which the nodes and commands of `entries` run, in the order of the file.

    Raises `DocumentError` where nodes cannot share a process, or wait for each other.
    """
    everything, able = list(entries), set[NodeSource]()
    groups: dict[str, list[Entry]] = {}
    for each in everything:
        groups.setdefault(process_of(each), []).append(each)
    for group in groups.values():
        _check_group(group, able)
    _check_circles(everything)
    named = {each.full_name: each for each in everything}
    return [_launched(name, group, named) for name, group in groups.items()]


def process_of(entry: Entry) -> str:
    """Return the name of the process in which a node runs."""
    return entry.node.process or entry.name


def as_process(launched: Launched) -> Process:
    """Return the supervisor's `Process`: a command runs as it is, nodes are run by robolink."""
    argv, stdin = _words(launched), b""
    if not argv or (launched.members and sum(map(len, argv)) > _ROOM and not launched.interactive):
        argv, stdin = [*own_command(), COMMAND], written(launched.members)
    return Process(
        launched.name,
        argv,
        env=launched.env,
        cwd=launched.cwd or None,
        interactive=launched.interactive,
        input=stdin,
        rules=launched.rules,
        cpu=launched.cpu,
        holds_interrupts=bool(launched.members),
    )


def _words(launched: Launched) -> list[str]:
    """Return the command line of a command or of a node that runs alone; empty for nodes that share a process."""
    if not launched.members:
        return list(launched.command)
    member = launched.members[0]
    if launched.entries[0].node.process:
        return []
    return [*launched.prefix, *own_command(), "run", member.node, "--", *member.args]


def _launched(name: str, group: list[Entry], named: Mapping[str, Entry]) -> Launched:
    first = group[0].node
    held_by = dict.fromkeys(each for entry in group for each in awaited(entry, named))
    return Launched(
        name,
        tuple(group),
        tuple(Member(each.name, each.source.spec, list(arguments(each))) for each in group if each.source is not None),
        (*first.run, *first.args) if group[0].source is None else (),
        environment(group[0]),
        Rules(_restarts(first.respawn), first.on_exit, bool(held_by), _awaited_processes(group, named)),
        tuple(held_by),
        first.interactive,
        first.cpu,
        tuple(first.prefix),
        first.cwd,
    )


def _awaited_processes(group: Iterable[Entry], named: Mapping[str, Entry]) -> frozenset[str]:
    nodes = {target.node for entry in group for target in entry.node.start_after}
    return frozenset(process_of(named[each]) for each in nodes if each in named)


def _restarts(respawn: Respawn) -> Restarts:
    return Restarts(respawn.when, respawn.delay, respawn.delay_max, respawn.most, respawn.within)


def _check_group(group: list[Entry], able: set[NodeSource]) -> None:
    """Raise DocumentError if nodes cannot share a process, or if its name is also that of a node outside of it.

    `able` gets the sources that can: those of copies are parsed once.
    """
    sharing = [each for each in group if each.node.process]
    if sharing and len(sharing) < len(group):
        reason = f"'{process_of(sharing[0])}' is what a node is called that has its own process: give another name"
        raise sharing[0].error(["process"], reason)
    for each in sharing:
        if each.source is None or each.source not in able:
            able.add(_able_to_share(each))
        _check_agrees(each, sharing[0])


def _able_to_share(entry: Entry) -> NodeSource:
    """Return the source of a node that can share a process; raise DocumentError if it cannot."""
    if entry.source is None:
        raise entry.error(["process"], "a command is a process of its own: leave `process` out")
    try:
        reason = own_process_needed(entry.source)
    except RobolinkError as error:
        reason = str(error)
    if reason:
        raise entry.error(["node"], reason)
    return entry.source


def _check_agrees(entry: Entry, first: Entry) -> None:
    for key in SHARED:
        if getattr(entry.node, key) != getattr(first.node, key):
            reason = f"'{first.name}' runs in the same process, and has another `{key}`: a process has only one"
            raise entry.error([key], reason)
    if entry.home != first.home:
        reason = f"'{first.name}' runs in the same process, and is of another workspace: leave `process` out"
        raise entry.error(["node"], reason)


def _check_circles(entries: Sequence[Entry]) -> None:
    """Raise DocumentError for a cycle in the topological order: processes that wait for each other never start."""
    waits: dict[str, dict[str, Entry]] = {}
    process_by_node = {each.full_name: process_of(each) for each in entries}
    for each in entries:
        names = (target.node for target in each.node.start_after if target.node in process_by_node)
        waits.setdefault(process_of(each), {}).update({process_by_node[name]: each for name in names})
    try:
        TopologicalSorter(waits).prepare()
    except CycleError as error:
        raise _circle_error(error.args[1][::-1], waits) from None


def _circle_error(circle: list[str], waits: Mapping[str, Mapping[str, Entry]]) -> DocumentError:
    """Return the error about a cycle of processes: each waits for the next, the last one is the first again."""
    first = min(circle, key=list(waits).index)
    at = circle.index(first)
    circle = [*circle[at:], *circle[1 : at + 1]]
    entry = waits[first][circle[1]]
    if len(circle) == 2:
        return entry.error(["start_after"], "it would wait for itself, or for a node of its own process")
    return entry.error(["start_after"], f"nothing of it would ever start: {' waits for '.join(circle)}")


# Command line and environment of one node


def arguments(entry: Entry) -> Iterator[str]:
    """Yield the arguments of a node's program: its own, then those behind `--ros-args`, if there are any."""
    yield from entry.node.args
    for_ros = [*_for_ros(entry.node, entry.wide)]
    if for_ros:  # a program that counts its words gets no more than it is given
        yield from ("--ros-args", *for_ros)


def _for_ros(node: NodeToStart, wide: Collection[str]) -> Iterator[str]:
    if node.name:
        yield from ("-r", f"__node:={node.name}")
    if node.namespace:
        yield from ("-r", f"__ns:={node.namespace}")
    for name, value in node.parameters.items():
        flag = CHILD_PARAMETER if ":" in name else WIDE_PARAMETER if name in wide else "-p"
        yield from (flag, f"{name}:={spell(value)}")
    for match, replacement in node.remappings.items():
        yield from ("-r", f"{match}:={replacement}")
    if node.log_level:
        yield from ("--log-level", node.log_level)
    if node.enclave:
        yield from ("--enclave", node.enclave)


def environment(entry: Entry) -> dict[str, str | None]:
    """Return the changes of a node's environment: its workspace, and the variables of the file."""
    home = {} if entry.home is None else {VARIABLE: str(entry.home)}
    return {**home, **entry.node.env}
