"""Clients of running launchers: `robolink launch --status`, `stop`, `restart` and `--top`, for other shells.

Names of nodes are those before their lines, or the last part of one if it is unique.
"""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink.cli.shared.layout import aligned, shown_time
from robolink.cli.shared.output import say, say_json
from robolink.exceptions import NotFoundError
from robolink.supervisor.control.client import Launcher, LauncherError, LauncherGoneError, running
from robolink.supervisor.policy import Step, described, is_orderly
from robolink.system import clocks
from robolink.system.terminal import fit, shown
from robolink.text.names import meant, the_one

if TYPE_CHECKING:
    from robolink.supervisor.control.protocol import Response
    from robolink.supervisor.events import Status
    from robolink.supervisor.monitoring.resources import Usage

    Answered: TypeAlias = tuple[Launcher, Response]

STOPPED_WITHIN = 30.0
"""Timeout of a stop, in seconds; a launcher kills what has not ended after ten."""
LOOK_AGAIN = 0.05
"""Interval between two looks if a node has stopped, in seconds."""
FIRST_LOOK = 0.5
"""Delay of the first figures of `--top`, in seconds: CPU load can be measured only over a while."""


def status(launch: str = "", *, json: bool = False) -> None:
    """Show the state of the processes of all the user's launchers, or of one, by its launch file's name or its pid."""
    found: list[tuple[Launcher, Response | str]] = []
    for launcher in _named(launch):
        try:
            found.append((launcher, launcher.status()))
        except LauncherError as error:
            found.append((launcher, str(error)))
    if json:
        say_json([_data(*each) for each in found])
    elif not found:
        say("no launcher is running")
    else:
        say("\n\n".join("\n".join(_block(*each)) for each in found))


def stop(name: str = "") -> None:
    """Stop the launcher or the node of that name, or the only launcher there is, and wait until it has stopped.

    Raises LauncherError, and does nothing, for a name that both a launcher and a node have.
    """
    if name and _is_node(name):
        stop_one(name)
        return
    launcher = _only(name)
    if not launcher.stop(STOPPED_WITHIN):
        raise LauncherError(f"{launcher} is still stopping after {STOPPED_WITHIN:g} s")
    say(f"{launcher} has stopped")


def stop_one(node: str, launch: str = "") -> None:
    """Stop a node and wait until it has stopped; all others go on. `launch` names the launcher."""
    launcher, before = _node(node, launch, "stop")
    launcher.stop_one(before.name)
    say(f"{before.name} of {launcher} {_stopped(launcher, before)}")


def restart(node: str, launch: str = "") -> None:
    """Restart a node; `launch` names the launcher."""
    launcher, before = _node(node, launch, "restart")
    launcher.restart(before.name)
    say(f"restarting {before.name} of {launcher}")


def top(launch: str = "", *, json: bool = False, every: float = 2.0) -> None:
    """Show what each process of a launcher uses, every so many seconds, until the launcher ends or Ctrl-C is pressed.

    On a terminal the table is refreshed in its place, elsewhere one is written below the other; as JSON it is an object
    on a line.
    """
    launcher = _only(launch, " by --status --top NAME")
    if json:
        for answer, usage in _measured(launcher, every):
            say_json(_used(launcher, answer, usage))
    elif sys.stdout.isatty():
        _show_in_place(launcher, every)
    else:
        for answer, usage in _measured(launcher, every):
            say("\n".join([*aligned(_table(answer.nodes, usage)), ""]))
    if not json:
        say(f"{launcher} has ended")


def names_for(words: Sequence[str], within: float) -> list[str]:
    """Return completions of `stop` or `restart`, for the words so far; each launcher has `within` seconds to answer."""
    verb, *launch = words
    everyone = running()
    names = [] if launch else [each.name for each in everyone]
    if verb in ("restart", "stop") and len(launch) < 2:
        for each in _named(*launch) if launch else everyone:
            with contextlib.suppress(LauncherError):
                names += [status.name for status in each.status(within).nodes]
    return names


def _named(launch: str) -> list[Launcher]:
    """Return all launchers, or those of a name or pid. Raises NotFoundError if there is none of that name."""
    everyone = running()
    if not launch:
        return everyone
    found = [each for each in everyone if launch in _names_of(each)]
    if not found:
        raise NotFoundError("launcher", launch, (name for each in everyone for name in (each.name, str(each.pid))))
    return found


def _names_of(launcher: Launcher) -> tuple[str, ...]:
    return launcher.name, str(launcher.pid), launcher.file


def _only(launch: str, how: str = "") -> Launcher:
    """Return the one launcher that is meant. Raises LauncherError for none or several, with their names and `how`."""
    found = _named(launch)
    if not found:
        raise LauncherError("no launcher is running")
    if len(found) > 1:
        what = f"are called '{launch}', say by pid which one" if launch else f"are running, say which one{how}"
        raise LauncherError(f"{len(found)} launchers {what}: {_listed(found)}")
    return found[0]


def _is_node(name: str) -> bool:
    """True if a name is a node's. Raises LauncherError if it is a launcher's, too, NotFoundError if it is unknown."""
    everyone = running()
    launchers = [each for each in everyone if name in _names_of(each)]
    answered = list(_answering(everyone))
    nodes = [each.name for _, answer in answered for each in answer.nodes]
    members = [member for _, answer in answered for each in answer.members.values() for member in each]
    found = meant(name, nodes)
    if launchers and found:
        home = next(each for each, answer in answered if any(one.name == found[0] for one in answer.nodes))
        ways = f"stop {launchers[0].pid} for the launcher, or stop {shown(home.name)} {found[0]} for the node"
        raise LauncherError(f"both a launcher and a node are called '{name}': write {ways}")
    if everyone and not launchers and not meant(name, [*nodes, *members]):
        names = [each for launcher in everyone for each in (launcher.name, str(launcher.pid))]
        raise NotFoundError("launcher or node", name, [*names, *nodes])
    return bool(everyone and not launchers)


