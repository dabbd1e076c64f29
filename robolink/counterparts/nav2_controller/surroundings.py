"""Surroundings of the robot for a controller: the local costmap as it is, and the obstacles that move."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS
from robolink.counterparts.nav2_costmap_2d.inputs import planar
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.lifecycle import LifecycleNode
from robolink.navigation.critics import Surroundings
from robolink.navigation.footprint import INSCRIBED, cover
from robolink.navigation.grid import Floats
from robolink.navigation.movers import Mover, Movers
from robolink.qos import QoSProfile, ReliabilityPolicy
from robolink.tf2.exceptions import TransformException
from robolink.time import Time

QOS = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
WAIT_NS = 300_000_000
"""Time that a scan waits for its transform before a newer one takes its place, in nanoseconds."""


class MoverWatch:
    """Subscriptions to scans in which moving obstacles are looked for.

    Args:
        node: Node that subscribes.
        costmap: The local costmap, whose frame and transforms count.
        topics: Topics of scans.
    """

    def __init__(self, node: LifecycleNode, costmap: Costmap2DROS, topics: Iterable[str]) -> None:
        self._node, self._costmap = node, costmap
        self._scans: dict[str, LaserScan] = {}
        self._movers = {topic: Movers() for topic in topics}
        self._subscriptions = [self._subscribed(topic) for topic in self._movers]
        self._angles: tuple[float, float, Floats] = (0.0, 0.0, np.empty(0))

    def _subscribed(self, topic: str) -> Any:
        def take(scan: LaserScan) -> None:
            waiting = self._scans.get(topic)
            if _stamp(scan) < 0:  # no time that a transform could be of
                return
            if waiting is None or abs(_stamp(scan) - _stamp(waiting)) > WAIT_NS:
                self._scans[topic] = scan

        return self._node.create_subscription(LaserScan, topic, take, QOS)

    def movers(self, radius: float) -> list[Mover]:
        """Return the obstacles that move now, with `radius` metres added to the radius of each."""
        for topic in list(self._scans):
            self._look(topic)
        now = self._node.get_clock().now().nanoseconds / 1e9
        found = (each for movers in self._movers.values() for each in movers.now(now))
        return [each._replace(radius=each.radius + radius) for each in found]

    def _look(self, topic: str) -> None:
        """Look at a scan if it is known where it was taken; otherwise it goes on waiting."""
        scan = self._scans[topic]
        buffer, frame = self._costmap.tf_buffer, self._costmap.global_frame
        try:
            found = buffer.lookup_transform_core(frame, scan.header.frame_id, Time.from_msg(scan.header.stamp))
        except TransformException:
            return
        del self._scans[topic]
        ranges = np.asarray(scan.ranges, np.float64)
        sensor = planar(found.transform)
        if not len(ranges) or not all(map(math.isfinite, (*sensor, scan.angle_min, scan.angle_increment))):
            return
        near = np.where((ranges >= scan.range_min) & (ranges <= scan.range_max), ranges, math.inf)
        self._movers[topic].look(near, self._angles_of(scan, len(near)), sensor, _stamp(scan) / 1e9)

    def _angles_of(self, scan: LaserScan, count: int) -> Floats:
        first, step, angles = self._angles
        if (first, step, len(angles)) != (scan.angle_min, scan.angle_increment, count):
            angles = np.arange(count, dtype=np.float64) * scan.angle_increment + scan.angle_min
            self._angles = (scan.angle_min, scan.angle_increment, angles)
        return angles

    def destroy(self) -> None:
        """Withdraw the subscriptions."""
        for each in self._subscriptions:
            self._node.destroy_subscription(each)
        self._subscriptions = []


def _stamp(scan: LaserScan) -> int:
    return scan.header.stamp.sec * 1_000_000_000 + scan.header.stamp.nanosec


class Outline:
    """Points of a costmap's footprint, for controllers: none for a circle, whose centre decides."""

    def __init__(self) -> None:
        self._key: Any = None
        self._points: Floats = np.empty((0, 2))
        self._possible = float(INSCRIBED)

    def around(self, costmap: Costmap2DROS, movers: list[Mover]) -> Surroundings:
        """Return the surroundings of now."""
        if not costmap.uses_radius:
            self._look(costmap)
        points = np.empty((0, 2)) if costmap.uses_radius else self._points
        return Surroundings(costmap.grid, points, self._possible, movers)

    def _look(self, costmap: Costmap2DROS) -> None:
        key = (costmap.footprint.tobytes(), costmap.grid.resolution)
        if key != self._key:
            self._key = key
            self._points = cover(costmap.footprint, costmap.grid.resolution * 2 / 3)
            # Costs fall with the distance, at a rate that depends on the layer: any cost may be near enough.
            self._possible = 1.0
