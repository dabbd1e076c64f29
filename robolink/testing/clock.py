"""The time of a system under test, as its test sees it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from robolink.testing.system import System


class SystemClock:
    """Tells how late it is in a system, and lets time pass there."""

    def __init__(self, system: System) -> None:
        self._system = system

    @property
    def now(self) -> float:
        """Seconds since the beginning of the system."""
        return self._system.time

    def run(self, seconds: float) -> None:
        """Let so many seconds pass."""
        __tracebackhide__ = True
        self._system.run(seconds)

    def run_until(self, seconds: float) -> None:
        """Let time pass until so many seconds since the beginning; at once if they are over."""
        __tracebackhide__ = True
        self._system.run(max(0.0, seconds - self.now))
