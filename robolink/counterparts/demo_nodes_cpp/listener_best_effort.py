"""Log what comes on /chatter, best effort."""

from __future__ import annotations

from typing import Any

from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.qos import qos_profile_sensor_data


class ListenerBestEffort(Node):
    """A node that logs what it hears, and may miss some. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("listener", **options)
        self.create_subscription(String, "chatter", self.on_chatter, qos_profile_sensor_data)

    def on_chatter(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"I heard: [{message.data}]")
