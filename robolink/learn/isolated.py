"""Check in a process of its own: an endless loop, `exit()` or crash of a student's file ends nothing else."""

from __future__ import annotations

import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from robolink.learn.exercise import Exercise, read_exercise
from robolink.learn.languages import Language
from robolink.learn.process import limit_memory, run_apart, show_own_lines
from robolink.learn.report import Mistake, Report
from robolink.system.own_command import own_command

if TYPE_CHECKING:
    from robolink.learn.trial import Trial

LONGEST = 60.0
"""Seconds of real time after which a check is ended from outside, whatever it does."""

LARGEST = 8 * 2**20
"""Most bytes of a report: it comes from a process in which a student's program runs."""

COMMAND = "learn-check"
"""Hidden command of the process that checks."""


def check_apart(
    exercise: Exercise,
    file: Path,
    language: Language,
    *,
    longest: float = LONGEST,
    stop: threading.Event | None = None,
) -> Report:
    """Check a student's file in a process of its own, whose working directory is a temporary folder.

    Args:
        exercise: The exercise.
        file: The student's file.
        language: Language of the sentences.
        longest: Seconds after which the process is killed.
        stop: Event that ends the check, whose report nobody wants any more; None for none.

    Returns:
        The report; nothing that the file does raises.
    """
    begin = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="robolink-learn-", ignore_cleanup_errors=True) as scratch:
        out, work = Path(scratch, "report.json"), Path(scratch, "work")
        work.mkdir()
        words = [*own_command(), COMMAND, str(exercise.folder), str(file.resolve()), str(out), "--language", language]
        printed = run_apart(words, work, longest, stop)
        report = _read(out)
    return msgspec.structs.replace(report, printed=printed, seconds=time.perf_counter() - begin)


def _read(out: Path) -> Report:
    try:
        with out.open("rb") as file:
            return msgspec.json.decode(file.read(LARGEST), type=Report)
    except (OSError, msgspec.DecodeError):
        return Report(mistake=Mistake("ended all"))


# --- The other side: the process that checks ---


def serve(folder: Path, file: Path, out: Path, language: Language) -> None:
    """Check a student's file in this process, and write the report; ends the process if the program is stuck.

    Args:
        folder: Folder of the exercise.
        file: The student's file.
        out: File for the report.
        language: Language of the sentences.
    """
    from robolink.learn.checking import check  # late: whoever asks for a check does not need it
    from robolink.learn.watchdog import Watchdog, end_process

    sys.dont_write_bytecode = True  # no __pycache__ beside the student's file
    limit_memory()
    show_own_lines()
    trials: list[Trial] = []

    def stuck(mistake: Mistake) -> None:
        _write(out, Report(trials[0].lines, mistake, track=trials[0].track()))
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
