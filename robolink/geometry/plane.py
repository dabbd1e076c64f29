"""Planar geometry: poses (x, y, heading), their composition, bounding boxes and angles."""

from __future__ import annotations

import math
from typing import NamedTuple, Protocol


class Pose(NamedTuple):
    """Pose in the plane: `x` and `y` in metres, and the heading `theta` in radians, 0 along x, growing to the left."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


class Area(NamedTuple):
    """Axis-aligned bounding box in metres: from `x_min` to `x_max`, and from `y_min` to `y_max`."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @property
    def width(self) -> float:
        """Size along x, in metres."""
        return self.x_max - self.x_min

    @property
    def height(self) -> float:
        """Size along y, in metres."""
        return self.y_max - self.y_min

    def grown(self, x: float, y: float) -> Area:
        """Return the smallest box that holds this one and the point `x`, `y` (metres)."""
        if self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max:
            return self
        return Area(min(self.x_min, x), min(self.y_min, y), max(self.x_max, x), max(self.y_max, y))


class Speeds(NamedTuple):
    """Speeds: `v` ahead in m/s, and `w` of turning in rad/s, to the left if positive."""

    v: float = 0.0
    w: float = 0.0


class _Point(Protocol):
    @property
    def x(self) -> float: ...

    @property
    def y(self) -> float: ...


class _Quaternion(_Point, Protocol):
    @property
    def z(self) -> float: ...

    @property
    def w(self) -> float: ...


class PoseMessage(Protocol):
    """The fields of a geometry_msgs/msg/Pose that `pose_of` reads."""

    @property
    def position(self) -> _Point:
        """The position in metres."""

    @property
    def orientation(self) -> _Quaternion:
        """The orientation as a quaternion."""


def pose_of(message: PoseMessage) -> Pose:
    """Return the pose in the plane of `message`, a geometry_msgs/msg/Pose; its quaternion need not have length 1.

    What is not finite in the message is not finite in the pose: the heading is NaN then.
    """
    place, q = message.position, message.orientation
    largest = max(map(abs, (q.x, q.y, q.z, q.w))) or 1.0
    x, y, z, w = q.x / largest, q.y / largest, q.z / largest, q.w / largest  # their squares neither overflow nor vanish
    return Pose(place.x, place.y, math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z))


def is_finite(pose: Pose) -> bool:
    """Return True if a robot can be at a `pose`: none of its numbers is NaN or infinite."""
    return all(map(math.isfinite, pose))


def placed_on(base: Pose, pose: Pose) -> Pose:
    """Return the composition of two poses: `pose`, which is relative to `base`, in the frame that `base` is in.

    The headings are added and not wrapped.
    """
    cos, sin = math.cos(base.theta), math.sin(base.theta)
    x, y = base.x + cos * pose.x - sin * pose.y, base.y + sin * pose.x + cos * pose.y
    return Pose(x, y, base.theta + pose.theta)


def seen_from(base: Pose, pose: Pose) -> Pose:
    """Return `pose` relative to `base`: metres ahead of it and to its left, and the turn in [-pi, pi]."""
    dx, dy = pose.x - base.x, pose.y - base.y
    cos, sin = math.cos(base.theta), math.sin(base.theta)
    return Pose(cos * dx + sin * dy, cos * dy - sin * dx, wrapped(pose.theta - base.theta))


def wrapped(angle: float) -> float:
    """Return `angle` in radians brought into [-pi, pi]."""
    return math.remainder(angle, math.tau)


def clipped(value: float, most: float) -> float:
    """Return `value` clipped to at most `most` in size, with its sign."""
    return min(most, max(-most, value))
