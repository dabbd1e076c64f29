"""Log what comes on /chatter."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class Listener(Node):
    """A node that logs what it hears. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("listener", **options)
        self.create_subscription(String, "chatter", self.on_chatter, 10)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")
