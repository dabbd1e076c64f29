"""Results of a race: what a program has reached, the order of several, and their table for people and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from pathlib import Path

from msgspec import Struct

from robolink.grading.languages import MISTAKES, Language, Words, text_of
from robolink.grading.mistakes import Mistake
from robolink.race.courses import SIZE
from robolink.race.races import Race
from robolink.system.terminal import shown

SHOWN = 16
"""Digits of a hash that the table for people shows."""

COLUMNS = ["place", "program", "score", "unit", "progress", "contacts", "seed", "hash", "error"]

WORDS: Words = {
    **MISTAKES,
    "no program": (
        "no {text} here, nor one other Python file alone",
        "aqui não há {text}, nem um único outro arquivo Python",
    ),
    "race": ("{name}, seed {seed}: {rule}", "{name}, semente {seed}: {rule}"),
    "rule line": (
        "the time of one lap along the line, and 5 s for each contact",
        "o tempo de uma volta pela linha, e mais 5 s por contato",
    ),
    "rule maze": (
        "the time to the middle of the far corner, ({end}, {end}), and 5 s for each contact",
        "o tempo até o meio do canto oposto, ({end}, {end}), e mais 5 s por contato",
    ),
    "rule follow": (
        "metres along the wall in 120 s, 0.3 to 0.8 m away from it, less 5 m for each contact",
        "metros ao longo da parede em 120 s, de 0.3 a 0.8 m dela, menos 5 m por contato",
    ),
    "contact": ("{count} contact", "{count} contato"),
    "contacts": ("{count} contacts", "{count} contatos"),
    "progress": ("{share:.0%} of the way", "{share:.0%} do caminho"),
    "raced": ("{program} is done", "{program} terminou"),
}
"""Words of races, in English and Portuguese."""

words = partial(text_of, WORDS)
"""Returns a text: `words(language, key, **values)`."""


class Result(Struct, frozen=True):
    """Result of one program."""

    program: str = ""
    score: float | None = None
    """Score in the unit of the race; None if it was not finished, or the program failed."""
    progress: float = 0.0
    """Share of the way, from 0 to 1."""
    contacts: int = 0
    hash: str = ""
    """SHA-256 of the robot's true path: the same for the same program, race and seed."""
    mistake: Mistake | None = None
    """Mistake that ended the program."""


def ranked(race: Race, results: Iterable[Result]) -> list[tuple[int, Result]]:
    """Return results in order, each with its place: 1 is the best; 0 for those without a score."""
    sign = 1.0 if race.less_is_better else -1.0
    finished = [each for each in results if each.score is not None]
    others = [each for each in results if each.score is None]
    finished.sort(key=lambda each: sign * (each.score or 0.0))
    others.sort(key=lambda each: (each.mistake is not None, -each.progress))
    return [*_placed(finished), *((0, each) for each in others)]


def _placed(results: Sequence[Result]) -> list[tuple[int, Result]]:
    """Return results with their places; those with the same score share one."""
    scores = [each.score for each in results]
    return [(scores.index(each.score) + 1, each) for each in results]


def table(race: Race, results: Sequence[Result], seed: int, language: Language = "en") -> Iterator[str]:
    """Yield the lines of a table for people, in a language."""
    yield words(language, "race", name=race.name, seed=seed, rule=words(language, f"rule {race.name}", end=SIZE - 0.5))
    longest = max((len(shown(each.program)) for each in results), default=0)
    for place, each in ranked(race, results):
        yield f"{place or '-':>3}  {shown(each.program):{longest}}  {_said(race, each, language)}"


def _said(race: Race, result: Result, language: Language) -> str:
    if result.mistake is not None:
        return error_of(result, language)
    contacts = words(language, "contact" if result.contacts == 1 else "contacts", count=result.contacts)
    way = words(language, "progress", share=result.progress)
    score = way if result.score is None else f"{result.score:.2f} {race.unit}"
    return f"{score:>15}  {contacts:>11}  {result.hash[:SHOWN]}"


def error_of(result: Result, language: Language = "en") -> str:
    """Return in one line what went wrong with a program; '' if nothing did."""
    mistake = result.mistake
    if mistake is None:
        return ""
    head = words(language, mistake.kind, file=Path(result.program).name, line=mistake.line, text=mistake.text)
    text = mistake.text.partition("\n")[0]
    return f"{head} {text}" if mistake.kind in ("syntax", "exception", "elsewhere") else head


def noted(result: Result, language: Language = "en") -> str:
    """Return the note about a program that has ended: that it is done, or what went wrong with it."""
    error = error_of(result, language)
    return f"{result.program}: {error}" if error else words(language, "raced", program=result.program)


def as_csv(race: Race, results: Sequence[Result], seed: int) -> str:
    """Return a table as CSV, with a head."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows(race, results, seed):
        writer.writerow(["" if row[each] is None else row[each] for each in COLUMNS])
    return text.getvalue()


def rows(race: Race, results: Sequence[Result], seed: int) -> list[dict[str, object]]:
    """Return a table as rows of values by column; place and score are None for a program without a score."""
    return [
        {
            "place": place or None,
            "program": each.program,
            "score": each.score,
            "unit": race.unit,
            "progress": each.progress,
            "contacts": each.contacts,
            "seed": seed,
            "hash": each.hash,
            "error": error_of(each),
        }
        for place, each in ranked(race, results)
    ]
