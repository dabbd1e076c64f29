"""Filled messages of test_msgs, as rclpy's own tests import them: `get_test_msg("Empty")`, `get_msg_empty()`."""

import functools
import importlib
from collections.abc import Callable

from robolink.compat.names import snake_case
from robolink.message import Message
from tests.support.ros_test_types import filled_messages


def get_test_msg(message_name: str) -> list[Message]:
    """Return four messages of a type, see `filled_messages`."""
    return filled_messages(getattr(importlib.import_module("test_msgs.msg"), message_name))


def __getattr__(name: str) -> Callable[[], list[Message]]:
    for each in dir(importlib.import_module("test_msgs.msg")):
        if name == f"get_msg_{snake_case(each)}":
            return functools.partial(get_test_msg, each)
    raise AttributeError(name)
