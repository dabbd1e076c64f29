"""The robot's pose by transforms, and a pose in another frame, as Nav2's servers look them up."""

from __future__ import annotations

import math
from typing import Any

from robolink.interfaces.geometry_msgs.msg import Pose, PoseStamped
from robolink.node import Node
from robolink.tf2 import Buffer, TransformException
from robolink.tf2.geometry import do_transform_pose_stamped
from robolink.time import Time

FARTHEST = 1e6
"""Largest coordinate of a pose, in metres: a place farther away is a mistake."""


def fault(pose: Pose) -> str:
    """Return the mistake of a pose that somebody sent, for people; '' if a robot can be there."""
    place, turn = pose.position, pose.orientation
    numbers = (place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w)
    if not all(abs(each) <= FARTHEST for each in numbers):
        given = ", ".join(f"{each:g}" for each in numbers)
        return f"expected finite numbers, and places within {FARTHEST:g} m, got x, y, z and a quaternion of {given}"
    if math.hypot(*numbers[3:]) < 1e-3:
        return "its orientation is all zero, which is not a quaternion: w is 1 for no rotation"
    return ""


def robot_pose(buffer: Buffer, node: Node, frame: str, base: str, tolerance: float = math.inf) -> PoseStamped:
    """Return the latest known pose of the robot.

    Args:
        buffer: Transforms.
        node: Node whose clock says what is late.
        frame: Frame of the pose, such as `map`.
        base: Frame of the robot, such as `base_link`.
        tolerance: Greatest age in seconds; one that is older is an error, since the robot may be anywhere by now.

    Raises:
        TransformException: if no transform leads from one frame to the other, or it is too old; it says which, and
            what to look for.
    """
    try:
        found = buffer.lookup_transform(frame, base, Time())
    except TransformException as error:
        raise type(error)(
            f"no transform from '{base}' to '{frame}', so that the robot's pose is not known: {error}"
        ) from error
    stamp = found.header.stamp
    age = node.get_clock().now_ns() / 1e9 - (stamp.sec + stamp.nanosec * 1e-9)
    is_static = stamp.sec == stamp.nanosec == 0
    if age > tolerance and not is_static:
        raise TransformException(
            f"the transform from '{base}' to '{frame}' is {age:.1f} s old, and may be {tolerance:g} s old:"
            " does localization still run?"
        )
    pose = PoseStamped(header=found.header)
    place, turn = found.transform.translation, found.transform.rotation
    pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = place.x, place.y, place.z
    pose.pose.orientation = turn
    return pose


def in_frame(buffer: Buffer, pose: PoseStamped, frame: str) -> PoseStamped:
    """Return a pose in another frame, by the transform at its stamp; if that is not there, by the latest.

    Raises:
        TransformException: if no transform leads from its frame to the other, or it has none.
    """
    own: Any = pose.header.frame_id.removeprefix("/")
    if own == frame:
        return pose
    try:
        found = buffer.lookup_transform(frame, own, pose.header.stamp)
    except TransformException:
        found = buffer.lookup_transform(frame, own, Time())
    return do_transform_pose_stamped(pose, found)
