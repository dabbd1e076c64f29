"""A launcher of its own and signals: Ctrl-C, Ctrl-Z, kills, and that nothing stays behind."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

import pytest

from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child
from tests.support.supervised import (
    DOZE,
    FOR_EVER,
    IGNORES,
    INTERRUPT,
    KILL,
    PATIENCE,
    SAY_READY,
    is_gone,
    posix_only,
    python,
    state,
)

pytestmark = pytest.mark.processes


LAUNCHER = """
import json, sys
from robolink.supervisor import Process, Supervisor
spec = json.loads(sys.argv[1])
processes = [Process(name, [sys.executable, "-c", code], interactive=name == "teleop") for name, code in spec.items()]
raise SystemExit(Supervisor(processes, patience=float(sys.argv[2])).run())
"""


class Launcher:
    """A launcher in a process of its own, and its lines as they come; `first` is what it does before all else."""

    def __init__(self, codes: dict[str, str], patience: float, first: str, terminal: int | None) -> None:
        spec = json.dumps({name: SAY_READY + textwrap.dedent(code) for name, code in codes.items()})
        self.process = subprocess.Popen(
            [sys.executable, "-c", first + LAUNCHER, spec, str(patience)],
            stdin=subprocess.DEVNULL if terminal is None else terminal,
            stdout=subprocess.PIPE,
            start_new_session=terminal is not None,
        )
        self.lines: queue.Queue[str] = queue.Queue()
        self.said: list[str] = []
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as output:
            for line in output:
                self.lines.put(line.decode().rstrip())

    def wait_for(self, text: str) -> str:
        """Wait for a line that holds the text, give the words behind it, and never give that line again."""
        while not (found := [line for line in self.said if text in line]):
            self.said.append(self.lines.get(timeout=PATIENCE))
        self.said.remove(found[0])
        return found[0].partition(text)[2].strip()

    def rest(self) -> list[str]:
        """Give the lines that nobody waited for, after the end."""
        return [*self.said, *(self.lines.get() for _ in range(self.lines.qsize()))]

    def end(self) -> int:
        code = self.process.wait(PATIENCE)
        self.reader.join(PATIENCE)
        return code


@contextmanager
def launched(
    codes: dict[str, str], *, patience: float = PATIENCE, first: str = "", terminal: int | None = None
) -> Iterator[Launcher]:
    launcher = Launcher(codes, patience, first, terminal)
    try:
        yield launcher
    finally:
        launcher.process.kill()
        launcher.end()


def wait_until(condition: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.005)
    return True


@posix_only
def test_ctrl_c_stops_all_in_order_with_one_interrupt_each() -> None:
    counting = """
        def count(*args):
            say("interrupted")
            raise SystemExit(0)
        signal.signal(signal.SIGINT, count)
    """
    counting = textwrap.dedent(counting) + FOR_EVER
    with launched({"a": counting, "b": counting}) as launcher:
        launcher.wait_for("ready")
        launcher.wait_for("ready")
        launcher.process.send_signal(signal.SIGINT)
        assert launcher.end() == 0
        rest = launcher.rest()
    assert rest[0] == "[launch] stopping (Ctrl-C again to hurry)"
    assert sorted(rest[1:]) == ["[a] interrupted", "[b] interrupted"]


@posix_only
@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP"])
def test_other_signals_stop_in_order_too(name: str) -> None:
    number = signal.Signals[name]
    heeded = f"import signal\nsignal.signal({int(number)}, signal.SIG_DFL)\n"  # the tests may run under nohup
    with launched({"a": FOR_EVER}, first=heeded) as launcher:
        launcher.wait_for("ready")
        launcher.process.send_signal(number)
        assert launcher.end() == 0


@posix_only
def test_ctrl_c_again_and_again_hurries() -> None:
    stubborn = IGNORES + "signal.signal(signal.SIGTERM, lambda *a: say('hurried'))\n" + FOR_EVER
    with launched({"a": stubborn}, patience=60) as launcher:
        launcher.wait_for("ready")
        launcher.process.send_signal(signal.SIGINT)
        launcher.wait_for("stopping")
        time.sleep(0.25)  # not to wait for anything: sooner, it would count as an echo of the first
        launcher.process.send_signal(signal.SIGINT)
        launcher.wait_for("hurried")
        time.sleep(0.25)
        launcher.process.send_signal(signal.SIGINT)
        assert launcher.end() == 137


WITH_CHILD = """
    child = subprocess.Popen([sys.executable, "-c", "import signal, time; signal.signal(signal.SIGINT, signal.SIG_IGN);"
        "print('up', flush=True); time.sleep(100)"], stdout=subprocess.PIPE)
    child.stdout.readline()
    say("pids", os.getpid(), child.pid)
