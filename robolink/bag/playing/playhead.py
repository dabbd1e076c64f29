"""Playhead: which time of the bag it is, at a rate, with pauses and jumps."""

from __future__ import annotations

import math
from collections.abc import Callable


class Playhead:
    """Map from steady time to that of a bag, both in nanoseconds; it stands still until `resume`.

    At the rate 1 it counts in whole numbers: messages keep their distances to the nanosecond.

    Args:
        steady: Function that returns steady time.
        rate: Nanoseconds of the bag in a nanosecond.
    """

    def __init__(self, steady: Callable[[], int], rate: float = 1.0) -> None:
        self._steady, self._rate = steady, rate
        self._begin = self._at = 0
        self.paused = True

    @property
    def rate(self) -> float:
        """Nanoseconds of the bag in a nanosecond."""
        return self._rate

    @rate.setter
    def rate(self, rate: float) -> None:
        now = self.now()
        self._rate = rate
        self.jump(now)

    def now(self) -> int:
        """Return the time in the bag."""
        passed = 0 if self.paused else self._steady() - self._begin
        if passed <= 0:  # it begins after a delay
            return self._at
        return self._at + (passed if self._rate == 1.0 else math.floor(passed * self._rate))

    def due(self, at: int) -> int:
        """Return the steady time at which it is `at` in the bag, while it runs on."""
        left = at - self._at
        return self._begin + (left if self._rate == 1.0 else math.ceil(left / self._rate))

    def jump(self, at: int, delay: int = 0) -> None:
        """Set the time in the bag; while it runs, go on from there after `delay`."""
        self._at, self._begin = at, self._steady() + delay

    def pause(self) -> None:
        """Stand still."""
        self._at = self.now()
        self.paused = True

    def resume(self) -> None:
        """Go on."""
        if self.paused:
            self.paused = False
            self._begin = self._steady()
