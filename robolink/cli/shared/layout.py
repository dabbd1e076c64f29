"""Layout of what commands show: aligned columns, durations in words, statistics, and paths as a shell takes them."""

from __future__ import annotations

import math
import os
import shlex
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple


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


class Figures(NamedTuple):
    """Statistics of some numbers, which are `number` in count."""

    mean: float
    low: float
    high: float
    deviation: float
    number: int


def figures_of(numbers: Sequence[float]) -> Figures | None:
    """Return the statistics of some numbers; None if there are none."""
    if not numbers:
        return None
    mean = math.fsum(numbers) / len(numbers)
    deviation = math.sqrt(math.fsum((each - mean) ** 2 for each in numbers) / len(numbers))
    return Figures(mean, min(numbers), max(numbers), deviation, len(numbers))


def shown(path: Path) -> str:
    """Return a path relative to the working directory if it is within."""
    here = Path.cwd()
    return os.path.relpath(path, here) if path.is_relative_to(here) else str(path)


def typed(path: Path) -> str:
    """Return a path as one types it into a shell here: in quotes if need be, and never like an option."""
    short = shown(path)
    short = f"./{short}" if short.startswith("-") else short
    return subprocess.list2cmdline([short]) if sys.platform == "win32" else shlex.quote(short)
