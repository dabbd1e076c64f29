"""Processes that are started again, later, or not any more, while the others of their system go on."""

from __future__ import annotations

import io
import os
import queue
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

import pytest

from robolink.exceptions import NotFoundError
from robolink.supervisor import Event, Process, Restarts, Rules, Supervisor
from robolink.supervisor.events import Exited, Output, Said, Started
from robolink.supervisor.processes.guardian import is_alive

pytestmark = pytest.mark.processes

PATIENCE = 30.0
RUNS_ON = "import os, time\nprint('ready', flush=True)\nwhile True: time.sleep(0.02)\n"
IGNORED = Rules(on_exit="ignore")
posix_only = pytest.mark.skipif(sys.platform == "win32", reason="process groups are POSIX's")
E = TypeVar("E")


def python(name: str, code: str, rules: Rules | None = None, *, cpu: tuple[int, ...] = ()) -> Process:
    return Process(name, [sys.executable, "-c", code], rules=rules or Rules(), cpu=cpu)


class Running:
    """A supervisor on a thread of its own; its events one after the other, and what it printed and gave in the end."""

    def __init__(self, processes: tuple[Process, ...]) -> None:
        self.output = io.StringIO()
        self.events: queue.SimpleQueue[Event] = queue.SimpleQueue()
        self.supervisor = Supervisor(processes, output=self.output, patience=PATIENCE, on_event=self.events.put)
        self.seen: list[Event] = []
        self.code: int | None = None
        self.thread = threading.Thread(target=self._run)
        self.thread.start()

    def _run(self) -> None:
        self.code = self.supervisor.run()

    def wait_for(self, kind: type[E], name: str) -> E:
        """Give the first event of a kind, about a process, that nobody has waited for yet."""
        while True:
            for event in self.seen:
                if isinstance(event, kind) and getattr(event, "name", name) == name:
                    self.seen.remove(event)
                    return event
            self.seen.append(self.events.get(timeout=PATIENCE))

    def state(self, name: str) -> str:
        [found] = [each.state for each in self.supervisor.status() if each.name == name]
        return found

    def end(self) -> list[str]:
        """Wait for the end; give the lines of the launcher."""
        self.thread.join(PATIENCE)
        assert self.code is not None
        return [line.removeprefix("[launch] ") for line in self.output.getvalue().splitlines() if "[launch]" in line]


@contextmanager
def running(*processes: Process) -> Iterator[Running]:
    made = Running(processes)
    try:
        yield made
    finally:
        made.supervisor.stop()
        made.thread.join(PATIENCE)


def test_a_process_that_fails_is_started_again_and_given_up(tmp_path: Path) -> None:
    code = f"open({str(tmp_path / 'runs')!r}, 'a').write('x'); raise KeyError('no')"
    with running(python("a", code, Rules(Restarts("on_failure", delay=0.0, most=2)))) as system:
        lines = system.end()
    assert system.code == 1
    assert (tmp_path / "runs").read_text() == "xxx"
    told = "a ended with exit code 1: KeyError: 'no'"
    assert lines == [
        f"{told}; starting it again in 0 s (1 of 2 within 60 s)",
        "a ended with exit code 1 as before: starting it again in 0 s (2 of 2 within 60 s)",
        "a ended with exit code 1 as before: given up after 2 new starts within 60 s",
        f"summary: {told} (failed 3 times, started again 2 times)",
    ]


@posix_only
def test_a_restart_waits_until_all_of_the_process_has_ended() -> None:
    code = """
import os, subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c",
    "import signal, time; signal.signal(signal.SIGINT, signal.SIG_IGN); print('up', flush=True); time.sleep(100)"],
    stdout=subprocess.PIPE)
child.stdout.readline()
print("ready", flush=True)
while True: time.sleep(0.02)
"""
    with running(python("a", code), python("b", RUNS_ON)) as system:
        system.wait_for(Output, "b")
        system.wait_for(Output, "a")
        first = system.wait_for(Started, "a").pid
        system.supervisor.restart("a")
        assert system.wait_for(Exited, "a").pid == first
        assert not is_alive(first)
        system.wait_for(Output, "a")
        started = system.wait_for(Started, "a")
        assert started.restarts == 1
        assert started.pid != first
        [a, b] = system.supervisor.status()
        assert (a.name, a.pid, a.state, a.restarts) == ("a", started.pid, "running", 1)
        assert 0 < b.since <= a.since <= time.time()
        system.supervisor.stop()
        assert system.end() == ["restarting a", "stopping (Ctrl-C again to hurry)"]
    assert system.code == 0


def test_one_that_is_stopped_leaves_the_others_and_can_be_started_again() -> None:
    with running(python("a", RUNS_ON), python("b", RUNS_ON)) as system:
        system.wait_for(Output, "a")
        system.supervisor.stop_one("a")
        system.wait_for(Exited, "a")
        while system.wait_for(Said, "").text != "a has stopped":
            continue
        assert system.state("a") == "stopped"
        assert system.state("b") == "running"
        system.supervisor.restart("a")
        system.wait_for(Started, "a")
        system.wait_for(Output, "a")
        system.supervisor.stop()
        assert system.end() == ["stopping a", "a has stopped", "starting a", "stopping (Ctrl-C again to hurry)"]


def test_a_held_process_starts_when_it_is_released() -> None:
    with running(python("a", "print('a')", IGNORED), python("b", "raise SystemExit(7)", Rules(held=True))) as system:
        system.wait_for(Exited, "a")
        assert system.state("b") == "held"
        system.supervisor.release("b")
        system.end()
    assert system.code == 7


def test_a_name_that_nobody_has_is_refused() -> None:
    supervisor = Supervisor([python("wander", "")])
    for act in (supervisor.restart, supervisor.stop_one, supervisor.release):
        with pytest.raises(NotFoundError, match=r"no process named 'wandr' \(did you mean 'wander'\?\)"):
            act("wandr")
    assert [each.state for each in supervisor.status()] == ["waiting"]


def test_a_program_that_cannot_be_started_again_is_an_end_like_others(tmp_path: Path) -> None:
    missing = str(tmp_path / "missing")
    with running(python("a", RUNS_ON), Process("b", [missing], rules=Rules(held=True))) as system:
        system.wait_for(Output, "a")
        system.supervisor.release("b")
        lines = system.end()
    assert system.code == 127
    assert lines[0].startswith(f"b ended with exit code 127: cannot start b ({missing}): ")


def test_what_others_have_to_say_is_printed() -> None:
    with running(python("a", RUNS_ON)) as system:
        system.supervisor.say("nobody publishes scan yet")
        assert system.wait_for(Said, "").text == "nobody publishes scan yet"


def test_a_process_runs_on_the_cores_that_it_is_given() -> None:
    if sys.platform != "linux":
        pytest.skip("only Linux has sched_getaffinity")
    core = min(os.sched_getaffinity(0))
    code = f"import os, time\nwhile os.sched_getaffinity(0) != {{{core}}}: time.sleep(0.01)\n"
    with running(python("a", code, cpu=(core,))) as system:
        system.end()
    assert system.code == 0
