"""What nodes share that drive a robot by its laser scanner: they decide, this drives, watches and stops."""

from __future__ import annotations

import contextlib
from typing import Any

from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.laser import seconds_between
from robolink.node import Node
from robolink.parameter_descriptors import described

FIRST_SCAN = 5.0
"""Seconds that the first scan may take without a word: the robot, which stands, is often started beside its driver."""


class ScanController(Node):
    """Turns each scan into a velocity command; stops the robot when there are no scans, and at its own end.

    A subclass says in `decide` what to do. The topics are `scan` and `cmd_vel`; the parameter `timeout` holds the
    seconds without a scan after which the robot stops until the next one. That none has come at all is told after
    `FIRST_SCAN` seconds.
    """

    is_driving = False
    """Whether the last command may have the robot move."""

    def __init__(self, node_name: str, **options: Any) -> None:
        super().__init__(node_name, **options)
        words = "seconds without a scan after which the robot stops"
        timeout = self.declare_parameter("timeout", 0.5, described(words, 0.05, 60.0)).value
        self.last_scan: LaserScan | None = None
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)
        self.watchdog = self.create_timer(max(timeout, FIRST_SCAN), self.on_silence)

    def decide(self, scan: LaserScan, seconds: float) -> tuple[Twist, str]:
        """Give the next command, and why in words; `seconds` after the last scan, 0 where that cannot be told."""
        raise NotImplementedError

    def forget(self) -> None:
        """Forget earlier scans, since none has come for too long; a subclass adds what it remembers of them."""
        self.last_scan = None

    def on_scan(self, scan: LaserScan) -> None:
        """Decide and act."""
        twist, words = self.decide(scan, seconds_between(self.last_scan, scan))
        self.last_scan, self.is_driving = scan, True
        self.cmd_vel.publish(twist)
        self.get_logger().info(words, throttle_duration_sec=2.0)
        self.watchdog.timer_period_ns = int(self.get_parameter("timeout").value * 1e9)
        self.watchdog.reset()

    def on_silence(self) -> None:
        """Stop, and say why, once: the next scan winds the watchdog up again."""
        self.watchdog.cancel()
        self.forget()
        self.stop()
        seconds, topic = self.watchdog.timer_period_ns / 1e9, self.resolve_topic_name("scan")
        self.get_logger().warning(f"no scan on {topic} for {seconds:g} s: the robot stands until one comes")

    def stop(self) -> None:
        """Leave the robot standing, if it was driving."""
        if self.is_driving:
            self.is_driving = False
            self.cmd_vel.publish(Twist())

    def destroy_node(self) -> None:
        """Stop the robot, as long as somebody can be told."""
        with contextlib.suppress(RobolinkError):
            self.stop()
        super().destroy_node()
