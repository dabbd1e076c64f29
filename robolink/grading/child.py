"""Child process for a student's program, from its own side: limits, a lifeline, a watchdog, and one answer.

The watchdog finds a program that does not go on, and the line at which it is, by processor time.
"""

from __future__ import annotations

import contextlib
import faulthandler
import os
import re
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import IO, NoReturn, Protocol

import msgspec

from robolink.grading.mistakes import Mistake, line_of
from robolink.grading.process import TRACE, signed, take_key
from robolink.host.patches.clocks import is_sleep
from robolink.supervisor.processes.lifeline import watch_lifeline
from robolink.system import clocks

SLOW = 10.0
"""Least time without progress, as a multiple of the processor time that this process took to begin."""

LOOK = 0.05
"""Period of its looks, in seconds."""

STUCK = 2.5
"""Seconds of a processor without any progress of virtual time after which a program is stuck."""

ASLEEP = 20.0
"""Seconds of real time without any progress: the program waits for something that does not come."""


MOST_MEMORY = 4 * 2**30
"""Most bytes of memory that a program may have."""

FROZEN = 10.0
"""Seconds of real time in which code in C (`9**9**9`) may let no other thread run, this one neither."""

REARM = 1.0
"""Period in which that time begins again, in seconds."""

SLOTS = 10
"""Looks notice progress of virtual time in tenths of a second: a timer of a nanosecond stands still as well."""

_OURS = ("world", "test", "robolink")
"""Loggers whose lines a student does not need."""
_END = re.compile(r"\S+ raised(?: while it was made)?:\nTraceback ")
"""Log message of a program's end by an exception (host/program.py), which the report tells."""


class Child:
    """Process that runs a student's program (the current one): nothing that the program does keeps it from its end.

    Args:
        answer: File for the answer.
    """

    def __init__(self, answer: Path) -> None:
        self._answer, self._key = answer, take_key()
        self._watchdog: Watchdog | None = None
        self._last = threading.Lock()
        """Held from the end on: the watchdog and the run may come to it at once, and one of them writes."""
        sys.dont_write_bytecode = True  # no __pycache__ beside the student's file
        _limit_memory()
        watch_lifeline()
        _show_own_lines()

    def watch(self, watched: Watched, so_far: Callable[[Mistake], msgspec.Struct]) -> None:
        """Begin to watch a run.

        Args:
            watched: The run.
            so_far: Returns the answer for a run that stands still, with the mistake.
        """
        trace = self._answer.with_name(TRACE).open("w", encoding="ascii")
        stuck = max(STUCK, SLOW * time.process_time())  # on a slow machine all takes longer
        memory = None if sys.platform == "linux" else memory_of_this_process()
        self._watchdog = Watchdog(
            watched, lambda mistake: self._end(so_far(mistake)), stuck=stuck, trace=trace, memory=memory
        )
        self._watchdog.start()

    def end(self, answer: msgspec.Struct) -> NoReturn:
        """Write the answer, and end this process at once, whatever its threads do."""
        if self._watchdog is not None:
            self._watchdog.stop()
        self._end(answer)

    def _end(self, answer: msgspec.Struct) -> NoReturn:
        self._last.acquire()
        try:
            with contextlib.suppress(Exception):  # the program has removed the folder, say: it gets no answer
                self._answer.write_bytes(signed(msgspec.json.encode(answer), self._key))
            for stream in (sys.stdout, sys.stderr):
                with contextlib.suppress(Exception):  # whatever the program has put there
                    stream.flush()
        finally:
            os._exit(0)


def _limit_memory() -> None:
    """Let this process have `MOST_MEMORY` at most, where the system limits it (Linux): more is a MemoryError.

    Elsewhere the watchdog looks.
    """
    if sys.platform == "linux":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        limit = MOST_MEMORY if most == resource.RLIM_INFINITY else min(MOST_MEMORY, most)
        resource.setrlimit(resource.RLIMIT_AS, (limit, most))


