"""Poses in the plane: where a robot is and how it is turned, where that is as seen from elsewhere, and boxes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage


class Pose(NamedTuple):
    """A place in metres and a heading in radians, 0 along x and growing to the left."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


class Area(NamedTuple):
    """A box along the axes, in metres."""

    x_min: float
    y_min: float
    x_max: float
    y_max: float

    @property
    def width(self) -> float:
        """Metres along x."""
        return self.x_max - self.x_min

    @property
    def height(self) -> float:
        """Metres along y."""
        return self.y_max - self.y_min

    def grown(self, x: float, y: float) -> Area:
        """Return the smallest box that holds this one and a point."""
        if self.x_min <= x <= self.x_max and self.y_min <= y <= self.y_max:
            return self
        return Area(min(self.x_min, x), min(self.y_min, y), max(self.x_max, x), max(self.y_max, y))


class Speeds(NamedTuple):
    """The speed ahead in m/s, and the turning speed in rad/s, to the left if positive."""

    v: float = 0.0
    w: float = 0.0


def pose_of(message: PoseMessage) -> Pose:
    """Read a geometry_msgs/msg/Pose as one in the plane; a quaternion of any length but 0 will do."""
    place, q = message.position, message.orientation
    theta = math.atan2(2.0 * (q.w * q.z + q.x * q.y), q.w**2 + q.x**2 - q.y**2 - q.z**2)
    return Pose(place.x, place.y, theta)


def placed_on(base: Pose, pose: Pose) -> Pose:
    """Give where something is that stands at `pose` on what is at `base`; the headings are added as they are."""
    cos, sin = math.cos(base.theta), math.sin(base.theta)
    x, y = base.x + cos * pose.x - sin * pose.y, base.y + sin * pose.x + cos * pose.y
    return Pose(x, y, base.theta + pose.theta)


def seen_from(base: Pose, pose: Pose) -> Pose:
    """Give a pose as seen from `base`: metres ahead of it and to its left, and the turn in [-pi, pi]."""
    dx, dy = pose.x - base.x, pose.y - base.y
    cos, sin = math.cos(base.theta), math.sin(base.theta)
    return Pose(cos * dx + sin * dy, cos * dy - sin * dx, wrapped(pose.theta - base.theta))


def wrapped(angle: float) -> float:
    """Bring an angle into [-pi, pi]."""
    return math.remainder(angle, math.tau)


def clipped(value: float, most: float) -> float:
    """Bring a value into [-most, most]."""
    return min(most, max(-most, value))
