"""Messages for benchmarks, as a robot would send them: a Twist, a scan of 360 beams, images of 1 MB and of 6.2 MB."""

from __future__ import annotations

import importlib
from array import array
from collections.abc import Callable
from typing import Any

LAST_PIXEL = 0xA5
"""Value of an image's last byte, by which a flood's images are checked."""
SPIN = -0.5
"""The field `angular.z` of each Twist, by which a flood's Twists are checked."""

KINDS = ("twist", "stamped", "scan", "1mb", "6mb")
"""Names of the messages. `stamped` is a TwistStamped."""

SIDES = {"1mb": (1024, 1024, 1, "mono8"), "6mb": (1920, 1080, 3, "rgb8")}
"""Width, height, bytes of a pixel and encoding of the images."""

BEAMS = 360


def pixels(kind: str) -> bytes:
    """Return the content of an image."""
    width, height, channels, _ = SIDES[kind]
    size = width * height * channels
    return (bytes(range(251)) * (size // 251 + 1))[: size - 1] + bytes([LAST_PIXEL])


def ranges() -> list[float]:
    """Where the beams of a scan end, in metres."""
    return [1.5 + beam / 1024 for beam in range(BEAMS)]  # each fits into 32 bits


def message_type(kind: str) -> Any:
    """Return the class of a message, of the ROS 2 that is there: robolink's, or a real one."""
    package, name = {"twist": ("geometry", "Twist"), "stamped": ("geometry", "TwistStamped")}.get(
        kind, ("sensor", "LaserScan" if kind == "scan" else "Image")
    )
    return getattr(importlib.import_module(f"{package}_msgs.msg"), name)


def sample(kind: str) -> Any:
    """Return a message of this kind."""
    message = message_type(kind)()
    if kind in SIDES:
        message.width, message.height, channels, message.encoding = SIDES[kind]
        message.step, message.data = message.width * channels, array("B", pixels(kind))
        message.header.frame_id = "camera"
    elif kind == "scan":
        message.ranges = array("f", ranges())
        message.header.frame_id = "laser"
    else:
        twist = message.twist if kind == "stamped" else message
        twist.linear.x, twist.angular.z = 0.3, SPIN
    return message


def position(kind: str) -> tuple[str, int]:
    """Return where a flood's number is in the message's CDR: the format of `struct`, and the first byte.

    A Twist's number is its `linear.x`, another's is `header.stamp.nanosec`; four bytes of CDR's header are before it.
    """
    return ("<d", 4) if kind == "twist" else ("<I", 8)


def counting(kind: str, add: Callable[[int, bool], object]) -> Callable[[Any], object]:
    """Return a callback that hands on a message's number in a flood, and whether its content is what was sent."""
    if kind == "twist":
        return lambda message: add(message.linear.x, message.angular.z == SPIN)
    if kind == "stamped":
        return lambda message: add(message.header.stamp.nanosec, message.twist.angular.z == SPIN)
    if kind == "scan":
        return lambda message: add(message.header.stamp.nanosec, len(message.ranges) == BEAMS)
    return lambda message: add(message.header.stamp.nanosec, message.data[-1] == LAST_PIXEL)
