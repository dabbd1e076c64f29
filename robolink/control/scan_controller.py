"""Base class of nodes that drive a robot by its laser scanner: publishes commands, with a watchdog that stops it."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.control.laser import seconds_between
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.node import Node
from robolink.parameters.descriptors import described

FIRST_SCAN = 5.0
"""Longest wait for the first scan before a warning, in seconds: the robot is often started beside its driver."""


class ScanController(Node):
    """Node that turns each scan into a velocity command; stops the robot when scans fail to come, and at its own end.

    A subclass implements `decide`. The topics are `scan` and `cmd_vel`. The parameter `timeout` is the time without a
    scan, in seconds, after which the robot stops until the next one. If none has come at all, a warning says so after
    `FIRST_SCAN` seconds.

    Args:
        node_name: Name of the node.
        **options: Further arguments of `Node`.
    """

    is_driving = False
    """True if the last command may let the robot move."""

    def __init__(self, node_name: str, **options: Any) -> None:
        super().__init__(node_name, **options)
        words = "seconds without a scan after which the robot stops"
        timeout = self.declare_parameter("timeout", 0.5, described(words, 0.05, 60.0)).value
        self.last_scan: LaserScan | None = None
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.watchdog = self.create_timer(max(timeout, FIRST_SCAN), self.on_silence)

    def decide(self, scan: LaserScan, seconds: float) -> tuple[Twist, str]:
        """Return the next command for `scan`, and the reason in words; `seconds` since the last one, 0 if unknown."""
        raise NotImplementedError

    def forget(self) -> None:
        """Forget earlier scans, since none has come for too long; a subclass that remembers more overrides this."""
        self.last_scan = None

    def on_scan(self, scan: LaserScan) -> None:
        """Call `decide` for `scan`, publish its command and wind up the watchdog."""
        twist, words = self.decide(scan, seconds_between(self.last_scan, scan))
        self.last_scan, self.is_driving = scan, True
        self.cmd_vel.publish(twist)
        self.get_logger().info(words, throttle_duration_sec=2.0)
        self.watchdog.timer_period_ns = int(self.get_parameter("timeout").value * 1e9)
        self.watchdog.reset()

    def on_silence(self) -> None:
        """Stop, and warn once; the next scan winds the watchdog up again."""
        self.watchdog.cancel()
        self.forget()
        self.stop()
        seconds, topic = self.watchdog.timer_period_ns / 1e9, self.resolve_topic_name("scan")
        self.get_logger().warning(f"no scan on {topic} for {seconds:g} s: the robot stands until one comes")

    def stop(self) -> None:
        """Stop the robot, if it was driving."""
        if self.is_driving:
            self.is_driving = False
            self.cmd_vel.publish(Twist())

    def destroy_node(self) -> None:
        """Stop the robot if the context still runs, then destroy the node."""
        with contextlib.suppress(RobolinkError):
            self.stop()
        super().destroy_node()
