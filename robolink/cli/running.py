"""What `robolink launch --status`, `stop`, `restart` and `--top` do: ask launchers that run in other shells."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.cli.layout import aligned, shown_time
from robolink.exceptions import NotFoundError, shown

if TYPE_CHECKING:
    from robolink.supervisor.door.asking import Launcher
    from robolink.supervisor.door.talk import Answer
    from robolink.supervisor.events import Status
    from robolink.supervisor.watching.resources import Usage

    Answered: TypeAlias = tuple[Launcher, Answer]

STOPPED_WITHIN = 30.0
"""Seconds; a launcher kills what does not obey after ten."""
FIRST_LOOK = 0.5
"""Seconds from the start of `--top` to its first figures: how busy a process is shows only over a while."""


def status(launch: str = "", *, json: bool = False) -> None:
    """Show how the processes of the user's launchers are, or of one: by its launch file's name or its pid."""
    from robolink.supervisor.door.asking import LauncherError

    found: list[tuple[Launcher, Answer | str]] = []
    for launcher in _named(launch):
        try:
            found.append((launcher, launcher.status()))
        except LauncherError as error:
            found.append((launcher, str(error)))
    if json:
        _say_json([_data(*each) for each in found])
    elif not found:
        _say("no launcher is running")
    else:
        _say("\n\n".join("\n".join(_block(*each)) for each in found))


def stop(launch: str = "") -> None:
    """Stop a launcher, the only one if none is named, and wait until it has stopped."""
    from robolink.supervisor.door.asking import LauncherError

    launcher = _only(launch)
    if not launcher.stop(STOPPED_WITHIN):
        raise LauncherError(f"{launcher} is still stopping after {STOPPED_WITHIN:g} s")
    _say(f"{launcher} has stopped")


def restart(node: str, launch: str = "") -> None:
    """Start a node anew, by the name that stands before its lines; `launch` says in which launcher."""
    from robolink.supervisor.door.asking import LauncherError

    answered = list(_answering(_named(launch)))
    if not answered:
        raise LauncherError(f"cannot restart '{node}': no launcher is running")
    asked = node.strip("/")
    found = [launcher for launcher, answer in answered if any(each.name == asked for each in answer.nodes)]
    if len(found) > 1:
        raise LauncherError(f"'{node}' runs in {len(found)} launchers, say in which: {_listed(found)}")
    if not found:
        raise _unknown_node(node, answered)
    found[0].restart(asked)
    _say(f"restarting {asked} of {found[0]}")


def top(launch: str = "", *, json: bool = False, every: float = 2.0) -> None:
    """Show what each process of a launcher uses, every so many seconds, until the launcher ends or Ctrl-C.

    On a terminal the table is refreshed in its place, elsewhere one is written below the other; as JSON it is an object
    on a line.
    """
    launcher = _only(launch, " by --status --top NAME")
    if json:
        for answer, usage in _measured(launcher, every):
            _say_json(_used(launcher, answer, usage))
    elif sys.stdout.isatty():
        _show_in_place(launcher, every)
    else:
        for answer, usage in _measured(launcher, every):
            _say("\n".join([*aligned(_table(answer.nodes, usage)), ""]))
    if not json:
        _say(f"{launcher} has ended")


def names_for(words: Sequence[str], within: float) -> list[str]:
    """Give what may come next, for a shell that completes `stop` or `restart`, with what was written behind it."""
    from robolink.supervisor.door.asking import LauncherError, running

    verb, *launch = words
    everyone = running()
    names = [] if launch else [each.name for each in everyone]
    if verb == "restart" and len(launch) < 2:
        for each in _named(*launch) if launch else everyone:
            with contextlib.suppress(LauncherError):
                names += [status.name for status in each.status(within).nodes]
    return names


def _named(launch: str) -> list[Launcher]:
    """Give the launchers that run, or those that a name or pid means. Raises NotFoundError when it means none."""
    from robolink.supervisor.door.asking import running

    everyone = running()
    if not launch:
        return everyone
    found = [each for each in everyone if launch in (each.name, str(each.pid), each.file)]
    if not found:
        raise NotFoundError("launcher", launch, (name for each in everyone for name in (each.name, str(each.pid))))
    return found


def _only(launch: str, how: str = "") -> Launcher:
    """Give the launcher that is meant. Raises LauncherError for none or several: they are named, and `how` to say."""
    from robolink.supervisor.door.asking import LauncherError

    found = _named(launch)
    if not found:
        raise LauncherError("no launcher is running")
    if len(found) > 1:
        what = f"are called '{launch}', say by pid which one" if launch else f"are running, say which one{how}"
        raise LauncherError(f"{len(found)} launchers {what}: {_listed(found)}")
    return found[0]


def _answering(found: Sequence[Launcher]) -> Iterator[Answered]:
    """Give what the launchers say. One that says nothing is passed over, unless it is the only one."""
    from robolink.supervisor.door.asking import LauncherError, LauncherGoneError

    for launcher in found:
        try:
            yield launcher, launcher.status()
        except LauncherGoneError:
            continue
        except LauncherError:
            if len(found) == 1:
                raise


def _unknown_node(node: str, answered: Sequence[Answered]) -> Exception:
    """Say that nothing is called so; of a node that shares a process, say which one."""
    from robolink.supervisor.door.asking import LauncherError

    asked = node.strip("/")
    for launcher, answer in answered:
        for process, members in answer.members.items():
            if asked in (each.strip("/") for each in members):
                return LauncherError(f"'{node}' shares the process '{process}' of {launcher}: restart that one")
    names = [each.name for _, answer in answered for each in answer.nodes]
    return NotFoundError("node", node, names, str(answered[0][0]) if len(answered) == 1 else "")


def _listed(found: Sequence[Launcher]) -> str:
    return ", ".join(str(each) for each in found)


def _data(launcher: Launcher, answer: Answer | str) -> dict[str, Any]:
    """Give what --status tells of a launcher, for JSON: `error` says why it does not answer."""
    head = {"launch": launcher.name, "pid": launcher.pid, "file": launcher.file, "started": launcher.started}
    if isinstance(answer, str):
        return {**head, "nodes": [], "members": {}, "error": answer}
    return {**head, "nodes": answer.nodes, "members": answer.members, "error": ""}


def _block(launcher: Launcher, answer: Answer | str) -> list[str]:
    """Give the lines of --status about a launcher."""
    now = time.time()
    if isinstance(answer, str):
        return [answer]
    rows = [["NODE", "STATE", "SINCE", "PID", "RESTARTS", "LAST EXIT"]]
    for each in answer.nodes:
        members = f" ({', '.join(answer.members[each.name])})" if each.name in answer.members else ""
        rows.append(
            [
                each.name + members,
                each.state,
                shown_time(now - each.since),
                str(each.pid or "-"),
                str(each.restarts),
                _last_exit(each),
            ]
        )
    head = f"{launcher}, up {shown_time(now - launcher.started)}, {shown(launcher.file, 1000)}".removesuffix(", ")
    return [head, *(f"  {line}" for line in aligned(rows))]


def _last_exit(status: Status) -> str:
    from robolink.supervisor.rules import described

    return "-" if status.returncode is None else described(status.returncode)


def _measured(launcher: Launcher, every: float) -> Iterator[tuple[Answer, Mapping[str, Usage]]]:
    """Measure every so many seconds, until the launcher has ended."""
    from robolink.supervisor.door.asking import LauncherGoneError
    from robolink.supervisor.watching.resources import Meter, measured

    meter = Meter()
    try:
        measured(meter, launcher.status().nodes)
        pause = min(FIRST_LOOK, every)
        while True:
            time.sleep(pause)
            answer = launcher.status()
            yield answer, measured(meter, answer.nodes)
            pause = every
    except LauncherGoneError:
        return


def _show_in_place(launcher: Launcher, every: float) -> None:
    from rich.live import Live
    from rich.text import Text

    with Live(auto_refresh=False) as live:
        for answer, usage in _measured(launcher, every):
            lines = "\n".join(aligned(_table(answer.nodes, usage)))
            live.update(Text(lines, no_wrap=True, overflow="ellipsis"), refresh=True)


def _table(nodes: Sequence[Status], usage: Mapping[str, Usage]) -> list[list[str]]:
    """Give the rows of --top: all together first, since the end of a long table may not be on the screen."""
    from robolink.supervisor.watching.resources import Usage, shown_cpu, shown_memory

    cpu, memory = sum(each.cpu or 0.0 for each in usage.values()), sum(each.memory for each in usage.values())
    whole = Usage(cpu, memory, sum(each.processes for each in usage.values()))
    rows = [["NODE", "CPU", "MEMORY", "UP", "RESTARTS", "STATE"]]
    rows.append([f"all {len(nodes)}", shown_cpu(whole.cpu), shown_memory(whole.memory), "", "", ""])
    now = time.time()
    for each in nodes:
        used = usage.get(each.name)
        figures = ["-", "-", "-"]
        if used is not None:
            figures = [shown_cpu(used.cpu), shown_memory(used.memory), shown_time(now - each.since)]
        rows.append([each.name, *figures, str(each.restarts), each.state])
    return rows


def _used(launcher: Launcher, answer: Answer, usage: Mapping[str, Usage]) -> dict[str, Any]:
    """Give a line of --top as JSON: percent of one core, bytes."""
    nodes = []
    for each in answer.nodes:
        used = usage.get(each.name)
        nodes.append(
            {
                "name": each.name,
                "pid": each.pid,
                "state": each.state,
                "restarts": each.restarts,
                "since": each.since,
                "cpu": None if used is None or used.cpu is None else round(used.cpu, 2),
                "memory": None if used is None else used.memory,
                "processes": 0 if used is None else used.processes,
            }
        )
    return {"at": time.time(), "launch": launcher.name, "pid": launcher.pid, "nodes": nodes}


def _say(text: str) -> None:
    import typer

    typer.echo(text)


def _say_json(value: Any) -> None:
    import msgspec

    _say(msgspec.json.encode(value).decode())
