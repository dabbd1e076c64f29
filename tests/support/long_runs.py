"""Long-running robot systems (a minute or two), started before other tests and checked after them."""

from __future__ import annotations

import sys
from contextlib import ExitStack
from typing import NamedTuple

from tests.support.commands import PATIENCE, Command
from tests.support.domains import free_domain

WITNESS = """
import robolink as rclpy
from robolink.interfaces.nav_msgs.msg import Odometry

def on_odom(odom):
    stamp, place = odom.header.stamp, odom.pose.pose.position
    print(stamp.sec + stamp.nanosec * 1e-9, place.x, place.y, odom.twist.twist.linear.x)

rclpy.init()
node = rclpy.create_node("witness")
node.create_subscription(Odometry, "/odom", on_odom, 1000)
print("listening")
rclpy.spin(node)
"""
"""A process of its own, so that what the tests do meanwhile does not reach it."""


class Sample(NamedTuple):
    """What /odom says: seconds since the epoch, metres, m/s."""

    time: float
    x: float
    y: float
    speed: float


class LongRun:
    """A system that `robolink launch NAME --duration SECONDS` runs, and what its /odom says meanwhile."""

    def __init__(self, name: str, seconds: int) -> None:
        self.seconds = seconds
        self._stack = ExitStack()
        self.domain = self._stack.enter_context(free_domain())
        self._witness = self._stack.enter_context(Command(self.domain, program=(sys.executable, "-c", WITNESS)))
        self.launch = self._stack.enter_context(Command(self.domain, "launch", name, "--duration", str(seconds)))

    def end(self) -> int:
        """Wait for its orderly end; its exit code. From then on the domain is silent."""
        code = self.launch.end(self.seconds + 2 * PATIENCE)
        self._witness.kill()
        self._witness.end()
        return code

    def samples(self) -> list[Sample]:
        """What has been heard."""
        return [Sample(*map(float, line.text.split())) for line in self._witness.lines[1:]]

    def close(self) -> None:
        """End it, whether it has come to its end or not."""
        self._stack.close()
