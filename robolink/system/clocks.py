"""High-resolution system clocks: Python's own ones have steps of 15.6 ms on Windows."""

from __future__ import annotations

import functools
import sys
import time
from collections.abc import Callable

_UNIX_BEGINS = 11_644_473_600 * 10**7
"""UNIX epoch in Windows' time: tenths of a microsecond since the year 1601."""


def _finest_now() -> Callable[[], int]:
    if sys.platform == "win32" and sys.version_info < (3, 13):  # from then on Python asks the same
        import ctypes

        ask = ctypes.WinDLL("kernel32").GetSystemTimePreciseAsFileTime
        ask.restype = None

        def precise_now() -> int:
            found = ctypes.c_uint64()
            ask(ctypes.byref(found))
            return (found.value - _UNIX_BEGINS) * 100

        return precise_now
    return time.time_ns


def from_1970(read: Callable[[], int]) -> Callable[[], int]:
    """Return a clock that shows 0 while `read` shows a date before 1970: ROS has no such times.

    It is `read` itself, a function in C, where that shows none now: a board without a battery may begin there, but
    what has a date does not go back so far.
    """
    return read if read() > 0 else lambda: max(0, read())


now = from_1970(_finest_now())
"""Return the time of day, in nanoseconds since the UNIX epoch."""

steady = time.perf_counter_ns if sys.platform == "win32" else time.monotonic_ns
"""Return the monotonic time in nanoseconds, from some start."""

monotonic = time.perf_counter if sys.platform == "win32" else time.monotonic
"""Return the same time as `steady`, in seconds."""


def time_of_day() -> float:
    """Return the time of day, in seconds since the UNIX epoch."""
    return now() / 1e9


@functools.cache
def make_waits_exact() -> None:
    """Set the system timer's resolution to 1 ms: Windows otherwise ends waits 64 times a second only.

    A timer of 100 Hz comes in bursts otherwise. This is for the whole process, until its end.
    """
    if sys.platform == "win32":
        import ctypes

        ctypes.WinDLL("winmm").timeBeginPeriod(1)
