"""Clock of a system under test."""

from __future__ import annotations

from typing import Protocol


class Timed(Protocol):
    """Protocol of a system whose time can pass."""

    @property
    def time(self) -> float:
        """Seconds since the beginning of the system."""

    def run(self, seconds: float) -> None:
        """Let `seconds` pass."""


class SystemClock:
    """The clock of a system: returns its time and lets it pass. Made by `System`, as `system.clock`."""

    def __init__(self, system: Timed) -> None:
        self._system = system

    @property
    def now(self) -> float:
        """Seconds since the beginning of the system."""
        return self._system.time

    def run(self, seconds: float) -> None:
        """Let time pass.

        Args:
            seconds: Duration in seconds of the system's time.

        Raises:
            NodeFailure: if a program failed meanwhile.
            ValueError: if `seconds` is negative or not finite.
        """
        __tracebackhide__ = True
        self._system.run(seconds)

    def run_until(self, seconds: float) -> None:
        """Let time pass until a point in time; return at once if it is over.

        Args:
            seconds: Seconds since the beginning of the system.

        Raises:
            NodeFailure: if a program failed meanwhile.
        """
        __tracebackhide__ = True
        self._system.run(max(0.0, seconds - self.now))
