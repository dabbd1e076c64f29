"""Run the nodes and commands of a launch file as one system: `robolink launch`."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from robolink.launch.planning import Launched, as_process, core_errors, processes
from robolink.launch.readiness import waiting
from robolink.launch.reading.entry import Entry
from robolink.supervisor import Process, RunLogs, Supervisor

if TYPE_CHECKING:
    from robolink.supervisor.events import Event
    from robolink.supervisor.watching.watch import Watch


def launch(
    entries: Sequence[Entry],
    path: Path,
    *,
    duration: float | None = None,
    on_event: Callable[[Event], object] | None = None,
    watches: bool = False,
    shows_figures: bool = False,
) -> int:
    """Run a system until a process ends whose end is the system's, Ctrl-C, or `duration` seconds; give the exit code.

    `path` is its launch file, by whose name other shells ask for it. What happens goes to `on_event` if it is given,
    else to the terminal. With `watches`, nodes are started again when their files are saved, and no end of one is the
    system's. Raises `DocumentError`, before anything is started, for nodes that cannot run as they shall.
    """
    from robolink.supervisor.door.control import Control

    launched = processes(entries)
    for error in core_errors(entries):
        raise error
    held = {each.name: each.held_by for each in launched if each.held_by}
    members = {each.name: [entry.name for entry in each.entries] for each in launched if each.entries[0].node.process}
    with contextlib.ExitStack() as stack:
        output = None if on_event is None else stack.enter_context(Path(os.devnull).open("w", encoding="utf-8"))
        supervisor = Supervisor(_to_run(launched, watches), output=output, logs=RunLogs(path.stem), on_event=on_event)
        beside: list[contextlib.AbstractContextManager[object]] = [
            Control(supervisor, name=path.stem, file=str(path.resolve()), members=members)
        ]
        if watches:
            beside.append(_watch(launched, path, supervisor))
        if shows_figures:
            from robolink.supervisor.watching.resources import Figures

            beside.append(Figures(supervisor.status, say=supervisor.say))
        return supervisor.run(duration, [*beside, waiting(held, supervisor.release, supervisor.say)])


def _to_run(launched: Iterable[Launched], watches: bool) -> list[Process]:
    """Give the processes; when files are watched, a crash is what is just being mended: it must not end the system."""
    found = [as_process(each) for each in launched]
    mended = (replace(each, rules=replace(each.rules, on_exit="ignore", awaits=frozenset())) for each in found)
    return list(mended) if watches else found


def _watch(launched: Sequence[Launched], path: Path, supervisor: Supervisor) -> Watch:
    """Have processes started again when the files of their nodes are saved."""
    from robolink.launch.watching import files_of, roots_of, settings_of
    from robolink.supervisor.watching.watch import Watch

    roots, settings = roots_of(launched), [path.resolve(), *settings_of(launched)]
    return Watch(files_of(launched), roots=roots, settings=settings, restart=supervisor.restart, say=supervisor.say)
