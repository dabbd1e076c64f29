"""Processes run as one system: the first end is the end of all, and nothing ever stays behind."""

from __future__ import annotations

import io
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
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor import Process, ProcessStartError, Supervisor
from robolink.supervisor.processes.guardian import Guardian, marked, remaining
from robolink.supervisor.processes.lifeline import VARIABLE, Lifeline, watch_lifeline
from robolink.supervisor.processes.process import Child
from robolink.supervisor.rules import Step

PATIENCE = 30.0

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="signals and process groups are POSIX's")
INTERRUPT, TERMINATE, KILL = Step.INTERRUPT, Step.TERMINATE, Step.KILL


# --- running --------------------------------------------------------------------------------------------------

SAY_READY = "import signal, sys, time, os, subprocess\nsay = lambda *a: print(*a, flush=True)\n"
DOZE = "while True: time.sleep(0.02)\n"
"""Sleeps for ever. A signal that comes just before a long sleep begins would be noticed only at its end."""
FOR_EVER = "say('ready')\n" + DOZE
IGNORES = "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"


def python(name: str, code: str, *, interactive: bool = False) -> Process:
    return Process(name, [sys.executable, "-c", SAY_READY + textwrap.dedent(code)], interactive=interactive)


def until_there(path: Path) -> str:
    """The code with which one process waits for another."""
    return f"while not os.path.exists({str(path)!r}): time.sleep(0.01)\n"


def there(path: Path) -> str:
    """The code that ends such a wait."""
    return f"open({str(path)!r}, 'w').close()\n"


def run(*processes: Process, patience: float = PATIENCE) -> tuple[int, list[str]]:
    output = io.StringIO()
    code = Supervisor(processes, output=output, patience=patience).run()
    return code, output.getvalue().splitlines()


def test_output_is_whole_whoever_prints_and_however_long(tmp_path: Path) -> None:
    said = tmp_path / "said"
    chatty = "for i in range(300): print(i); print(i, file=sys.stderr)\n" + until_there(said)
    long = "print('x' * 300_000); sys.stdout.flush(); sys.stdout.buffer.write(b'\\xff\\n'); say('end')\n"
    code, lines = run(python("a", chatty), python("b", long + there(said) + FOR_EVER))
    assert code == 0
    assert [line for line in lines if line.startswith("[a]")] == [f"[a] {i // 2}" for i in range(600)]
    assert [line for line in lines if line.startswith("[b]")][:3] == ["[b] " + "x" * 300_000, "[b] \ufffd", "[b] end"]


def test_the_last_words_of_a_process_are_printed_before_its_end_is_reported() -> None:
    code, lines = run(python("a", "print('last', end='')\nraise SystemExit(3)"))
    assert code == 3
    assert lines == ["[a] last", "[launch] a ended with exit code 3"]


def test_stop_ends_the_system_from_any_thread() -> None:
    class Watched(io.StringIO):
        def write(self, text: str) -> int:
            if "ready" in text:
                supervisor.stop()
            return super().write(text)

    output = Watched()
    supervisor = Supervisor([python("a", FOR_EVER)], output=output)
    assert supervisor.run() == 0
    assert "[launch] stopping (Ctrl-C again to hurry)\n" in output.getvalue()


def test_a_program_that_is_not_there_stops_the_others() -> None:
    started: list[Child] = []

    def start(process: Process, lifeline: Lifeline) -> Child:
        started.append(Child(process, lifeline))
        return started[-1]

    processes = [python("a", "time.sleep(100)"), Process("b", ["/no/such/program"])]
    with pytest.raises(ProcessStartError, match="cannot start b"):
        Supervisor(processes, output=io.StringIO(), start=start).run()
    assert [child.name for child in started] == ["a"]
    assert is_gone(started[0].group)


@posix_only
@pytest.mark.parametrize("text", ["echo hi\n", "#!/bin/sh\r\necho hi\r\n", "#!/nowhere/sh\n"])
def test_a_script_of_which_nobody_knows_what_runs_it_is_told_of(text: str, tmp_path: Path) -> None:
    script = tmp_path / "script.sh"
    script.write_bytes(text.encode())
    script.chmod(0o755)
    with pytest.raises(ProcessStartError, match=r"cannot start a \(.*script.sh\): its first line names no program"):
        run(Process("a", [str(script)]))


@posix_only
def test_what_has_too_long_arguments_is_told_what_to_do() -> None:
    with pytest.raises(ProcessStartError, match=r"cannot start a \(.*\): it is given more than .* in a file"):
        run(Process("a", [sys.executable, "-c", "", "x" * 3_000_000]))


@posix_only
def test_a_process_that_ignores_the_interrupt_is_terminated(tmp_path: Path) -> None:
    deaf = tmp_path / "deaf"
    stubborn = python("b", IGNORES + there(deaf) + FOR_EVER)
    waiting = python("a", until_there(deaf) + "raise SystemExit(4)")
    code, lines = run(waiting, stubborn, patience=1.0)
    assert code == 4
    said = ["a ended with exit code 4", "still running after 1 s: b", "summary: a ended with exit code 4"]
    assert lines[-3:] == [f"[launch] {each}" for each in said]


class FakeChild:
    """A child that only notes what is asked of it, and ends at the step that it obeys."""

    group = 2**31 - 2

    def __init__(self, process: Process, obeys: Step, notes: list[object]) -> None:
        self.name, self.obeys, self.notes = process.name, obeys, notes

    def watch(self, on_line: Callable[[str, bytes], None], on_exit: Callable[[str, int], None]) -> None:
        on_line(self.name, b"started")
        self.on_exit = on_exit

    def ask(self, step: Step) -> None:
        self.notes.append((self.name, step))
        if step is self.obeys:
            self.on_exit(self.name, 0)

    def is_left(self) -> bool:
        return False


def test_clock_and_processes_can_be_replaced() -> None:
    notes: list[object] = []
    ticks = iter(range(0, 10**6, 100))

    def start(process: Process, lifeline: object) -> FakeChild:
        return FakeChild(process, TERMINATE if process.name == "slow" else INTERRUPT, notes)

    names = [Process("quick", []), Process("slow", [])]
    supervisor = Supervisor(names, output=io.StringIO(), clock=lambda: next(ticks), start=start)  # type: ignore[arg-type]
    assert supervisor.run(duration=10) == 0
    assert notes[:3] == [("quick", INTERRUPT), ("slow", INTERRUPT), ("slow", TERMINATE)]


# --- the edges: a launcher of its own, and signals ------------------------------------------------------------

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


def state(pid: int) -> str:
    """Give the letter of a process's state, '' when there is none; a zombie ('Z') still has a number."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        if Path("/proc/self").exists():
            return ""
    shown = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False)
    return shown.stdout.strip()[:1]


def wait_until(condition: Callable[[], bool]) -> bool:
    deadline = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.005)
    return True


def is_gone(pid: int) -> bool:
    return state(pid) in ("", "Z", "X")


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
        child.watch(lambda name, line: None, lambda name, code: ended.set())
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


# --- lifeline and guardian, by themselves ---------------------------------------------------------------------


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
        child.watch(lambda name, line: None, lambda name, code: ended.set())
        assert guardian._process is not None
        assert guardian._process.stdin is not None
        if in_order:
            guardian.close()
            assert not ended.is_set()
            child.ask(KILL)
        guardian._process.stdin.close()
        assert ended.wait(PATIENCE)
        guardian._process.wait(PATIENCE)
