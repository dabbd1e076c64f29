"""How commands lay out what they show: columns, and how long something lasts."""

from __future__ import annotations

from collections.abc import Sequence


def aligned(rows: Sequence[Sequence[str]]) -> list[str]:
    """Give the lines of a table, of a width that suits each column.

    >>> aligned([["NODE", "STATE"], ["wall_follower", "running"]])
    ['NODE           STATE', 'wall_follower  running']
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]


def shown_time(seconds: float) -> str:
    """Write how long something lasts, by its two largest units at most.

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
