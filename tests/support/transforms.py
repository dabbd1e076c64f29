"""Transforms for tests: built from a few numbers, and compared as matrices."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from robolink.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from robolink.time import Time

HALF = 0.5**0.5


def transform(
    parent: str,
    child: str,
    seconds: float = 0.0,
    place: tuple[float, ...] = (0.0, 0.0, 0.0),
    turn: tuple[float, ...] = (0.0, 0.0, 0.0, 1.0),
) -> TransformStamped:
    """The transform of a child that stands so in its parent; `turn` is a quaternion x, y, z, w."""
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id = parent
    made.header.stamp = Time(seconds=seconds).to_msg()
    made.transform = Transform(
        translation=Vector3(**dict(zip("xyz", map(float, place), strict=True))),
        rotation=Quaternion(**dict(zip("xyzw", map(float, turn), strict=True))),
    )
    return made


def rotation(message: TransformStamped) -> Rotation:
    """Its rotation, as scipy has it."""
    turn = message.transform.rotation
    return Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])


def place(message: TransformStamped) -> NDArray[Any]:
    """Its translation."""
    moved = message.transform.translation
    return np.array([moved.x, moved.y, moved.z])


def matrix(message: TransformStamped) -> NDArray[Any]:
    """It as a 4x4 matrix."""
    made = np.identity(4)
    made[:3, :3], made[:3, 3] = rotation(message).as_matrix(), place(message)
    return made


def between(one: TransformStamped, other: TransformStamped, ratio: float) -> NDArray[Any]:
    """What scipy and a straight line make of the way from one to the other."""
    made = np.identity(4)
    both = Rotation.concatenate([rotation(one), rotation(other)])
    made[:3, :3] = Slerp([0.0, 1.0], both)([ratio])[0].as_matrix()
    made[:3, 3] = (1 - ratio) * place(one) + ratio * place(other)
    return made
