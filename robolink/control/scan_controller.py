"""Base class of nodes that drive a robot by its laser scanner, scan by scan."""

from __future__ import annotations

from typing import Any

from robolink.control.laser import seconds_between
from robolink.control.sensor_controller import SensorController
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan


class ScanController(SensorController):
    """Node that turns each scan into a velocity command; stops the robot when scans fail to come, and at its own end.

    A subclass implements `decide`. The topics are `scan` and `cmd_vel`. The parameter `timeout` is the time without a
    scan, in seconds, after which the robot stops until the next one. If none has come at all, a warning says so after
    five seconds.

    Args:
        node_name: Name of the node.
        **options: Further arguments of `Node`.
    """

    def __init__(self, node_name: str, **options: Any) -> None:
        super().__init__(node_name, noun="scan", topic="scan", timeout=0.5, **options)
        self.last_scan: LaserScan | None = None
        self.create_subscription(LaserScan, "scan", self.on_scan, 10)

    def decide(self, scan: LaserScan, seconds: float) -> tuple[Twist, str]:
        """Return the next command for `scan`, and the reason in words; `seconds` since the last one, 0 if unknown."""
        raise NotImplementedError

    def forget(self) -> None:
        """Forget earlier scans, since none has come for too long; a subclass that remembers more overrides this."""
        self.last_scan = None

    def on_scan(self, scan: LaserScan) -> None:
        """Call `decide` for `scan`, and publish its command."""
        twist, words = self.decide(scan, seconds_between(self.last_scan, scan))
        self.last_scan = scan
        self.command(twist, words)
