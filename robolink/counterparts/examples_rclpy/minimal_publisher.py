"""Publish `Hello World: N` on /topic twice a second."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class MinimalPublisher(Node):
    """A node that publishes a count. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_publisher", **options)
        self.count = 0
        self.topic = self.create_publisher(String, "topic", 10)
        self.create_timer(0.5, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        message = String(data=f"Hello World: {self.count}")
        self.topic.publish(message)
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.count += 1
