"""Log what comes on /topic."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class MinimalSubscriber(Node):
    """A node that logs what it hears. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_subscriber", **options)
        self.create_subscription(String, "topic", self.on_message, 10)

    def on_message(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f'I heard: "{message.data}"')