def _show_own_lines() -> None:
    """Print the log lines of the student's nodes, as `INFO robo: hello`, and none of the world's."""
    from robolink import logging
    from robolink.logging import Record
    from robolink.text.tracebacks import without_own_frames

    def show(record: Record) -> None:
        if record.name.partition(".")[0] not in _OURS and not _END.match(record.message):
            text = without_own_frames(record.message)
            print(f"[{record.severity.name}] {record.name}: {text}", flush=True)  # noqa: T201

    logging.set_console_handler(show)


class Watched(Protocol):
    """Protocol of what is watched: the run of a student's file."""

    file: Path

    def moment(self) -> tuple[float, int]:
        """Return how far it is: its virtual time in seconds, and a count."""


class Watchdog(threading.Thread):
    """Thread that calls `found` with the mistake when a run stands still.

    Args:
        watched: The run.
        found: Called once, on this thread.
        stuck: Seconds of a processor.
        asleep: Seconds of real time.
        trace: File for the trace of a process in which this thread cannot run any more; None lets it stand for ever.
        memory: Returns the bytes of memory that the process has; None where the system limits them.
    """

    def __init__(
        self,
        watched: Watched,
        found: Callable[[Mistake], object],
        *,
        stuck: float = STUCK,
        asleep: float = ASLEEP,
        trace: IO[str] | None = None,
        memory: Callable[[], int] | None = None,
    ) -> None:
        super().__init__(name="robolink learn's watchdog", daemon=True)
        self._watched, self._found, self._trace = watched, found, trace
        self._stuck, self._asleep, self._memory = stuck, asleep, memory
        self._over = threading.Event()

    def run(self) -> None:
        """Look until stopped."""
        moment, used, since = self._moment(), time.process_time(), clocks.monotonic()
        self._arm()
        armed = since
        while not self._over.wait(LOOK):
            if clocks.monotonic() - armed > REARM:
                self._arm()
                armed = clocks.monotonic()
            if self._moment() != moment:
                moment, used, since = self._moment(), time.process_time(), clocks.monotonic()
            elif time.process_time() - used > self._stuck or clocks.monotonic() - since > self._asleep:
                self._found(where_stuck(self._watched.file))
                return
            if self._memory is not None and self._memory() > MOST_MEMORY:
                self._found(Mistake("too large", f"{MOST_MEMORY >> 30} GB"))
                return

    def _moment(self) -> tuple[int, int]:
        seconds, sentences = self._watched.moment()
        return int(seconds * SLOTS), sentences

    def _arm(self) -> None:
        """Let this process end, with a trace of where it stands, if this thread cannot do so `FROZEN` from now on."""
        if self._trace is not None:
            faulthandler.dump_traceback_later(FROZEN, exit=True, file=self._trace)

    def stop(self) -> None:
        """Stop the watchdog."""
        self._over.set()


def memory_of_this_process() -> Callable[[], int]:
    """Return a function that returns the bytes of memory of this process; on Windows the reserved ones, too."""
    import psutil

    process = psutil.Process()

    def memory() -> int:
        found = process.memory_info()
        return int(getattr(found, "private", found.rss))

    return memory


def where_stuck(file: Path) -> Mistake:
    """Return at which line of a file some thread of this process is."""
    own = threading.get_ident()
    places = [_line(frame, str(file)) for thread, frame in sys._current_frames().items() if thread != own]
    line = next((each for each in places if each), 0)
    if not line:
        return Mistake("stuck somewhere")
    return Mistake("stuck", "", line, line_of(file, line))


def where_asleep(file: Path) -> Mistake | None:
    """Return at which line of a file some thread of this process is in a time.sleep; None if none is."""
    for frame in sys._current_frames().values():
        line = _sleeps_at(frame, str(file))
        if line:
            return Mistake("asleep", "", line, line_of(file, line))
    return None


def _sleeps_at(frame: FrameType | None, file: str) -> int:
    while frame is not None:
        caller = frame.f_back
        if is_sleep(frame) and caller is not None and caller.f_code.co_filename == file:
            return caller.f_lineno
        frame = caller
    return 0


def _line(frame: FrameType | None, file: str) -> int:
    while frame is not None:
        if frame.f_code.co_filename == file:
            return frame.f_lineno
        frame = frame.f_back
    return 0
