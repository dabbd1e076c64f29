"""Figures of the last messages of a topic, for `robolink topic hz`, `bw` and `delay`: rates, bandwidths, gaps."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from itertools import pairwise

from robolink.cli.shared.layout import Figures, figures_of

NS = 1e-9


class Window:
    """Sliding window of a topic's last `size` messages: the time of each arrival, in ns, and a number with it."""

    def __init__(self, size: int) -> None:
        self._times: deque[int] = deque(maxlen=size)
        self._values: deque[int] = deque(maxlen=size)
        self._lock = threading.Lock()
        self._new = 0
        self.total = 0
        """Number of messages since the beginning."""

    def add(self, at: int, value: int = 0) -> None:
        """Add a message. A time before the last one means that time was reset: what was before is dropped."""
        with self._lock:
            if self._times and at < self._times[-1]:
                self._times.clear()
                self._values.clear()
            self._times.append(at)
            self._values.append(value)
            self._new += 1
            self.total += 1

    def look(self) -> tuple[list[int], list[int], int]:
        """Return the times, the numbers, and how many messages came since the last look."""
        with self._lock:
            new, self._new = self._new, 0
            return list(self._times), list(self._values), new


def gaps(times: Sequence[int]) -> Figures | None:
    """Return the statistics of the gaps from each message to the next, in seconds."""
    return figures_of([(later - earlier) * NS for earlier, later in pairwise(times)])


def rate(times: Sequence[int]) -> float | None:
    """Return the rate in Hz; None for fewer than two messages, or if all came at once."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return (len(times) - 1) / spent if spent > 0 else None


def bandwidth(times: Sequence[int], sizes: Sequence[int]) -> float | None:
    """Return bytes a second, without the first message, which came at the beginning of the time measured."""
    spent = (times[-1] - times[0]) * NS if len(times) > 1 else 0.0
    return sum(sizes[1:]) / spent if spent > 0 else None


def as_bytes(number: float, like: float) -> str:
    """Return bytes as text in the unit that suits `like`, as in ros2: B, KB or MB, of a thousand each."""
    if like < 1e3:
        return f"{number:.0f} B"
    return f"{number / 1e3:.2f} KB" if like < 1e6 else f"{number / 1e6:.2f} MB"


def table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return rows under a centred header and a rule, as in ros2, with an empty line at the end."""
    widths = [max(len(each) for each in column) for column in zip(header, *rows, strict=True)]
    head = "   ".join(title.center(width) for title, width in zip(header, widths, strict=True))
    lines = ["   ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    return "\n".join([head, "=" * (sum(widths) + 3 * (len(widths) - 1)), *lines, ""])
