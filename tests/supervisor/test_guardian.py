"""The lifeline and the guardian by themselves: the pipe, the watchdog process, and the groups that it kills."""

from __future__ import annotations

import os
import signal
import sys
import threading
from contextlib import closing
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor import Process
from robolink.supervisor.policy import Step
from robolink.supervisor.processes.guardian import Guardian, marked, remaining
from robolink.supervisor.processes.lifeline import VARIABLE, Lifeline, watch_lifeline
from robolink.supervisor.processes.process import Child
from robolink.system import clocks

pytestmark = pytest.mark.processes

PATIENCE = 30.0

INTERRUPT, TERMINATE, KILL = Step.INTERRUPT, Step.TERMINATE, Step.KILL


@pytest.mark.parametrize("value", ["", "x", "-1", "99999", "99999:12ab", ":", str(2**80), "0x3"])
def test_a_lifeline_that_is_none_is_not_watched(value: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, value)
    assert not watch_lifeline()
    assert VARIABLE not in os.environ


def test_a_file_is_no_lifeline(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with (tmp_path / "file").open("w") as file:
        monkeypatch.setenv(VARIABLE, str(file.fileno()))
        assert not watch_lifeline()


@pytest.mark.skipif(sys.platform != "linux", reason="looks at environments in /proc")
def test_a_guardian_outlives_the_launcher_that_launched_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    with closing(Lifeline()) as outer:
        monkeypatch.setenv(VARIABLE, outer.options()[0][VARIABLE])
        with closing(Guardian()):
            assert not marked(outer.mark)


def test_an_end_waits_for_no_guardian_that_stands_still() -> None:
    if sys.platform == "win32":
        pytest.skip("signals and terminals are POSIX's")
    guardian = Guardian()
    assert guardian._process is not None
    guardian._process.send_signal(signal.SIGSTOP)
    its_end = threading.Thread(target=guardian.close, daemon=True)
    its_end.start()
    its_end.join(PATIENCE)
    guardian._process.kill()
    assert not its_end.is_alive()


@given(st.lists(st.tuples(st.booleans(), st.integers(1, 5))))
def test_the_guardian_knows_what_is_left(history: list[tuple[bool, int]]) -> None:
    lines = [b"%s%d\n" % (b"+" if added else b"-", group) for added, group in history]
    last = {group: added for added, group in history}
    left = {group for group, added in last.items() if added}
    assert remaining([*lines, b"+9"]) == remaining([*lines, b".\n"]) == left


@pytest.mark.skipif(sys.platform != "linux", reason="looks at environments in /proc")
@pytest.mark.parametrize("in_order", [True, False])
def test_a_process_of_which_the_guardian_was_not_told_yet_is_known_by_its_lifeline(in_order: bool) -> None:
    with closing(Lifeline()) as lifeline:
        guardian = Guardian(lifeline.mark, patience=0.0)
        child = Child(Process("a", [sys.executable, "-c", "import time; time.sleep(100)"]), lifeline)
        ended = threading.Event()
        child.watch(lambda name, line, fd=None: None, lambda name, code: ended.set())
        process = guardian._process
        assert process is not None
        assert process.stdin is not None
        if in_order:
            guardian.close()
            assert not ended.is_set()
            child.ask(KILL)
        process.stdin.close()
        assert ended.wait(PATIENCE)
        process.wait(PATIENCE)
        guardian.close()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no process groups")
def test_a_guardian_that_was_killed_is_followed_by_another_one() -> None:
    with closing(Lifeline()) as lifeline:
        guardian = Guardian(patience=0.0)
        child = Child(Process("a", [sys.executable, "-c", "import time; time.sleep(100)"]), lifeline)
        ended = threading.Event()
        child.watch(lambda name, line, fd=None: None, lambda name, code: ended.set())
        guardian.guard(child.group)
        first = guardian._process
        assert first is not None
        first.kill()
        deadline = clocks.monotonic() + PATIENCE
        while guardian._process is first and clocks.monotonic() < deadline:
            first.poll()
        second = guardian._process
        assert second is not None
        assert second.pid != first.pid
        guardian.close()  # without an order to spare what is left: it is killed
        assert ended.wait(PATIENCE)
