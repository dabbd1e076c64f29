"""Child process for a student's program, from its own side: limits, a lifeline, a watchdog, and one answer."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import NoReturn

import msgspec

from robolink.grading.process import TRACE
from robolink.learn.report import Mistake
from robolink.grading.signing import signed, take_key
from robolink.grading.watchdog import MOST_MEMORY, STUCK, Watchdog, Watched, memory_of_this_process
from robolink.supervisor.processes.lifeline import watch_lifeline

SLOW = 10.0
"""Least time without progress, as a multiple of the processor time that this process took to begin."""

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
        wanted = MOST_MEMORY if most == resource.RLIM_INFINITY else min(MOST_MEMORY, most)
        resource.setrlimit(resource.RLIMIT_AS, (wanted, most))


def _show_own_lines() -> None:
    """Print what the student's nodes log, as `INFO robo: hello`, and nothing of the world's."""
    from robolink import logging
    from robolink.logging import Record
    from robolink.text.tracebacks import without_own_frames

    def show(record: Record) -> None:
        if record.name.partition(".")[0] not in _OURS and not _END.match(record.message):
            text = without_own_frames(record.message)
            print(f"[{record.severity.name}] {record.name}: {text}", flush=True)  # noqa: T201

    logging.set_console_handler(show)
