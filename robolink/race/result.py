"""Result of one program in a race, and the order of several."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from msgspec import Struct

from robolink.grading.mistakes import Mistake
from robolink.race.races import Race


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
