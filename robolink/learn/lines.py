"""Texts for the terminal: the list of exercises with progress, and the report of a check."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import NamedTuple

from robolink.grading.languages import Language
from robolink.grading.mistakes import Mistake
from robolink.learn.exercise import Exercise
from robolink.learn.folder import StudentFolder
from robolink.learn.report import Report
from robolink.learn.words import words

WIDTH = 78
"""Widest line of a report, in letters."""

WIDEST = 200
"""Most letters that are shown of a line of a program, or of its output."""

MOST_LINES = 15
"""Most lines of what a program printed that are shown."""


def listed(folder: StudentFolder) -> Iterator[str]:
    """Yield the lines of the list: the exercises, those that are done marked, and what is next."""
    language, following = folder.language, folder.next
    yield words(language, "heading", done=folder.done, all=len(folder.course))
    longest = max(len(each.file) for each in folder.course)
    for each in folder.course:
        mark = "✓" if each.name in folder.progress.done else "→" if each is following else " "
        yield f"  {mark} {each.file:{longest}}  {each.title(language)}"
    yield ""
    yield from next_step(folder)


def course_listed(course: list[Exercise], language: Language, below: str = "") -> Iterator[str]:
    """Yield the lines of a list for somebody who has no folder yet, or has it `below` the working directory."""
    longest = max(len(each.file) for each in course)
    for each in course:
        yield f"  {each.file:{longest}}  {each.title(language)}"
    yield ""
    yield words(language, "go", folder=below) if below else words(language, "no folder")


def next_step(folder: StudentFolder) -> Iterator[str]:
    """Yield the next step, in lines."""
    following = folder.next
    if following is None:
        yield words(folder.language, "all done")
    else:
        yield words(folder.language, "next", file=following.file, title=following.title(folder.language))
        verb = "launch" if following.file.endswith(".yaml") else "run"
        yield words(folder.language, "how", verb=verb, file=following.file)


def task(exercise: Exercise, language: Language) -> Iterator[str]:
    """Yield the task of an exercise in lines."""
    yield f"{exercise.file}: {exercise.title(language)}"
    yield ""
    yield from exercise.text(language).splitlines()


class Finding(NamedTuple):
    """Sentence of a report with its mark, and lines of code or of an error below it."""

    mark: str
    text: str
    below: tuple[str, ...] = ()


def findings(exercise: Exercise, report: Report, language: Language) -> Iterator[Finding]:
    """Yield the sentences of a report, as the terminal and the page show them."""
    for each in report.lines:
        yield Finding("✓" if each.good else "✗", each.text)
    if report.mistake is not None:
        yield _mistake(exercise, report.mistake, language)
    elif report.is_over and not report.passed and "spin" in exercise.given_text(language):  # a script may end
        yield Finding(" ", words(language, "is over"))


def reported(exercise: Exercise, report: Report, language: Language) -> Iterator[str]:
    """Yield the report of a check in lines."""
    yield from _printed(report.printed, language)
    for each in findings(exercise, report, language):
        yield from _item(each.mark, each.text)
        yield from (f"    {line}" for line in each.below)
    key = "done" if report.passed else "not yet"
    yield words(language, key, file=exercise.file, name=exercise.name, seconds=report.seconds)


def _printed(text: str, language: Language) -> Iterator[str]:
    lines = printed_lines(text, language)
    if lines:
        yield words(language, "printed")
        yield from (f"    {each}" for each in lines)


def printed_lines(text: str, language: Language) -> list[str]:
    """Return the first lines of what a program printed, and how many more there are."""
    lines = text.splitlines()
    more = [words(language, "more", count=len(lines) - MOST_LINES)] if len(lines) > MOST_LINES else []
    return [each[:WIDEST] for each in lines[:MOST_LINES]] + more


def _mistake(exercise: Exercise, mistake: Mistake, language: Language) -> Finding:
    head = words(language, mistake.kind, file=exercise.file, line=mistake.line, text=mistake.text)
    below = [f"{mistake.line:4} | {mistake.code[:WIDEST]}"] if mistake.line else []
    if mistake.kind in ("syntax", "exception", "elsewhere"):
        below += mistake.text.splitlines()
    return Finding("✗", head, tuple(below))


def _item(mark: str, text: str) -> Iterator[str]:
    yield from textwrap.wrap(text, WIDTH, initial_indent=f"  {mark} ", subsequent_indent="    ") or [f"  {mark}"]
