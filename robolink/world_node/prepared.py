"""Prepared messages: encoded once, so that of each message only the stamp and the numbers are packed anew.

What a simulated robot publishes differs from one moment to the next in these alone: frames, counts and padding stay.
The bytes are those of the messages that `messages.py` makes, which are encoded here once and cut where they change.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.message import encode
from robolink.sim import Pose, Scan, Velocity
from robolink.sim.arrays import Array
from robolink.sim.sensors import Lidar
from robolink.world_node.messages import Covariance, odometry_message, scan_message, time_message, transform_message

_HEAD, _STAMP, _COUNT = 4, 8, 4
"""Sizes in bytes: the encapsulation header of a payload, a stamp, the count of a sequence."""

_POSE, _TWIST = struct.Struct("<7d"), struct.Struct("<6d")
_COVARIANCE = 36 * 8

_NOTHING_SAID = bytes(_COVARIANCE)
"""An unknown covariance, as ROS reads zeros."""


class Stamp(NamedTuple):
    """A time as a message, and as the beginning of the payload of each message that begins with this stamp."""

    message: Time
    beginning: bytes

    @classmethod
    def of(cls, nanoseconds: int) -> Stamp:
        """Return the stamp of a time."""
        message = time_message(nanoseconds)
        return cls(message, encode(message))


def packed_pose(pose: Pose) -> bytes:
    """Pack a pose in the plane as the numbers of a geometry_msgs/Pose, which are those of a Transform too."""
    half = pose.theta / 2
    return _POSE.pack(pose.x, pose.y, 0.0, 0.0, 0.0, math.sin(half), math.cos(half))


class PreparedOdometry:
    """The odometry of the frame `child` in the frame `frame`."""

    def __init__(self, frame: str, child: str) -> None:
        whole = encode(odometry_message(Header(frame_id=frame), child, Pose(0.0, 0.0), Velocity(0.0, 0.0)))
        numbers = _POSE.size + _TWIST.size + 2 * _COVARIANCE
        self._names = whole[_HEAD + _STAMP : -numbers]

    def payload(
        self,
        stamp: Stamp,
        pose: bytes,
        twist: Velocity,
        of_pose: Covariance | None = None,
        of_twist: Covariance | None = None,
    ) -> bytes:
        """Return the payload of `odometry_message`, of a `packed_pose`; without covariances they are unknown."""
        v, w, sideways = twist
        return b"".join(
            (
                stamp.beginning,
                self._names,
                pose,
                _NOTHING_SAID if of_pose is None else of_pose.tobytes(),
                _TWIST.pack(v, sideways, 0.0, 0.0, 0.0, w),
                _NOTHING_SAID if of_twist is None else of_twist.tobytes(),
            )
        )


class PreparedTransform:
    """The transform of the frame `child` in the frame `frame`; only the first of a message is padded otherwise."""

    def __init__(self, frame: str, child: str) -> None:
        transform = transform_message(Header(frame_id=frame), child, Pose(0.0, 0.0))
        once, twice = (encode(TFMessage(transforms=[transform] * count)) for count in (1, 2))
        self.first = once[_HEAD + _COUNT + _STAMP : -_POSE.size]
        """The names of the first transform of a message."""
        self.later = twice[len(once) + _STAMP : -_POSE.size]
        """The names of any other."""


def transforms_payload(stamp: Stamp, moved: Sequence[tuple[PreparedTransform, bytes]]) -> bytes:
    """Return the payload of a TFMessage of at least one transform, each with its `packed_pose`."""
    head, time = stamp.beginning[:_HEAD], stamp.beginning[_HEAD:]
    first, pose = moved[0]
    parts = [head, struct.pack("<I", len(moved)), time, first.first, pose]
    for each, pose in moved[1:]:
        parts += (time, each.later, pose)
    return b"".join(parts)


class PreparedScan:
    """The scans of a lidar, all of them like `scan` but for their ranges and intensities."""

    def __init__(self, scan: Scan, frame: str, sensor: Lidar) -> None:
        whole = encode(scan_message(scan, Header(frame_id=frame), sensor))
        lights = len(whole) - len(_floats(scan.intensities))
        ranges = lights - _COUNT - len(_floats(scan.ranges))
        self._begin, self._count = whole[_HEAD + _STAMP : ranges], whole[lights - _COUNT : lights]

    def payload(self, stamp: Stamp, scan: Scan) -> bytes:
        """Return the payload of `scan_message`."""
        return b"".join((stamp.beginning, self._begin, _floats(scan.ranges), self._count, _floats(scan.intensities)))


class PreparedImage:
    """The images of a camera, all of them like `image` but for their stamps and pixels."""

    def __init__(self, image: Image) -> None:
        whole = encode(image)
        self._begin = whole[_HEAD + _STAMP : len(whole) - len(image.data)]

    def payload(self, stamp: Stamp, pixels: npt.NDArray[Any]) -> bytes:
        """Return the payload of an image of these pixels, which are contiguous."""
        return b"".join((stamp.beginning, self._begin, pixels.reshape(-1).view(np.uint8).data))


def _floats(values: Array | None) -> bytes:
    return b"" if values is None else values.astype("<f4").tobytes()
