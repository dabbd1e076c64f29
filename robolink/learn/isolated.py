"""Check in a process of its own: an endless loop, `exit()` or crash of a student's file ends nothing else."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from robolink.grading.languages import Language
from robolink.grading.process import run_apart
from robolink.learn.exercise import Exercise, read_exercise
from robolink.learn.report import Report

if TYPE_CHECKING:
    from robolink.learn.trial import Trial

LONGEST = 60.0
"""Seconds of real time after which a check is ended from outside, whatever it does."""

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
    file = file.resolve()
    ended = run_apart([COMMAND, str(exercise.folder.resolve()), str(file), language], file, longest, stop=stop)
    try:
        report = msgspec.json.decode(ended.answer, type=Report)
    except msgspec.DecodeError:
        report = Report(mistake=ended.mistake)
    return msgspec.structs.replace(report, printed=ended.printed, seconds=time.perf_counter() - begin)


def serve(folder: Path, file: Path, answer: Path, language: Language) -> None:
    """Check a student's file in this process, which that ends: the other side of `check_apart`.

    Args:
        folder: Folder of the exercise.
        file: The student's file.
        answer: File for the report.
        language: Language of the sentences.
    """
    from robolink.grading.child import Child
    from robolink.learn.checking import check  # late: whoever asks for a check needs none of it

    child = Child(answer)

    def begun(trial: Trial) -> None:
        child.watch(trial, lambda mistake: Report(trial.lines, mistake, track=trial.track()))

    child.end(check(read_exercise(folder), file, language, begun=begun))