"""


@posix_only
def test_processes_that_a_child_leaves_behind_are_ended_too() -> None:
    with launched({"a": WITH_CHILD + "    raise SystemExit(5)"}) as launcher:
        _, grandchild = map(int, launcher.wait_for("pids").split())
        assert launcher.end() == 5
        assert wait_until(lambda: is_gone(grandchild))


@posix_only
def test_nothing_stays_behind_when_the_launcher_is_killed() -> None:
    watch = "from robolink.supervisor import watch_lifeline; assert watch_lifeline(0.2)\n"
    stubborn = IGNORES + textwrap.dedent(WITH_CHILD) + FOR_EVER
    with launched({"watching": watch + stubborn, "plain": stubborn}) as launcher:
        watching = [int(pid) for pid in launcher.wait_for("[watching] pids").split()]
        plain = [int(pid) for pid in launcher.wait_for("[plain] pids").split()]
        launcher.wait_for("ready")
        launcher.wait_for("ready")  # or else they may die of their own broken pipes
        launcher.process.kill()
        assert wait_until(lambda: all(map(is_gone, watching)))
        assert not any(map(is_gone, plain))  # these have longer: the guardian lets others end in order
        assert wait_until(lambda: all(map(is_gone, plain)))


@posix_only
def test_a_watching_program_ends_in_order_when_the_launcher_is_killed(tmp_path: Path) -> None:
    code = f"""
        from robolink.supervisor import watch_lifeline
        assert watch_lifeline()
        try:
            say("ready")
            {DOZE}
        except KeyboardInterrupt:
            open({str(tmp_path / "orderly")!r}, "w").close()
    """
    with launched({"a": code}) as launcher:
        launcher.wait_for("ready")
        launcher.process.kill()
        assert wait_until((tmp_path / "orderly").exists)


def test_ctrl_z_pauses_all_and_fg_lets_them_go_on() -> None:
    if sys.platform == "win32":
        pytest.skip("signals and terminals are POSIX's")
    with launched({"a": "say('pid', os.getpid())\n" + FOR_EVER}, first="import os; os.setpgrp()\n") as launcher:
        child = int(launcher.wait_for("pid"))
        launcher.wait_for("ready")
        launcher.process.send_signal(signal.SIGTSTP)
        assert wait_until(lambda: state(launcher.process.pid) == state(child) == "T")
        launcher.process.send_signal(signal.SIGCONT)
        assert wait_until(lambda: state(launcher.process.pid) != "T" and state(child) != "T")
        launcher.process.send_signal(signal.SIGINT)
        assert launcher.end() == 0


@posix_only
def test_a_process_that_stands_still_is_let_go_on_to_obey() -> None:
    with closing(Lifeline()) as lifeline:
        child = Child(python("a", "os.kill(os.getpid(), signal.SIGSTOP)\n" + DOZE), lifeline)
        ended = threading.Event()
        child.watch(lambda name, line, fd=None: None, lambda name, code: ended.set())
        assert wait_until(lambda: state(child.group) == "T")
        child.ask(INTERRUPT)
        has_obeyed = ended.wait(PATIENCE)
        child.ask(KILL)
        assert has_obeyed


def test_a_terminal_is_as_before_after_a_process_that_was_killed() -> None:
    if sys.platform == "win32":
        pytest.skip("signals and terminals are POSIX's")
    import termios

    keys = "import tty; tty.setraw(0); say('raw'); os.kill(os.getpid(), signal.SIGKILL)"
    take_terminal = "import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0)\n"
    ours, theirs = os.openpty()
    with os.fdopen(ours, "wb", buffering=0):
        before = termios.tcgetattr(theirs)
        with launched({"teleop": keys}, first=take_terminal, terminal=theirs) as launcher:
            launcher.wait_for("raw")
            assert launcher.end() == 137
        assert termios.tcgetattr(theirs) == before
        os.close(theirs)


def test_an_interactive_process_has_the_terminal() -> None:
    if sys.platform == "win32":
        pytest.skip("signals and terminals are POSIX's")
    teleop = """
        def count(*args):
            say("interrupted")
            raise SystemExit(0)
        signal.signal(signal.SIGINT, count)
        say("terminal", sys.stdin.isatty())
        while True: say("key", input())
    """
    other = "say('other', repr(sys.stdin.read()))\n" + FOR_EVER
    take_terminal = "import fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0)\n"
    ours, theirs = os.openpty()
    with (
        os.fdopen(ours, "wb", buffering=0) as keyboard,
        launched({"teleop": teleop, "b": other}, first=take_terminal, terminal=theirs) as launcher,
    ):
        os.close(theirs)
        assert launcher.wait_for("terminal") == "True"
        assert launcher.wait_for("other") == "''"
        keyboard.write(b"up\n")
        assert launcher.wait_for("key") == "up"
        keyboard.write(b"\x03")
        assert launcher.end() == 0
        assert [line for line in launcher.rest() if "interrupted" in line] == ["[teleop] interrupted"]
