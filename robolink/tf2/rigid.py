"""Arithmetic of rigid transforms as seven floats, for the few at a time that a look-up needs.

A chain of ten costs less than half of what numpy takes, which is made for many at once (`benchmarks/tf2.py`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

from robolink.constants import S_TO_NS
from robolink.tf2.exceptions import InvalidArgumentException

Rigid: TypeAlias = tuple[float, float, float, float, float, float, float]
"""Position x, y, z in m, then the rotation as a unit quaternion x, y, z, w."""

IDENTITY: Rigid = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""The transform that changes nothing."""

UNIT = 1e-12
"""Tolerance of a quaternion's squared norm, within which it is not scaled."""

NEARLY_EQUAL = 1.0 - 1e-9
"""Cosine of half an angle, above which two rotations are interpolated on a line instead of the arc."""


def compose(outer: Rigid, inner: Rigid) -> Rigid:
    """Return the transform that applies `inner` first and `outer` then."""
    ox, oy, oz, x, y, z, w = outer
    ix, iy, iz, a, b, c, d = inner
    # v + 2 w (q x v) + 2 q x (q x v), with t = 2 (q x v)
    tx, ty, tz = 2.0 * (y * iz - z * iy), 2.0 * (z * ix - x * iz), 2.0 * (x * iy - y * ix)
    return (
        ox + ix + w * tx + y * tz - z * ty,
        oy + iy + w * ty + z * tx - x * tz,
        oz + iz + w * tz + x * ty - y * tx,
        w * a + x * d + y * c - z * b,
        w * b - x * c + y * d + z * a,
        w * c + x * b - y * a + z * d,
        w * d - x * a - y * b - z * c,
    )


def inverse(given: Rigid) -> Rigid:
    """Return the inverse of a transform."""
    px, py, pz, x, y, z, w = given
    tx, ty, tz = 2.0 * (z * py - y * pz), 2.0 * (x * pz - z * px), 2.0 * (y * px - x * py)
    return (
        -(px + w * tx - y * tz + z * ty),
        -(py + w * ty - z * tx + x * tz),
        -(pz + w * tz - x * ty + y * tx),
        -x,
        -y,
        -z,
        w,
    )


def between(one: Rigid, other: Rigid, ratio: float) -> Rigid:
    """Interpolate from `one` (ratio 0) to `other` (ratio 1): linear in position, spherical (slerp) in rotation."""
    rest = 1.0 - ratio
    ax, ay, az, a, b, c, d = one
    bx, by, bz, e, f, g, h = other
    x, y, z = rest * ax + ratio * bx, rest * ay + ratio * by, rest * az + ratio * bz
    dot = a * e + b * f + c * g + d * h
    cosine = abs(dot)
    if cosine < NEARLY_EQUAL:
        half = math.acos(cosine)
        sine = math.sin(half)
        rest, ratio = math.sin(rest * half) / sine, math.sin(ratio * half) / sine
    if dot < 0.0:  # q and -q are one rotation: go the short way round
        ratio = -ratio
    return unit((x, y, z, rest * a + ratio * e, rest * b + ratio * f, rest * c + ratio * g, rest * d + ratio * h))


def unit(given: Rigid) -> Rigid:
    """Return a transform with its quaternion scaled to length 1 where it is off."""
    px, py, pz, x, y, z, w = given
    square = x * x + y * y + z * z + w * w
    if abs(square - 1.0) <= UNIT:
        return given
    scale = 1.0 / math.sqrt(square)
    return (px, py, pz, x * scale, y * scale, z * scale, w * scale)


def signed(given: Rigid) -> Rigid:
    """Return q or -q as tf2 does: w is positive where it is beyond a half, else the largest of x, y, z is."""
    px, py, pz, x, y, z, w = given
    leading = w if w * w > 0.25 else max((x, y, z), key=abs)
    return given if leading >= 0.0 else (px, py, pz, -x, -y, -z, -w)


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