def _node(node: str, launch: str, verb: str) -> tuple[Launcher, Status]:
    """Return a node's launcher and status. Raises LauncherError or NotFoundError unless there is exactly one."""
    answered = list(_answering(_named(launch)))
    if not answered:
        raise LauncherError(f"cannot {verb} '{node}': no launcher is running")
    names = dict.fromkeys(each.name for _, answer in answered for each in answer.nodes)
    if not meant(node, names):
        raise _unknown_node(node, answered, verb)
    name = the_one("node", node, names)
    found = [(launcher, each) for launcher, answer in answered for each in answer.nodes if each.name == name]
    if len(found) > 1:
        several = [launcher for launcher, _ in found]
        raise LauncherError(f"'{node}' runs in {len(found)} launchers, say in which: {_listed(several)}")
    return found[0]


def _stopped(launcher: Launcher, before: Status) -> str:
    """Wait until a node has stopped, and return how it ended, in words. Raises LauncherError after the timeout."""
    deadline = clocks.monotonic() + STOPPED_WITHIN
    while clocks.monotonic() < deadline:
        try:
            now = next(each for each in launcher.status().nodes if each.name == before.name)
        except LauncherGoneError:
            return "has stopped, and with it the system: nothing else ran"
        if now.state in ("stopped", "ended") or (before.pid and now.pid not in (None, before.pid)):
            if before.state in ("held", "waiting"):
                return "is not started any more"
            in_order = now.returncode is None or is_orderly(now.returncode, Step.TERMINATE)
            return "has stopped" if in_order else f"has stopped: it {described(now.returncode or 0)}"
        time.sleep(LOOK_AGAIN)
    raise LauncherError(f"{before.name} of {launcher} is still stopping after {STOPPED_WITHIN:g} s")


def _answering(found: Sequence[Launcher]) -> Iterator[Answered]:
    """Yield the launchers with their answers. One that does not answer is skipped, unless it is the only one."""
    for launcher in found:
        try:
            yield launcher, launcher.status()
        except LauncherGoneError:
            continue
        except LauncherError:
            if len(found) == 1:
                raise


def _unknown_node(node: str, answered: Sequence[Answered], verb: str) -> Exception:
    """Return the error for an unknown node; for one that shares a process, with the name of that process."""
    for launcher, answer in answered:
        for process, members in answer.members.items():
            if meant(node, members):
                return LauncherError(f"'{node}' shares the process '{process}' of {launcher}: {verb} that one")
    names = [each.name for _, answer in answered for each in answer.nodes]
    return NotFoundError("node", node, names, str(answered[0][0]) if len(answered) == 1 else "")


def _listed(found: Sequence[Launcher]) -> str:
    return ", ".join(str(each) for each in found)


def _data(launcher: Launcher, answer: Response | str) -> dict[str, Any]:
    """Return a launcher's status for JSON: `error` says why it does not answer."""
    head = {"launch": launcher.name, "pid": launcher.pid, "file": launcher.file, "started": launcher.started}
    if isinstance(answer, str):
        return {**head, "nodes": [], "members": {}, "error": answer}
    return {**head, "nodes": answer.nodes, "members": answer.members, "error": ""}


def _block(launcher: Launcher, answer: Response | str) -> list[str]:
    """Return the lines of --status about a launcher."""
    now = clocks.time_of_day()
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
    return "-" if status.returncode is None else described(status.returncode)


def _measured(launcher: Launcher, every: float) -> Iterator[tuple[Response, Mapping[str, Usage]]]:
    """Yield measurements every so many seconds, until the launcher has ended."""
    from robolink.supervisor.monitoring.resources import Meter, measured

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
            live.update(Text(fit(lines), no_wrap=True, overflow="ellipsis"), refresh=True)


def _table(nodes: Sequence[Status], usage: Mapping[str, Usage]) -> list[list[str]]:
    """Return the rows of --top: the sum first, since the end of a long table may not be on the screen."""
    from robolink.supervisor.monitoring.resources import Usage, shown_cpu, shown_memory

    cpu, memory = sum(each.cpu or 0.0 for each in usage.values()), sum(each.memory for each in usage.values())
    whole = Usage(cpu, memory, sum(each.processes for each in usage.values()))
    rows = [["NODE", "CPU", "MEMORY", "UP", "RESTARTS", "STATE"]]
    rows.append([f"all {len(nodes)}", shown_cpu(whole.cpu), shown_memory(whole.memory), "", "", ""])
    now = clocks.time_of_day()
    for each in nodes:
        used = usage.get(each.name)
        figures = ["-", "-", "-"]
        if used is not None:
            figures = [shown_cpu(used.cpu), shown_memory(used.memory), shown_time(now - each.since)]
        rows.append([each.name, *figures, str(each.restarts), each.state])
    return rows


def _used(launcher: Launcher, answer: Response, usage: Mapping[str, Usage]) -> dict[str, Any]:
    """Return a line of --top for JSON: CPU in percent of one core, memory in bytes."""
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
    return {"at": clocks.time_of_day(), "launch": launcher.name, "pid": launcher.pid, "nodes": nodes}
