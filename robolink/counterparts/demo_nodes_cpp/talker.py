"""Publish `Hello World: N` on /chatter each second, from 1 on."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class Talker(Node):
    """A node that publishes a count each second, from 1 on. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("talker", **options)
        self.count = 0
        self.chatter = self.create_publisher(String, "chatter", 7)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        self.count += 1
        message = String(data=f"Hello World: {self.count}")
        self.get_logger().info(f"Publishing: '{message.data}'")
        self.chatter.publish(message)
