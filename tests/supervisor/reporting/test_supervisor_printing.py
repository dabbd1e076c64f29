"""How lines reach a terminal, a pipe or a file: whole, in order, and with a bound on what waits."""

from __future__ import annotations

import errno
import io
import os
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.supervisor.reporting.background_queue import MOST_WAITING, BackgroundQueue, Troubles
from robolink.supervisor.reporting.printer import Printer, Writer

PATIENCE = 30.0


def test_of_what_a_terminal_obeys_a_process_may_only_set_colours() -> None:
    output = io.StringIO()
    printer = Printer(output, ["a"])
    printer.line("a", "\x1b[1;31mred\x1b[0m\x1b[2J\x1b]0;title\x07 \x9b2J \u202e over\rwritten\ttab\r\n".encode())
    printer.say("\x1b[2Ja cause")
    printer.close(PATIENCE)
    assert output.getvalue() == (
        "[a] \x1b[1;31mred\x1b[0m\\x1b[2J\\x1b]0;title\\x07 \\u009b2J \\u202e over\\rwritten\ttab\n"
        "[launch] \\x1b[2Ja cause\n"
    )


def test_letters_reach_a_pipe_and_nobody_waits_for_a_broken_one() -> None:
    reading, writing = os.pipe()
    reasons: list[str] = []
    with os.fdopen(writing, "w") as output:
        printer = Printer(output, ["a"], Troubles(broken=reasons.append))
        printer.line("a", "a ~ ä 中\u00a0".encode())
        with os.fdopen(reading, "rb") as received:
            assert received.readline() == "[a] a ~ ä 中\u00a0\n".encode()
        for _ in range(5000):
            printer.line("a", b"x" * 100)
        printer.close(PATIENCE)
    assert len(reasons) == 1
    assert os.strerror(errno.EPIPE) in reasons[0] or sys.platform == "win32"


def test_a_terminal_that_stands_still_does_not_hold_us_up() -> None:
    go_on = threading.Event()

    class Still(io.StringIO):
        def write(self, text: str) -> int:
            go_on.wait(PATIENCE)
            return super().write(text)

    output = Still()
    printer = Printer(output, ["a"])
    for _ in range(3000):
        printer.say("ready")
    printer.close(timeout=0.01)
    go_on.set()
    printer.close()
    assert output.getvalue().startswith("[launch] ready\n")


# --- what waits -----------------------------------------------------------------------------------------------


def test_what_waits_for_a_reader_that_stands_still_is_bounded_in_bytes() -> None:
    go_on = threading.Event()
    delivered: list[bytes] = []
    most = 0

    def deliver(things: list[bytes]) -> None:
        go_on.wait(PATIENCE)
        delivered.extend(things)

    background = BackgroundQueue(deliver, Troubles(), name="test")

    def feed() -> None:
        nonlocal most
        for index in range(1000):
            background.put(b"%d" % index, 100_000)
            most = max(most, background.waiting)

    feeder = threading.Thread(target=feed, daemon=True)
    feeder.start()
    deadline = time.monotonic() + PATIENCE
    while background.waiting < MOST_WAITING and time.monotonic() < deadline:
        time.sleep(0.001)
    for _ in range(10_000):
        background.put_own(b"own", 1000)  # never waits
    assert background.waiting <= 2 * MOST_WAITING + 100_000
    go_on.set()
    feeder.join(PATIENCE)
    background.close(PATIENCE)
    assert [each for each in delivered if each != b"own"] == [b"%d" % index for index in range(1000)]
    assert most <= 2 * MOST_WAITING + 100_000
    assert delivered.count(b"own") == MOST_WAITING // 1000


def test_nobody_waits_for_a_courier_that_is_closed_or_that_a_mistake_has_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    hooked = threading.Event()
    monkeypatch.setattr(threading, "excepthook", lambda args: hooked.set())

    def deliver(things: list[bytes]) -> None:
        raise KeyError("a mistake")

    background = BackgroundQueue(deliver, Troubles(), name="test")
    for _ in range(3):
        background.put(b"", MOST_WAITING)
    assert hooked.wait(PATIENCE)
    background.close(PATIENCE)
    background.put(b"", MOST_WAITING)
    background.put(b"", MOST_WAITING)


# --- outputs that take a part, or nothing ---------------------------------------------------------------------


class Raw(io.RawIOBase):
    """Takes so many bytes at a time, in turn: None when it would have to wait, an error when there is no room."""

    def __init__(self, takes: list[int | None]) -> None:
        self.takes, self.written = takes, b""

    def writable(self) -> bool:
        return True

    def write(self, data: memoryview) -> int | None:  # type: ignore[override]
        take = self.takes.pop(0) if self.takes else len(data)
        if take is not None and take < 0:
            raise OSError(-take, os.strerror(-take))
        self.written += bytes(data[:take]) if take else b""
        return None if take is None else min(take, len(data))


class Output(io.StringIO):
    """A text output above a raw file, as standard output is with PYTHONUNBUFFERED."""

    def __init__(self, raw: Raw) -> None:
        super().__init__()
        self.raw = raw

    @property
    def buffer(self) -> Raw:  # type: ignore[override]
        return self.raw


@given(st.lists(st.integers(1, 5) | st.none(), max_size=10))
def test_a_line_is_whole_however_little_is_taken_at_a_time(takes: list[int | None]) -> None:
    raw = Raw(takes)
    Writer(Output(raw)).write(b"[a] a whole line\n")
    assert raw.written == b"[a] a whole line\n"


def test_a_full_disk_loses_lines_and_is_told_of_once() -> None:
    raw = Raw([6, -errno.ENOSPC, -errno.ENOSPC])
    lost: list[str] = []
    broken: list[str] = []
    printer = Printer(Output(raw), ["a"], Troubles(broken.append, lost.append))
    for index, until in enumerate([1, 0, 0]):  # each line on its own, as far as the output goes
        printer.line("a", b"line %d" % index)
        deadline = time.monotonic() + PATIENCE
        while len(raw.takes) > until and time.monotonic() < deadline:
            time.sleep(0.001)
    printer.line("a", b"there is room again")
    printer.close(PATIENCE)
    assert raw.written.startswith(b"[a] li\n")
    assert raw.written.endswith(b"\n[a] there is room again\n")
    assert lost == [f"[Errno {errno.ENOSPC}] {os.strerror(errno.ENOSPC)}"]
    assert broken == []


SYSTEM = """
import sys
from robolink.supervisor import Process, Supervisor
code = "print('x' * 5000); raise SystemExit(3)"
raise SystemExit(Supervisor([Process("a", [sys.executable, "-c", code])]).run())
"""


@pytest.mark.processes
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="only Linux has a file for which there is never room")
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_a_system_goes_on_when_there_is_no_room_for_its_output(unbuffered: str) -> None:
    environ = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    with Path("/dev/full").open("wb") as full:
        ended = subprocess.run(
            [sys.executable, "-c", SYSTEM], stdout=full, stderr=subprocess.PIPE, text=True, check=False, env=environ
        )
    assert ended.returncode == 3
    assert ended.stderr.splitlines() == [
        f"[launch] lines of the output are lost: [Errno {errno.ENOSPC}] {os.strerror(errno.ENOSPC)}"
    ]
