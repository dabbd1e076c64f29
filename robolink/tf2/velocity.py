"""Mean velocity of a frame in another one, from two look-ups around a time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

from robolink.constants import S_TO_NS
from robolink.tf2.exceptions import InvalidArgumentException
from robolink.tf2.rigid import Rigid, compose, inverse, signed

Vector: TypeAlias = tuple[float, float, float]
Velocity: TypeAlias = tuple[Vector, Vector]
"""Linear velocity in m/s, then angular velocity in rad/s about the same axes."""

EARLIEST = 10_000
"""Earliest time of a look-up in ns: zero would mean the latest."""

Lookup = Callable[[str, str, int], Rigid]


def velocity_of(lookup: Lookup, frames: Sequence[str], point: Sequence[float], spans: tuple[int, int, int]) -> Velocity:
    """Return a mean velocity. `frames`: which moves, in which, along whose axes, and in which `point` is given.

    `spans` are a time, the interval around it, and the latest time that is known, in ns. Raises
    InvalidArgumentException if no time lies between the two look-ups, and what a look-up raises.
    """
    tracking, observation, reference, point_frame = frames
    time, interval, latest = spans
    end = min(time + interval // 2, latest)
    start = max(EARLIEST + interval, end) - interval
    if end <= start:
        raise InvalidArgumentException(
            f"no velocity of '{tracking}' in '{observation}': the interval of {interval / 1e9:g} s around"
            f" {time / 1e9:.6f} holds no two known times"
        )
    before, after = lookup(observation, tracking, start), lookup(observation, tracking, end)
    seconds = (end - start) / S_TO_NS
    linear = _vector([(b - a) / seconds for a, b in zip(before[:3], after[:3], strict=True)])
    angular = _turned(before, _rotation_vector(compose(inverse(before), after), seconds))
    axes = lookup(reference, observation, time) if reference != observation else None
    if axes is not None:
        linear, angular = _turned(axes, linear), _turned(axes, angular)
    origin = lookup(reference, tracking, time)[:3]
    expected = compose(lookup(reference, point_frame, time), (*_vector(point), 0.0, 0.0, 0.0, 1.0))[:3]
    arm = _vector([w - o for w, o in zip(expected, origin, strict=True)])
    return _vector([v + c for v, c in zip(linear, _cross(angular, arm), strict=True)]), angular


def _vector(numbers: Sequence[float]) -> Vector:
    x, y, z = map(float, numbers)
    return x, y, z


def _turned(by: Rigid, vector: Vector) -> Vector:
    return compose((0.0, 0.0, 0.0, *by[3:]), (*vector, 0.0, 0.0, 0.0, 1.0))[:3]


def _rotation_vector(turn: Rigid, seconds: float) -> Vector:
    x, y, z, w = signed(turn)[3:]
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    sine = math.sqrt(x * x + y * y + z * z)
    if sine == 0.0:
        return 0.0, 0.0, 0.0
    scale = 2.0 * math.atan2(sine, w) / sine / seconds
    return x * scale, y * scale, z * scale


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
