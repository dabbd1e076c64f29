"""Layout of what commands show: aligned columns, and durations in words."""

from __future__ import annotations

from collections.abc import Sequence


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a table, each column as wide as its widest cell.

    >>> aligned([["NODE", "STATE"], ["wall_follower", "running"]])
    ['NODE           STATE', 'wall_follower  running']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def shown_time(seconds: float) -> str:
    """Return a duration in words, with its two largest units at most.

    >>> [shown_time(each) for each in (3.2, 75, 7500, 200_000)]
    ['3 s', '1 min 15 s', '2 h 5 min', '2 d 7 h']
    """
    whole = max(0, int(seconds))
    for (unit, size), (smaller, part) in (
        (("d", 86400), ("h", 3600)),
        (("h", 3600), ("min", 60)),
        (("min", 60), ("s", 1)),
    ):
        if whole >= size:
            return f"{whole // size} {unit} {whole % size // part} {smaller}"
    return f"{whole} s"
