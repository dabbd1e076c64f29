"""Log what comes on /chatter, as bytes and as text."""

from __future__ import annotations

from typing import Any

from robolink.exceptions import DecodeError
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node
from robolink.serialization import deserialize_message


class SerializedListener(Node):
    """A node that gets messages as bytes, and logs them and what they mean. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("serialized_subscriber", **options)
        self.create_subscription(String, "chatter", self.on_bytes, 10, raw=True)

    def on_bytes(self, payload: bytes) -> None:
        """Log a message as bytes and as text."""
        self.get_logger().info(f'I heard: "{payload!r}"')
        try:
            self.get_logger().info(f"I heard: [{deserialize_message(payload, String).data}]")
        except DecodeError as error:
            self.get_logger().warning(f"these bytes are not a String: {error}")
