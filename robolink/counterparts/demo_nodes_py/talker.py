"""Publish `Hello World: N` on /chatter each second."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.qos import QoSProfile


class Talker(Node):
    """A node that publishes a count each second.

    Args:
        name: Name of the node.
        qos: Profile or depth of the publisher.
        options: Those of `Node`.
    """

    def __init__(self, name: str = "talker", qos: QoSProfile | int = 10, **options: Any) -> None:
        super().__init__(name, **options)
        self.count = 0
        self.chatter = self.create_publisher(String, "chatter", qos)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        message = String(data=f"Hello World: {self.count}")
        self.count += 1
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.chatter.publish(message)
