"""The computer's clocks, as fine as it has them: those that Python shows on Windows go in steps of 15.6 ms."""

from __future__ import annotations

import functools
import sys
import time
from collections.abc import Callable

_UNIX_BEGINS = 11_644_473_600 * 10**7
"""Tenths of a microsecond after the beginning of Windows' time, the year 1601."""


def _finest_now() -> Callable[[], int]:
    if sys.platform == "win32" and sys.version_info < (3, 13):  # from then on Python asks the same
        import ctypes

        ask = ctypes.WinDLL("kernel32").GetSystemTimePreciseAsFileTime
        ask.restype = None

        def precise_now() -> int:
            told = ctypes.c_uint64()
            ask(ctypes.byref(told))
            return (told.value - _UNIX_BEGINS) * 100

        return precise_now
    return time.time_ns


now = _finest_now()
"""Give the time of day: nanoseconds since the UNIX epoch."""

steady = time.perf_counter_ns if sys.platform == "win32" else time.monotonic_ns
"""Give nanoseconds that only grow, from some start."""


@functools.cache
def make_waits_exact() -> None:
    """Have waits end within a millisecond of their time: Windows looks at them 64 times a second, unless it is asked.

    A timer of 100 Hz comes in bursts otherwise. This is for the whole process, until its end.
    """
    if sys.platform == "win32":
        import ctypes

        ctypes.WinDLL("winmm").timeBeginPeriod(1)
