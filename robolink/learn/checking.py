"""Check of a student's file, in this process or in one of its own, and the report of what comes of it."""

from __future__ import annotations

import importlib.util
import re
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake, mistake_elsewhere, mistake_in, mistake_of
from robolink.grading.process import run_apart
from robolink.learn.exercise import CHECK, Exercise, ExerciseError, read_exercise
from robolink.learn.report import Report
from robolink.learn.trial import Reported, Trial
from robolink.testing.expectations import NodeFailure

if TYPE_CHECKING:
    pass

_LACKING = re.compile(r"module 'student' has no attribute '(\w+)'.*", re.DOTALL)

LONGEST = 60.0
"""Seconds of real time after which a check is ended from outside, whatever it does."""

COMMAND = "learn-check"
"""Hidden command of the process that checks."""


def check(
    exercise: Exercise, file: Path, language: Language = "en", *, begun: Callable[[Trial], object] | None = None
) -> Report:
    """Check a student's file, in this process; an endless loop in it does not come back.

    Args:
        exercise: The exercise.
        file: The student's file.
        language: Language of the sentences.
        begun: Called with the trial before the check runs, for a watchdog.

    Returns:
        The report; nothing that the file does raises.
    """
    begin = time.perf_counter()
    trial = Trial(exercise, file.resolve(), language)
    if begun is not None:
        begun(trial)
    mistake = mistake_in(trial.file)
    is_over = False
    if mistake is None:
        mistake = _ran(trial)
        is_over = trial.is_over
    track = trial.track()
    at_end = _closed(trial)
    return Report(trial.lines, mistake or at_end, is_over, seconds=time.perf_counter() - begin, track=track)


def _closed(trial: Trial) -> Mistake | None:
    """End all programs; return the mistake of what one of them does at its end."""
    try:
        trial.close()
    except BaseException as error:  # noqa: BLE001 - as below
        return mistake_of(error, trial.file) or mistake_elsewhere(error)
    return None


def _ran(trial: Trial) -> Mistake | None:
    """Run check.py; return the mistake that ended it."""
    try:
        _check_of(trial.exercise)(trial)
        if trial._system is not None:
            trial.system.check()
    except Reported:
        return _of_program(trial)
    except ExerciseError as error:
        return Mistake("check", str(error))
    except BaseException as error:  # noqa: BLE001 - whatever a student's file raises is told
        return (
            mistake_of(error, trial.file)
            or _of_use(error, trial)
            or _elsewhere(error)
            or Mistake("check", _place(error, trial.exercise))
        )
    return None


def _of_use(error: BaseException, trial: Trial) -> Mistake | None:
    """Return the mistake of a module that lacks a name, or has a function with other arguments, as a check found."""
    if not trial.has_imported or not isinstance(error, (AttributeError, TypeError)):
        return None
    if isinstance(error, AttributeError) and isinstance(error.obj, Trial):
        return None
    lacking = _LACKING.fullmatch(str(error))
    return Mistake("lacks", lacking[1]) if lacking else Mistake("use", str(error))


def _of_program(trial: Trial) -> Mistake | None:
    """Return the mistake of a program that failed, or sleeps, at the very moment at which something was told."""
    from robolink.grading.child import where_asleep  # late: whoever asks for a check apart needs none of it

    try:
        if trial._system is not None:
            trial.system.check()
    except NodeFailure as error:
        return mistake_of(error, trial.file) or _elsewhere(error)
    except BaseException as error:  # noqa: BLE001 - as above
        return mistake_of(error, trial.file)
    return where_asleep(trial.file) or _of_types(trial)


def _elsewhere(error: BaseException) -> Mistake | None:
    """Return the mistake of a program that failed at none of its own lines, with what its callback returned for one."""
    return mistake_elsewhere(error.__cause__ or error) if isinstance(error, NodeFailure) else None


def _of_types(trial: Trial) -> Mistake | None:
    """Return the mistake of a topic that has one type here and another one there."""
    topics = {} if trial._system is None else trial.system.topics
    return next((Mistake("types", f"{name}: {types}") for name, types in topics.items() if ", " in types), None)


def _check_of(exercise: Exercise) -> Callable[[Trial], Any]:
    spec = importlib.util.spec_from_file_location(f"robolink_check_{exercise.name}", exercise.folder / CHECK)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.check  # type: ignore[no-any-return]


def _place(error: BaseException, exercise: Exercise) -> str:
    frames = [each for each in traceback.extract_tb(error.__traceback__) if each.filename.endswith(CHECK)]
    where = f" ({exercise.folder / CHECK}:{frames[-1].lineno})" if frames else f" ({exercise.folder})"
    return f"{type(error).__name__}: {error}".partition("\n")[0] + where


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

    child = Child(answer)

    def begun(trial: Trial) -> None:
        child.watch(trial, lambda mistake: Report(trial.lines, mistake, track=trial.track()))

    child.end(check(read_exercise(folder), file, language, begun=begun))
