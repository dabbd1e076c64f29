"""What every check gives: a problem, with its place in the description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from robolink.exceptions import shown


class Problem(NamedTuple):
    """Where, such as ``$.robots[0].pose``, and what is wrong; with `key`, that this key is there at all."""

    path: str
    message: str
    key: bool = False


def under(path: str, found: Iterator[Problem]) -> Iterator[Problem]:
    """Put what was found in a part where that part is."""
    return (each._replace(path=path + each.path) for each in found)


def repeated_names(names: Sequence[str], path: str, words: str) -> Iterator[Problem]:
    """Yield each name that has been there before; `path` has a place for its index."""
    seen: dict[str, int] = {}
    for index, name in enumerate(names):
        if name in seen:
            yield Problem(path.format(index), f"{words} '{shown(name)}': give this one another name")
        seen.setdefault(name, index)
