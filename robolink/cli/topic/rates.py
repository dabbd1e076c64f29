"""What `robolink topic hz`, `bw` and `delay` compute: figures of the last messages of a topic."""

from __future__ import annotations

import math
import threading
from collections import deque
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

NS = 1e-9


class Figures(NamedTuple):
    """What is said of some numbers; how many they are is `number`."""

    mean: float
    low: float
    high: float
    deviation: float
    number: int


class Window:
    """The last `size` messages of a topic: when each came, in nanoseconds, and a number that goes with it."""

    def __init__(self, size: int) -> None:
        self._times: deque[int] = deque(maxlen=size)
        self._values: deque[int] = deque(maxlen=size)
        self._lock = threading.Lock()
        self._new = 0
        self.total = 0
        """Messages since the beginning."""

    def add(self, at: int, value: int = 0) -> None:
        """Note a message. A time before the last one means that time began anew: what was before is forgotten."""
        with self._lock:
            if self._times and at < self._times[-1]:
                self._times.clear()
                self._values.clear()
            self._times.append(at)
            self._values.append(value)
            self._new += 1
            self.total += 1

    def look(self) -> tuple[list[int], list[int], int]:
        """Give the times, the numbers, and how many messages came since the last look."""
        with self._lock:
            new, self._new = self._new, 0
            return list(self._times), list(self._values), new


def figures_of(numbers: Sequence[float]) -> Figures | None:
    """Give mean, least, greatest and standard deviation; None of nothing."""
    if not numbers:
        return None
    mean = math.fsum(numbers) / len(numbers)
    deviation = math.sqrt(math.fsum((each - mean) ** 2 for each in numbers) / len(numbers))
    return Figures(mean, min(numbers), max(numbers), deviation, len(numbers))


def gaps(times: Sequence[int]) -> Figures | None:
    """Give the figures of the seconds from each message to the next."""
    return figures_of([(later - earlier) * NS for earlier, later in pairwise(times)])


def rate(times: Sequence[int]) -> float | None:
    """Give messages a second; None of fewer than two, or when all came at once."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return (len(times) - 1) / spent if spent > 0 else None


def bandwidth(times: Sequence[int], sizes: Sequence[int]) -> float | None:
    """Give bytes a second: what came after the first message, for it came at the beginning of the time measured."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return sum(sizes[1:]) / spent if spent > 0 else None


def as_bytes(number: float, like: float) -> str:
    """Spell bytes in the unit that suits `like`, as ros2 does: B, KB or MB, of a thousand each."""
    if like < 1e3:
        return f"{number:.0f} B"
    return f"{number / 1e3:.2f} KB" if like < 1e6 else f"{number / 1e6:.2f} MB"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Lay out rows under a centred header and a rule, as ros2 does, and end in an empty line."""
    widths = [max(len(each) for each in column) for column in zip(header, *rows, strict=True)]
    head = "   ".join(title.center(width) for title, width in zip(header, widths, strict=True))
    lines = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([head, "=" * (sum(widths) + 3 * (len(widths) - 1)), *lines, ""])
