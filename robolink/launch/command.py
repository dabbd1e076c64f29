"""The launcher behind `robolink launch`: runs the nodes and commands of a launch file under one supervisor."""

from __future__ import annotations

import contextlib
import functools
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.exceptions import RobolinkError
from robolink.launch import beside
from robolink.launch.entry import Entry
from robolink.launch.planning import Launched, as_process, core_errors, processes
from robolink.launch.readiness import waiting
from robolink.networks.request import domain_id
from robolink.supervisor import Process, RunLogs, Supervisor
from robolink.supervisor.processes.fork_server import ForkServer
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child
from robolink.system.processes import own_command
from robolink.workspace import VARIABLE

if TYPE_CHECKING:
    from robolink.launch.entry import Direct
    from robolink.supervisor.director import Director
    from robolink.supervisor.events import Event

FORK_SERVER = "fork-server"
"""Hidden sub-command of `robolink` that is forked for each node; not for people."""

NODES_PER_CORE = 2
"""Number of nodes for each core from which on it is faster to import once and to fork than to import side by side."""


def launch(
    entries: Sequence[Entry],
    path: Path,
    *,
    duration: float | None = None,
    on_event: Callable[[Event], object] | None = None,
    watches: bool = False,
    shows_figures: bool = False,
    record: str | None = None,
    shows_view: bool = False,
    enclave: str = "",
    notes: Iterable[str] = (),
    direct: Direct | None = None,
) -> int:
    """Run a system until Ctrl-C, the end of `duration`, or the end of a process that ends the system.

    Args:
        entries: The nodes and commands, as `read_launch_file` returns them.
        path: Their launch file, whose name other shells use to find this system.
        duration: Longest run in seconds; None has no limit.
        on_event: Called with each event of the supervisor; without it, events are printed to the terminal.
        watches: True restarts nodes when their files are saved; the end of a node then never ends the system.
        shows_figures: True prints the CPU and memory use of the processes from time to time.
        record: Folder of a bag that gets all that the system publishes, '' for one with the date in its name; None
            records nothing.
        shows_view: True runs `robolink view` beside the nodes; its end does not end the system.
        enclave: Enclave with whose keys it is recorded, viewed and waited for, where security is on. '' is `/`, and for
            the launcher that of the file's first node that has one.
        notes: Lines to print first: where the system is seen, and the launch file's own.
        direct: Maker of the director that starts and stops more while the system runs; None has none.

    Returns:
        The exit code of the system.

    Raises:
        DocumentError: if nodes cannot run as the file says; nothing was started then.
        BagError: (a ValueError) if the bag's folder is there already.
        SecurityError: if recorder or view cannot have keys that they must have; nothing was started then.
    """
    from robolink.supervisor.control.server import Control

    _check_cores(entries)
    launched = processes(entries)
    held = {each.name: each.held_by for each in launched if each.held_by}
    members = {each.name: [entry.name for entry in each.entries] for each in launched if each.entries[0].node.process}
    to_run = _to_run(launched, watches)
    beside.check_keys(enclave, {"recorder": record is not None, "view": shows_view})
    if record is not None:
        to_run = [beside.recorder(record, enclave), *beside.behind(to_run)]
        held = {each.name: (*each.held_by, beside.READY) for each in launched}
    if shows_view:
        to_run.append(beside.view({each.name for each in to_run}, enclave))
    with contextlib.ExitStack() as stack:
        output = None if on_event is None else stack.enter_context(Path(os.devnull).open("w", encoding="utf-8"))
        server = None if watches else _fork_server(to_run)  # whoever saves files may save robolink's own
        start: Callable[[Process, Lifeline], Child] = Child
        if server is not None:
            start = functools.partial(Child, server=stack.enter_context(contextlib.closing(server)))
        director, logs = _director(direct, watches, stack), RunLogs(path.stem)
        supervisor = Supervisor(to_run, output=output, logs=logs, on_event=on_event, start=start, director=director)
        nodes, domain = [each.full_name for each in entries if each.source is not None], _domain()
        warn = functools.partial(supervisor.say, severity="WARN")
        for line in notes:
            supervisor.say(line, getattr(line, "severity", "INFO"))
        for line in (*beside.unprotected(entries, os.environ), *doubled(nodes, domain)):
            warn(line)
        if server is not None:
            server.is_end_requested = lambda: supervisor.is_end_requested
        parts: list[contextlib.AbstractContextManager[object]] = [
            Control(supervisor, name=path.stem, file=str(path.resolve()), members=members, nodes=nodes, domain=domain)
        ]
        if watches:
            parts.append(beside.watch(launched, path, supervisor))
        if shows_figures:
            from robolink.supervisor.monitoring.resources import Figures

            parts.append(Figures(supervisor.status, say=supervisor.say))
        watch = waiting(held, supervisor.release, warn, enclave=enclave or _enclave(entries))
        return supervisor.run(duration, [*parts, watch])


def _check_cores(entries: Sequence[Entry]) -> None:
    for error in core_errors(entries):
        raise error


def _domain() -> int:
    """Return the domain of the nodes; one that is invalid is told by the first of them."""
    try:
        return domain_id(os.environ)
    except RobolinkError:
        return -1


def doubled(nodes: Sequence[str], domain: int) -> Iterator[str]:
    """Yield a line about each launcher that has started nodes of the same names on this domain."""
    from robolink.supervisor.control.client import running

    try:
        others = running()
    except RobolinkError:  # the control server tells of it
        return
    for other in others:
        both = [each for each in nodes if each in other.nodes] if other.domain == domain else []
        if both:
            more = f" and {len(both) - 2} more" if len(both) > 2 else ""
            yield (
                f"{other} has nodes of the same names, {' and '.join(both[:2])}{more}: both are heard and obeyed; "
                "end one by `robolink launch stop`, or give it another ROS_DOMAIN_ID"
            )


def _director(
    direct: Direct | None, watches: bool, stack: contextlib.ExitStack
) -> Callable[[Supervisor], Director[Process]] | None:
    """Return the maker of a supervisor's director; what is added is planned as the rest. None where nothing goes on."""
    if direct is None:
        return None
    from robolink.launch.ros.stage import ProcessStage

    return lambda supervisor: direct(
        stack.enter_context(ProcessStage(supervisor, lambda added: _to_run(processes(added), watches)))
    )


def _enclave(entries: Iterable[Entry]) -> str:
    """Return the enclave of a node, by whose keys the launcher sees when the others are there; '' if none has one."""
    return next((each.node.enclave for each in entries if each.node.enclave), "")


def _to_run(launched: Iterable[Launched], watches: bool) -> list[Process]:
    """Return the processes. While files are watched a crash must not end the system: it is just being fixed."""
    found = [as_process(each) for each in launched]
    mended = (replace(each, rules=replace(each.rules, on_exit="ignore", awaits=frozenset())) for each in found)
    return list(mended) if watches else found


def _fork_server(to_run: Iterable[Process]) -> ForkServer | None:
    """Return a fork server, if so many of the processes can be forked that it pays."""
    server = ForkServer(own_command(), [FORK_SERVER], [VARIABLE])
    count = sum(server.can_become(each.argv, each.env) for each in to_run)
    return server if count >= NODES_PER_CORE * (os.cpu_count() or 1) else None
