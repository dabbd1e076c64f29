"""Filled messages of test_msgs, as rclpy's own tests import them."""

import importlib

from robolink.message import Message
from tests.support.ros_test_types import filled_messages


def get_test_msg(message_name: str) -> list[Message]:
    """Return four messages of a type, see `filled_messages`."""
    return filled_messages(getattr(importlib.import_module("test_msgs.msg"), message_name))
