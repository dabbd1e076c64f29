"""Exercises of a teacher: a new one from a template, and the proof that one can be solved and must be."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from robolink.grading.languages import Language
from robolink.learn.exercise import LONGEST_NAME, SETTINGS, Exercise, ExerciseError
from robolink.learn.report import Report
from robolink.learn.words import words
from robolink.scaffold.writing import rendered, written
from robolink.system.files import expanded

FOLDER = "exercises"
"""Name of the folder for a teacher's exercises."""

_NAME = re.compile(r"[a-z][a-z0-9_]*")

Check = Callable[[Exercise, Path, Language], Report]


def new_exercise(name: str, folder: str = "", language: Language = "en") -> Path:
    """Make an exercise that works, to be changed; return its folder.

    Args:
        name: Name of the exercise: small letters, digits and `_`.
        folder: Folder of the exercises; by default the working directory if it has some, else `FOLDER` in it.
        language: Language of the comments in its files.

    Raises:
        ExerciseError: (a ValueError) if the name is not valid, or there is such an exercise.
        OSError: if the files cannot be written.
    """
    if not _NAME.fullmatch(name) or len(name) > LONGEST_NAME:
        raise ExerciseError(
            f"'{name[:LONGEST_NAME]}' is not a name for an exercise: small letters, digits and '_', as in stop_early"
        )
    here = Path.cwd()
    place = expanded(folder) if folder else here if any(here.glob(f"*/{SETTINGS}")) else here / FOLDER
    there = [each.parent.name for each in place.glob(f"*/{SETTINGS}")]
    if any(each.partition("_")[2] == name for each in there):
        raise ExerciseError(f"{place} has an exercise '{name}' already: take another name")
    numbers = [int(each.partition("_")[0]) for each in there if each.partition("_")[0].isdecimal()]
    made = place / f"{max(numbers, default=0) + 1:02}_{name}"
    files = rendered("exercise", {"NAME": name}) | (rendered("exercise_pt", {"NAME": name}) if language == "pt" else {})
    return written(made, name, files).folder


class Proof(NamedTuple):
    """Finding about an exercise: whether it is as it should be, and a sentence."""

    exercise: Exercise
    good: bool
    text: str


def proofs(course: list[Exercise], check: Check, language: Language = "en") -> Iterator[Proof]:
    """Yield for each exercise that the given file fails, and then, in the other language, that the solution passes.

    Args:
        course: The exercises.
        check: Runs a check: `robolink.learn.checking.check_apart`, for example.
        language: Language of the sentences, and of the given file.
    """
    with tempfile.TemporaryDirectory(prefix="robolink-learn-", ignore_cleanup_errors=True) as scratch:
        for exercise in course:
            file = Path(scratch, exercise.file)
            file.write_text(exercise.given_text(language), encoding="utf-8")
            yield _of_given(exercise, check(exercise, file, language), language)
            solution = exercise.given.with_name(f"solution{exercise.given.suffix}")
            if solution.is_file():
                file.write_bytes(solution.read_bytes())
                report = check(exercise, file, "en" if language == "pt" else "pt")
                yield _of_solution(exercise, solution, report, language)


def _of_given(exercise: Exercise, report: Report, language: Language) -> Proof:
    file = exercise.given.name
    if report.mistake is not None and report.mistake.kind == "check":
        return Proof(exercise, False, words(language, "broken check", text=report.mistake.text))
    if report.passed:
        return Proof(exercise, False, words(language, "passes already", file=file))
    return Proof(exercise, True, words(language, "fails", file=file, text=_sentence(file, report, language)))


def _of_solution(exercise: Exercise, solution: Path, report: Report, language: Language) -> Proof:
    if report.passed:
        return Proof(exercise, True, words(language, "passes", file=solution.name, seconds=report.seconds))
    text = _sentence(solution.name, report, language)
    return Proof(exercise, False, words(language, "fails", file=solution.name, text=text))


def _sentence(file: str, report: Report, language: Language) -> str:
    """Return the sentence that says most of why a check failed."""
    mistake = report.mistake
    if mistake is None:
        bad = next((each.text for each in report.lines if not each.good), "")
        return bad or words(language, "told nothing")
    text = mistake.text or words(language, mistake.kind, file=file, line=mistake.line, text="")
    return words(language, "at line", text=text, line=mistake.line) if mistake.line else text
