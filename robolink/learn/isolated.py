"""Check in a process of its own: an endless loop, `exit()` or crash of a student's file ends nothing else."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import msgspec

from robolink.learn.checking import check
from robolink.learn.exercise import Exercise, read_exercise
from robolink.learn.languages import Language
from robolink.learn.report import Mistake, Report
from robolink.learn.trial import Trial
from robolink.learn.watchdog import Watchdog, end_process
from robolink.system.own_command import own_command

LONGEST = 60.0
"""Seconds of real time after which a check is ended from outside, whatever it does."""

MOST_PRINTED = 20_000
"""Most bytes of what a program prints that are kept."""

COMMAND = "learn-check"
"""Hidden command of the process that checks."""

_OURS = ("world", "test", "robolink")
"""Loggers whose lines a student does not need."""


def check_apart(exercise: Exercise, file: Path, language: Language, *, longest: float = LONGEST) -> Report:
    """Check a student's file in a process of its own, whose working directory is a temporary folder.

    Args:
        exercise: The exercise.
        file: The student's file.
        language: Language of the sentences.
        longest: Seconds after which the process is killed.

    Returns:
        The report; nothing that the file does raises.
    """
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="robolink-learn-", ignore_cleanup_errors=True) as scratch:
        out, work = Path(scratch, "report.json"), Path(scratch, "work")
        work.mkdir()
        words = [*own_command(), COMMAND, str(exercise.folder), str(file.resolve()), str(out), "--language", language]
        printed = _run(words, work, longest)
        report = _read(out)
    return msgspec.structs.replace(report, printed=printed, seconds=time.perf_counter() - begin)


def _read(out: Path) -> Report:
    try:
        return msgspec.json.decode(out.read_bytes(), type=Report)
    except (OSError, msgspec.DecodeError):
        return Report(mistake=Mistake("ended all"))


def _run(words: Sequence[str], work: Path, longest: float) -> str:
    """Run a process to its end, or kill it; return what it printed."""
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
            process.wait(longest)
        except subprocess.TimeoutExpired:
            pass
        finally:
            _kill(process)
            reader.join(1.0)
    return b"".join(kept)[:MOST_PRINTED].decode("utf-8", errors="replace")


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


# --- The other side: the process that checks ---


def serve(folder: Path, file: Path, out: Path, language: Language) -> None:
    """Check a student's file in this process, and write the report; ends the process if the program is stuck.

    Args:
        folder: Folder of the exercise.
        file: The student's file.
        out: File for the report.
        language: Language of the sentences.
    """
    sys.dont_write_bytecode = True  # no __pycache__ beside the student's file
    _show_own_lines()
    trials: list[Trial] = []

    def stuck(mistake: Mistake) -> None:
        _write(out, Report(trials[0].lines, mistake))
        end_process()

    watchdogs: list[Watchdog] = []

    def begun(trial: Trial) -> None:
        trials.append(trial)
        watchdogs.append(Watchdog(trial, stuck))
        watchdogs[0].start()

    report = check(read_exercise(folder), file, language, begun=begun)
    watchdogs[0].stop()
    _write(out, report)
    end_process()


def _write(out: Path, report: Report) -> None:
    out.write_bytes(msgspec.json.encode(report))


def _show_own_lines() -> None:
    """Show what the student's nodes log, as `INFO robo: hello`, and nothing of the world's."""
    from robolink import logging
    from robolink.logging import Record

    def show(record: Record) -> None:
        if record.name.partition(".")[0] not in _OURS:
            print(f"[{record.severity.name}] {record.name}: {record.message}", flush=True)  # noqa: T201

    logging.set_console_handler(show)
