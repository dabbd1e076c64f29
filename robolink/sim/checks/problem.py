"""Result of every check: a problem, with its place in the description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from robolink.system.terminal import shown


class Problem(NamedTuple):
    """A mistake: its path, such as ``$.robots[0].pose``, and the reason; with `key` the key itself is the mistake."""

    path: str
    message: str
    key: bool = False


def under(path: str, found: Iterator[Problem]) -> Iterator[Problem]:
    """Prefix the paths of a part's problems with the path of the part."""
    return (each._replace(path=path + each.path) for each in found)


def repeated_names(names: Sequence[str], path: str, words: str) -> Iterator[Problem]:
    """Yield a problem for each name that was there before; `path` has a placeholder for its index."""
    seen: dict[str, int] = {}
    for index, name in enumerate(names):
        if name in seen:
            yield Problem(path.format(index), f"{words} '{shown(name)}': give this one another name")
        seen.setdefault(name, index)
