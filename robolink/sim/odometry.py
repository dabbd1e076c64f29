"""Dead reckoning along exact arcs."""

from __future__ import annotations

import math


class Odometry:
    """Where a robot believes to be, from its own speeds alone: metres, and radians that keep counting."""

    __slots__ = ("theta", "x", "y")

    def __init__(self, x: float = 0.0, y: float = 0.0, theta: float = 0.0) -> None:
        self.x, self.y, self.theta = x, y, theta

    def advance(self, v: float, w: float, dt: float) -> None:
        """Move on by an arc of `dt` seconds with forward speed `v` and turning speed `w`."""
        middle = self.theta + w * dt / 2
        chord = v * dt * sinc(w * dt / 2)
        self.x += chord * math.cos(middle)
        self.y += chord * math.sin(middle)
        self.theta += w * dt


def sinc(x: float) -> float:
    """Give sin(x) / x: the chord of an arc that turns by 2x, as a share of the arc."""
    return math.sin(x) / x if abs(x) > 1e-4 else 1.0 - x * x / 6.0


def wrapped(angle: float) -> float:
    """Bring an angle into [-pi, pi]."""
    return math.remainder(angle, math.tau)
