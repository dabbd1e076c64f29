"""Collisions of the robot's footprint with a costmap, both as they are published."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from robolink.geometry.plane import pose_of
from robolink.interfaces.geometry_msgs.msg import PolygonStamped
from robolink.interfaces.nav2_msgs.msg import Costmap
from robolink.lifecycle import LifecycleNode
from robolink.navigation.footprint import LETHAL, UNKNOWN, cover
from robolink.navigation.grid import Floats, Grid
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.tf2 import Buffer, TransformException
from robolink.time import Time

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
OLDEST = 5.0
"""Age in seconds from which a costmap does not count; Nav2's publish one each second or half a second."""


class CollisionChecker:
    """Subscriptions to a costmap and to a footprint, and what collides by them.

    Args:
        node: Node that subscribes.
        buffer: Transforms, for the footprint, which is published where the robot is.
        base: Frame of the robot.
        costmap: Topic of the costmap.
        footprint: Topic of the footprint.
    """

    def __init__(self, node: LifecycleNode, buffer: Buffer, base: str, costmap: str, footprint: str) -> None:
        self._node, self._buffer, self._base = node, buffer, base
        self._topics = (costmap, footprint)
        self._costmap: Costmap | None = None
        self._footprint: PolygonStamped | None = None
        self._points: Floats | None = None
        self._subscriptions: list[Any] = [
            node.create_subscription(Costmap, costmap, self._take_costmap, LATCHED),
            node.create_subscription(PolygonStamped, footprint, self._take_footprint, 1),
        ]

    def _take_costmap(self, costmap: Costmap) -> None:
        self._costmap = costmap

    def _take_footprint(self, footprint: PolygonStamped) -> None:
        self._footprint = footprint

    def problem(self) -> str:
        """Return why nothing can be said; empty if it can."""
        costmap = self._costmap
        if costmap is None:
            return f"no costmap has come on '{self._topics[0]}'"
        stamp = costmap.header.stamp
        age = self._node.get_clock().now().nanoseconds / 1e9 - (stamp.sec + stamp.nanosec * 1e-9)
        if age > OLDEST:
            return f"the costmap on '{self._topics[0]}' is {age:.1f} s old: does its server still run?"
        if len(costmap.data) != costmap.metadata.size_x * costmap.metadata.size_y or not len(costmap.data):
            return f"the costmap on '{self._topics[0]}' has no cells, or not as many as it says"
        self._look_at_footprint()
        return "" if self._points is not None else f"no footprint has come on '{self._topics[1]}'"

    def _look_at_footprint(self) -> None:
        """Take over a footprint that is new, in the frame of the robot."""
        message, self._footprint = self._footprint, None
        if message is None or len(message.polygon.points) < 3:
            return
        frame, base, stamp = message.header.frame_id, self._base, message.header.stamp
        polygon = np.array([(each.x, each.y) for each in message.polygon.points], np.float64)
        if frame != base:
            found = self._transform(frame, stamp)
            if found is None:
                return
            place = found.transform
            x, y, theta = pose_of(_Placed(place.translation, place.rotation))
            dx, dy = polygon[:, 0] - x, polygon[:, 1] - y
            cos, sin = math.cos(theta), math.sin(theta)
            polygon = np.stack((cos * dx + sin * dy, cos * dy - sin * dx), axis=1)
        if np.isfinite(polygon).all() and self._costmap is not None:
            self._points = cover(polygon, max(self._costmap.metadata.resolution * 2 / 3, 1e-3))

    def _transform(self, frame: str, stamp: Any) -> Any:
        """Return the robot's transform at a stamp, otherwise the latest, otherwise None."""
        for when in (stamp, Time()):
            try:
                return self._buffer.lookup_transform(frame, self._base, when)
            except (TransformException, ValueError):  # a stamp may be negative
                continue
        return None

    def free(self, poses: Floats) -> int:
        """Return how many of some poses, one after the other, are free before one that collides.

        A robot that touches an obstacle already is free where it touches no more of it than now: it could not be freed
        otherwise.

        Args:
            poses: Poses in the costmap's frame, of shape (poses, 3); the first is where the robot is.
        """
        assert self._points is not None
        touched = touches(self._grid(), self._points, poses)
        collides = touched > touched[0]
        return int(collides.argmax()) if collides.any() else len(poses)

    def _grid(self) -> Grid:
        assert self._costmap is not None
        metadata = self._costmap.metadata
        cells = np.asarray(self._costmap.data, np.uint8).reshape(metadata.size_y, metadata.size_x)
        x, y, theta = pose_of(metadata.origin)
        return Grid(cells, metadata.resolution, (x, y, theta))

    def destroy(self) -> None:
        """Withdraw the subscriptions."""
        for each in self._subscriptions:
            self._node.destroy_subscription(each)
        self._subscriptions = []


class _Placed:
    """A transform with the names of a pose."""

    def __init__(self, position: Any, orientation: Any) -> None:
        self.position, self.orientation = position, orientation


def touches(costs: Grid, points: Floats, poses: Floats) -> npt.NDArray[np.int64]:
    """Return how many points of a footprint lie on obstacles, on unknown cells or off the costmap, at each pose.

    Args:
        costs: Costmap, with cells from 0 to 255.
        points: Points of the footprint, as from `footprint.cover`.
        poses: Poses of the robot, of shape (poses, 3).
    """
    cos, sin = np.cos(poses[:, 2])[:, None], np.sin(poses[:, 2])[:, None]
    x = poses[:, 0, None] + cos * points[:, 0] - sin * points[:, 1]
    y = poses[:, 1, None] + sin * points[:, 0] + cos * points[:, 1]
    row, column = costs.world_to_cell(x, y)
    there = costs.contains(row, column)
    height, width = costs.cells.shape
    found = costs.cells[row.clip(0, height - 1), column.clip(0, width - 1)]
    count: npt.NDArray[np.int64] = (~there | (found == LETHAL) | (found == UNKNOWN)).sum(axis=1)
    return count
