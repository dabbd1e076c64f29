"""Check of a student's file in this process: runs the exercise's check.py, and makes a report of what comes of it."""

from __future__ import annotations

import importlib.util
import re
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink.grading.child import where_asleep
from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake, mistake_elsewhere, mistake_in, mistake_of
from robolink.learn.exercise import CHECK, Exercise, ExerciseError
from robolink.learn.report import Report
from robolink.learn.trial import Told, Trial
from robolink.testing.expectations import NodeFailure

_LACKING = re.compile(r"module 'student' has no attribute '(\w+)'.*", re.DOTALL)


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
    except Told:
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
