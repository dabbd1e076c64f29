"""Base class of nodes that drive a robot by one sensor: publishes commands, with a watchdog that stops it."""

from __future__ import annotations

import contextlib
import math
from typing import Any

from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.node import Node
from robolink.parameters.descriptors import described
from robolink.system.terminal import with_article

FIRST_MESSAGE = 5.0
"""Longest wait for the first message before a warning, in seconds: the robot is often started beside its driver."""


class SensorController(Node):
    """Node that commands velocities; stops the robot when its sensor falls silent, and at its own end.

    A subclass subscribes to the sensor and calls `command` for each message. The parameter `timeout` is the time
    without one, in seconds, after which the robot stops until the next. If none has come at all, a warning says so
    after `FIRST_MESSAGE` seconds.

    Args:
        node_name: Name of the node.
        noun: What the sensor sends, for the log: "scan".
        topic: Name of the sensor's topic.
        timeout: Default of the parameter, in seconds.
        **options: Further arguments of `Node`.
    """

    is_driving = False
    """True if the last command may let the robot move."""

    def __init__(self, node_name: str, *, noun: str, topic: str, timeout: float, **options: Any) -> None:
        super().__init__(node_name, **options)
        self.noun, self.topic = noun, self.resolve_topic_name(topic)
        words = f"seconds without {with_article(noun)} after which the robot stops"
        seconds = self.declare_parameter("timeout", timeout, described(words, 0.05, 60.0)).value
        self.cmd_vel = self.create_publisher(Twist, "cmd_vel", 10)
        self.watchdog = self.create_timer(max(seconds, FIRST_MESSAGE), self.on_silence)

    def forget(self) -> None:
        """Forget earlier messages, since none has come for too long; a subclass that remembers some overrides this."""

    def command(self, twist: Twist, words: str) -> None:
        """Publish a command, log its reason at most every two seconds, and wind up the watchdog.

        A command with NaN or infinity, as sensors with such values lead to, stops the robot instead, with a warning.

        Args:
            twist: The command.
            words: The reason, for people.
        """
        speeds = (twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z)
        if not all(map(math.isfinite, speeds)):
            self.get_logger().warning(f"{self.topic} leads to no finite speeds: the robot stands", once=True)
            self.stop()
            self.wind_up()
            return
        self.is_driving = True
        self.cmd_vel.publish(twist)
        self.get_logger().info(words, throttle_duration_sec=2.0)
        self.wind_up()

    def wind_up(self) -> None:
        """Note that the sensor has sent a message: `timeout` begins again."""
        self.watchdog.timer_period_ns = int(self.get_parameter("timeout").value * 1e9)
        self.watchdog.reset()

    def on_silence(self) -> None:
        """Stop, and warn once; the next message winds the watchdog up again."""
        self.watchdog.cancel()
        self.forget()
        self.stop()
        seconds = self.watchdog.timer_period_ns / 1e9
        self.get_logger().warning(f"no {self.noun} on {self.topic} for {seconds:g} s: the robot stands until one comes")

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
