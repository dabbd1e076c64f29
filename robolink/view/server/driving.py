"""Velocities that a client has sent: whether something moves by them, and the message that stops it."""

from __future__ import annotations

import copy
from typing import Any

DRIVEN = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
"""Types of messages that set robots in motion."""


def moves(message: Any) -> bool:
    """True if a Twist or TwistStamped is not all zeros."""
    twist = getattr(message, "twist", message)
    return any((*_numbers(twist.linear), *_numbers(twist.angular)))


def stop_of(message: Any, now: int) -> Any:
    """Return the message of zeros for whatever the given one moves.

    Args:
        message: Twist or TwistStamped that was sent last.
        now: Time for its header, in ns.
    """
    stopped = type(message)()
    if hasattr(message, "header"):
        stopped.header = copy.deepcopy(message.header)
        stopped.header.stamp.sec, stopped.header.stamp.nanosec = divmod(now, 10**9)
    return stopped


def _numbers(vector: Any) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z
