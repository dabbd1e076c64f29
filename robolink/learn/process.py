"""Child process for a student's program: its output is bounded, and nothing of it is left."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO

MOST_PRINTED = 20_000
"""Most bytes of what a program prints that are kept."""

MOST_MEMORY = 4 * 2**30
"""Most bytes of address space that a program may have."""

STOP_WITHIN = 0.2
"""Period in seconds of the looks whether a process shall stop."""

_OURS = ("world", "test", "robolink")
"""Loggers whose lines a student does not need."""


def run_apart(words: Sequence[str], work: Path, longest: float, stop: threading.Event | None = None) -> str:
    """Run a process to its end, or kill it and all that it has started; return what it printed.

    Args:
        words: Its command line.
        work: Its working directory.
        longest: Seconds after which it is killed.
        stop: Event that has it killed before; None for none.
    """
    environ = {**os.environ, "PYTHONHASHSEED": "0", "PYTHONIOENCODING": "utf-8", "OPENBLAS_NUM_THREADS": "1"}
    kept: list[bytes] = []
    with subprocess.Popen(
        words,
        cwd=work,
        env=environ,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        start_new_session=True,
    ) as process:
        assert process.stdout is not None
        reader = threading.Thread(target=_keep, args=(process.stdout, kept), daemon=True)
        reader.start()
        try:
            _wait(process, longest, stop)
        finally:
            _kill(process)
            reader.join(1.0)
    return b"".join(kept)[:MOST_PRINTED].decode("utf-8", errors="replace")


def _wait(process: subprocess.Popen[bytes], longest: float, stop: threading.Event | None) -> None:
    """Wait for the end of a process, for so many seconds, or until it shall stop."""
    end = time.monotonic() + longest
    while (left := end - time.monotonic()) > 0 and not (stop is not None and stop.is_set()):
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(left if stop is None else min(left, STOP_WITHIN))
            return


def _keep(stream: IO[bytes], kept: list[bytes]) -> None:
    """Read a stream to its end, and keep its beginning."""
    left = MOST_PRINTED
    with contextlib.suppress(OSError, ValueError):
        while part := os.read(stream.fileno(), 65536):
            if left > 0:
                kept.append(part[:left])
                left -= len(part)


def _kill(process: subprocess.Popen[bytes]) -> None:
    """End a process and all that it has started."""
    with contextlib.suppress(OSError):
        if sys.platform == "win32":
            process.kill()
        else:
            os.killpg(process.pid, signal.SIGKILL)


def limit_memory() -> None:
    """Let this process have `MOST_MEMORY` at most, where the system can limit it: more is a MemoryError."""
    if sys.platform == "linux":
        import resource

        _, most = resource.getrlimit(resource.RLIMIT_AS)
        wanted = MOST_MEMORY if most == resource.RLIM_INFINITY else min(MOST_MEMORY, most)
        resource.setrlimit(resource.RLIMIT_AS, (wanted, most))


def show_own_lines() -> None:
    """Print what the student's nodes log, as `INFO robo: hello`, and nothing of the world's."""
    from robolink import logging
    from robolink.logging import Record
    from robolink.running.execution import ENDS_THE_SPINNING
    from robolink.text.tracebacks import without_own_frames

    def show(record: Record) -> None:
        is_told = record.message.startswith(ENDS_THE_SPINNING)  # by the report, with its line
        if record.name.partition(".")[0] not in _OURS and not is_told:
            text = without_own_frames(record.message)
            print(f"[{record.severity.name}] {record.name}: {text}", flush=True)  # noqa: T201

    logging.set_console_handler(show)
