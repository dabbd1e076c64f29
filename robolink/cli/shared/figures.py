"""Statistics of measured numbers: mean, least, greatest and standard deviation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple


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
