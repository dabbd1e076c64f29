"""Settings of a player, with the defaults of `ros2 bag play`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from robolink.bag.selection import EVERYTHING, Selection
from robolink.exceptions import RobolinkError
from robolink.qos import QoSProfile

RECEIVED, SENT = "received", "sent"
FASTEST, SLOWEST = 1e6, 1e-6
"""Bounds of the rate."""


class PlayError(RobolinkError, ValueError, RuntimeError):
    """A setting of a player is out of range, or a bag has nothing to play. rosbag2_py has RuntimeErrors."""


class PlaySettings(NamedTuple):
    """Choice of what is played of a bag, when, and how fast; times are in seconds."""

    rate: float = 1.0
    """Seconds of the bag in a second; 2.0 is twice as fast as recorded."""
    loop: bool = False
    """True to begin again at the end, until `stop`."""
    delay: float = 0.0
    """Pause before the first message, of each round of a loop."""
    start_offset: float = 0.0
    """Point of the bag to begin at, from its start."""
    duration: float | None = None
    """Length of what is played; None is all."""
    until: int | None = None
    """Point of the bag to end at, in nanoseconds since 1970; None is its end."""
    start_paused: bool = False
    selection: Selection = EVERYTHING
    qos_overrides: Mapping[str, QoSProfile] = {}
    """Profiles of publishers by topic, instead of those that were recorded."""
    clock_rate: float = 0.0
    """Messages on /clock in a second, 0 for none."""
    clock_topics: frozenset[str] | None = frozenset()
    """Topics before each of whose messages /clock is published; None is all."""
    order: str = RECEIVED
    """Time by which messages are played: `received` or `sent`."""
    read_ahead: int = 1000
    """Number of messages among which those are sorted that are played by the times at which they were sent."""
    service_requests: str = ""
    """Not '' to call services instead of publishing the events of their calls: `service_introspection` for the
    requests that services received, `client_introspection` for those that clients sent."""

    def checked(self) -> PlaySettings:
        """Return them. Raises PlayError for what is out of range, SelectionError for an expression that is none."""
        check_rate(self.rate)
        seconds = {
            "delay": self.delay,
            "start offset": self.start_offset,
            "duration": self.duration,
            "clock rate": self.clock_rate,
        }
        for name, value in seconds.items():
            if value is not None and not (math.isfinite(value) and 0 <= value <= 1e9):
                raise PlayError(f"{name}: expected 0 to 1e9, got {value:g}")
        if self.order not in (RECEIVED, SENT):
            raise PlayError(f"message order: expected {RECEIVED} or {SENT}, got '{self.order}'")
        self.selection.checked()
        return self

    @property
    def publishes_clock(self) -> bool:
        """True if the player publishes /clock."""
        return self.clock_rate > 0 or self.clock_topics is None or bool(self.clock_topics)


def check_rate(rate: float) -> None:
    """Raise PlayError for a rate that is not above 0, or out of every range."""
    if not SLOWEST <= rate <= FASTEST:
        raise PlayError(f"rate: expected {SLOWEST:g} to {FASTEST:g}, got {rate:g}")
