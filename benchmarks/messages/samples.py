"""Messages for benchmarks, as a robot would send them: a Twist, a scan of 360 beams, images of 1 MB and of 6.2 MB."""

from __future__ import annotations

from array import array
from typing import Any

KINDS = ("twist", "stamped", "scan", "1mb", "6mb")
"""Names of the messages. `stamped` is a TwistStamped."""

SIDES = {"1mb": (1024, 1024, 1, "mono8"), "6mb": (1920, 1080, 3, "rgb8")}
"""Width, height, bytes of a pixel and encoding of the images."""

BEAMS = 360


def pixels(kind: str) -> bytes:
    """The content of an image."""
    width, height, channels, _ = SIDES[kind]
    return (bytes(range(251)) * (width * height * channels // 251 + 1))[: width * height * channels]


def ranges() -> list[float]:
    """Where the beams of a scan end, in metres."""
    return [1.5 + beam / 1024 for beam in range(BEAMS)]  # each fits into 32 bits


def message_type(kind: str) -> Any:
    """The class of a message, in robolink."""
    from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped
    from robolink.interfaces.sensor_msgs.msg import Image, LaserScan

    return {"twist": Twist, "stamped": TwistStamped, "scan": LaserScan}.get(kind, Image)


def sample(kind: str) -> Any:
    """A message of this kind, in robolink."""
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
        twist.linear.x, twist.angular.z = 0.3, -0.5
    return message
