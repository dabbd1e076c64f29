"""Obstacles that move: small things that stand free in a laser scan are followed from scan to scan."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from robolink.geometry.plane import Pose
from robolink.navigation.grid import Floats

LARGEST = 0.9
"""Largest width of what may be a person or another robot, in metres."""
FARTHEST = 4.0
"""Largest distance from the sensor in metres at which movers are looked for."""
_JUMP, _JUMP_SHARE = 0.12, 0.03
"""Least distance in metres of neighbouring points of two things, and what each metre of range adds to it."""
_FREE = 0.15
"""Metres by which the beams beside a thing must go farther, so that it is not the visible part of something else."""
_GATE = 0.35
"""Metres within which a thing is looked for where it should be by now."""
_LOST = 0.5
"""Seconds after which a thing that is not seen is forgotten."""
_GAIN, _SPEED_GAIN = 0.5, 0.25
"""Gains of the filter (alpha-beta) for the place and for the speed."""
_SEEN, _WAY, _SLOWEST = 4, 0.12, 0.12
"""Looks at a thing, metres that it has moved, and its speed in m/s, from which on it counts as moving."""


class Mover(NamedTuple):
    """A moving obstacle: its centre in metres, its velocity in m/s, both in a fixed frame, and its radius in metres."""

    x: float
    y: float
    vx: float
    vy: float
    radius: float

    def later(self, seconds: float) -> Mover:
        """Return it as it will be if it goes on."""
        return self._replace(x=self.x + self.vx * seconds, y=self.y + self.vy * seconds)


@dataclass
class _Track:
    """A thing that is followed: where it was first, where it is, how fast, and when and how often it was seen."""

    first: tuple[float, float]
    x: float
    y: float
    radius: float
    time: float
    vx: float = 0.0
    vy: float = 0.0
    seen: int = 1
    at: float = 0.0

    @property
    def moves(self) -> bool:
        way = math.hypot(self.x - self.first[0], self.y - self.first[1])
        return self.seen >= _SEEN and way > _WAY and math.hypot(self.vx, self.vy) > _SLOWEST

    def see(self, x: float, y: float, radius: float, time: float) -> None:
        """Correct it by what was seen at a time."""
        dt = max(time - self.at, 1e-3)
        px, py = self.x + self.vx * dt, self.y + self.vy * dt
        ex, ey = x - px, y - py
        self.x, self.y = px + _GAIN * ex, py + _GAIN * ey
        gain = 1.0 / (self.seen + 1) if self.seen < 3 else _SPEED_GAIN
        self.vx, self.vy = self.vx + gain * ex / dt, self.vy + gain * ey / dt
        self.radius += 0.3 * (radius - self.radius)
        self.time, self.at, self.seen = time, time, self.seen + 1


class Movers:
    """Moving obstacles around a robot, by its scans. Times in seconds, places in one fixed frame such as odom."""

    def __init__(self) -> None:
        self._tracks: list[_Track] = []
        self._time = -math.inf

    def look(self, ranges: Floats, angles: Floats, sensor: Pose, time: float) -> None:
        """Take in a scan.

        Args:
            ranges: Metres, one for each beam; a value that is not finite or not positive stands for none.
            angles: Angles of the beams in radians, rising.
            sensor: Pose of the scanner when it measured.
            time: When that was; if time has gone back, all is forgotten.
        """
        if time < self._time:
            self._tracks.clear()
        self._time = time
        things = list(_things(ranges, angles, sensor))
        for track in list(self._tracks):
            dt = time - track.at
            x, y = track.x + track.vx * dt, track.y + track.vy * dt
            near = min(things, key=lambda each: math.hypot(each[0] - x, each[1] - y), default=None)
            if near is not None and math.hypot(near[0] - x, near[1] - y) < _GATE:
                things.remove(near)
                track.see(*near, time)
            elif time - track.time > _LOST:
                self._tracks.remove(track)
        self._tracks += [_Track((x, y), x, y, radius, time, at=time) for x, y, radius in things]

    def now(self, time: float) -> list[Mover]:
        """Return the moving obstacles, each where it should be by now; none if the last scan is too old."""
        if time - self._time > _LOST:
            return []
        moving = (each for each in self._tracks if each.moves)
        return [Mover(each.x, each.y, each.vx, each.vy, each.radius).later(time - each.at) for each in moving]


def _things(ranges: Floats, angles: Floats, sensor: Pose) -> Iterator[tuple[float, float, float]]:
    """Yield centre and radius of each small thing that stands free, in the frame of `sensor`'s pose."""
    is_hit = np.isfinite(ranges) & (ranges > 0.0)
    far = np.where(is_hit, ranges, np.inf)
    r = np.where(is_hit, ranges, 0.0)
    x = sensor.x + r * np.cos(angles + sensor.theta)
    y = sensor.y + r * np.sin(angles + sensor.theta)
    # A full turn is closed: the last beam is beside the first.
    joined = np.hypot(x - np.roll(x, 1), y - np.roll(y, 1)) < _JUMP + _JUMP_SHARE * r
    joined &= is_hit & np.roll(is_hit, 1)
    starts = np.flatnonzero(~joined)
    for start, end in zip(starts, np.roll(starts, -1), strict=True):
        last = (end - 1) % len(r)
        count = (last - start) % len(r) + 1
        if count < 3 or not is_hit[start] or r[start] > FARTHEST:
            continue
        width = math.hypot(x[last] - x[start], y[last] - y[start])
        before, after = far[start - 1], far[(last + 1) % len(r)]
        if width < LARGEST and before > r[start] + _FREE and after > r[last] + _FREE:
            yield float(x[start] + x[last]) / 2, float(y[start] + y[last]) / 2, max(width / 2, 0.05)
