"""Processes run as one system: the first end is the end of all, and nothing ever stays behind."""

from __future__ import annotations

import io
import os
import sys
import threading
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from robolink.supervisor import Process, ProcessStartError, Supervisor
from robolink.supervisor.policy import Step
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child
from tests.support.supervised import (
    FOR_EVER,
    IGNORES,
    INTERRUPT,
    PATIENCE,
    TERMINATE,
    is_gone,
    posix_only,
    python,
    there,
)

pytestmark = pytest.mark.processes


# --- running --------------------------------------------------------------------------------------------------


def until_there(path: Path) -> str:
    """The code with which one process waits for another."""
    return f"while not os.path.exists({str(path)!r}): time.sleep(0.01)\n"


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


def pieces_of(process: Process) -> tuple[int, list[tuple[bytes, int | None]]]:
    """Return the return code of a process, and all that it wrote, in pieces."""
    ended, pieces, codes = threading.Event(), list[tuple[bytes, int | None]](), list[int]()

    def line(name: str, line: bytes, fd: int | None = None) -> None:
        pieces.append((line, fd))

    def end(name: str, code: int) -> None:
        codes.append(code)
        ended.set()

    with closing(Lifeline()) as lifeline:
        Child(process, lifeline).watch(line, end)
        assert ended.wait(20)
    return codes[0], pieces


def test_output_and_errors_may_be_kept_apart_and_come_in_pieces() -> None:
    code = "import sys; sys.stdout.write('out'); sys.stderr.write('err'); sys.exit(sys.stdin.isatty() or 3)"
    process = Process("a", [sys.executable, "-S", "-c", code], apart=True)
    returned, pieces = pieces_of(process)
    assert returned == 3
    assert sorted(pieces, key=str) == [(b"err", 2), (b"out", 1)]


def test_an_environment_may_be_given_as_a_whole() -> None:
    code = "import os; print(sorted(each for each in os.environ if each in ('PATH', 'A', 'B')))"
    _, pieces = pieces_of(Process("a", [sys.executable, "-S", "-c", code], base={"A": "1"}, env={"B": "2"}))
    assert pieces == [(b"['A', 'B']" + os.linesep.encode(), None)]


@posix_only
def test_output_may_be_a_terminal() -> None:
    code = "import sys; print(sys.stdout.isatty(), flush=True); print(sys.stderr.isatty(), file=sys.stderr)"
    _, pieces = pieces_of(Process("a", [sys.executable, "-S", "-c", code], apart=True, terminal=True))
    for fd in (1, 2):  # a line may come in pieces, and those of the two may take turns
        assert b"".join(text for text, of in pieces if of == fd) == b"True\r\n"


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
    told = [line for line in lines if line.startswith("[launch]")]
    # A busy machine may take a second to end it, and then it is said to be still running once more.
    assert list(dict.fromkeys(told)) == [f"[launch] {each}" for each in said]


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
