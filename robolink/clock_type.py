"""The kinds of clock that a time can belong to."""

from __future__ import annotations

from enum import IntEnum


class ClockType(IntEnum):
    """Where a clock takes its time from; the numbers are rcl's."""

    UNINITIALIZED = 0
    ROS_TIME = 1
    """Follows `/clock` under `use_sim_time`, the system clock otherwise."""
    SYSTEM_TIME = 2
    """The wall clock: since 1970, may be set back."""
    STEADY_TIME = 3
    """Never goes back; its zero means nothing."""
