"""Log what comes on /chatter."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.qos import QoSProfile


class Listener(Node):
    """A node that logs what it hears.

    Args:
        name: Name of the node.
        qos: Profile or depth of the subscription.
        options: Those of `Node`.
    """

    def __init__(self, name: str = "listener", qos: QoSProfile | int = 10, **options: Any) -> None:
        super().__init__(name, **options)
        self.create_subscription(String, "chatter", self.on_chatter, qos)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")
