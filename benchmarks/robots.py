"""Load of many robots for benchmarks: what they publish, without a simulator that would cost more than it.

Each has a scan of 360 beams at 10 Hz and odometry at 50 Hz; one message on /tf has all transforms, at 50 Hz. 100 robots
have 203 topics with 6,050 messages a second.
"""

from __future__ import annotations

import math
import struct
import time

from robolink import Node
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message import encode

RATE = 50
BEAMS = 360
SCAN_EVERY = 5
"""Steps from one scan of a robot to the next."""
STAMP = struct.Struct("<iI")


class Fleet:
    """Robots that drive in circles, side by side.

    Args:
        node: Node that publishes for all.
        robots: Number of robots.
        staggered: True lets the robots scan at different steps, as if they had been started one after the other.
    """

    def __init__(self, node: Node, robots: int, *, staggered: bool = False) -> None:
        side = math.ceil(math.sqrt(robots))
        self._robots = [Robot(node, number, side) for number in range(robots)]
        self._transforms = node.create_publisher(TFMessage, "/tf", 100)
        self._staggered = staggered
        self._step = 0

    @property
    def is_heard(self) -> bool:
        """True once somebody subscribes to each topic."""
        own = (end.get_subscription_count() for each in self._robots for end in (each.scans, each.odometries))
        return all(own) and self._transforms.get_subscription_count() > 0

    def publish(self) -> int:
        """Publish what is due at the next step; return the number of messages."""
        now, step = divmod(time.time_ns(), 10**9), self._step
        count = 1
        for each in self._robots:
            scans = (step + (each.number if self._staggered else 0)) % SCAN_EVERY == 0
            each.publish(step, now, scans=scans)
            count += 1 + scans
        self._transforms.publish(TFMessage(transforms=[each.transform for each in self._robots]))
        self._step += 1
        return count


class Robot:
    """A robot that drives in a circle; its scan is encoded once, and only its stamp is new."""

    def __init__(self, node: Node, number: int, side: int) -> None:
        self.number, self._x, self._y = number, 5.0 * (number % side), 5.0 * (number // side)
        turn = math.tau / BEAMS
        scan = LaserScan(angle_min=-math.pi, angle_max=math.pi - turn, angle_increment=turn, range_min=0.12)
        scan.range_max = 12.0
        scan.ranges = [2.0 + 1.2 * math.sin(3 * beam * turn + number) for beam in range(BEAMS)]
        scan.header.frame_id = f"r{number}/base_link"
        self._scan, self._odometry = bytearray(encode(scan)), Odometry(child_frame_id=scan.header.frame_id)
        self._odometry.header.frame_id = "map"
        self.transform = TransformStamped(header=self._odometry.header, child_frame_id=scan.header.frame_id)
        self.scans = node.create_publisher(LaserScan, f"/r{number}/scan", 10)
        self.odometries = node.create_publisher(Odometry, f"/r{number}/odom", 10)

    def publish(self, step: int, now: tuple[int, int], *, scans: bool) -> None:
        """Publish odometry and, if it `scans`, a scan, at a time in seconds and nanoseconds."""
        if scans:
            STAMP.pack_into(self._scan, 4, *now)
            self.scans.publish(bytes(self._scan))
        self._odometry.header.stamp.sec, self._odometry.header.stamp.nanosec = now
        angle = 0.02 * step + self.number
        pose, there = self._odometry.pose.pose, self.transform.transform
        pose.position.x = there.translation.x = self._x + math.cos(angle)
        pose.position.y = there.translation.y = self._y + math.sin(angle)
        pose.orientation.z = there.rotation.z = math.sin(angle / 2)
        pose.orientation.w = there.rotation.w = math.cos(angle / 2)
        self.odometries.publish(self._odometry)
