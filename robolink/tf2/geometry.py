"""Transformation of geometry messages into another frame: the API of ROS 2's tf2_geometry_msgs.

A function takes an object and a TransformStamped, and returns a new object; both arguments stay as they are. Of a type
with a header the new one has the transform's: its frame and its time.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from robolink.geometry.rotations import quaternion_matrix
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Point32,
    PointStamped,
    Polygon,
    PolygonStamped,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    PoseWithCovarianceStamped,
    Quaternion,
    QuaternionStamped,
    Transform,
    TransformStamped,
    Vector3,
    Vector3Stamped,
    Wrench,
    WrenchStamped,
)
from robolink.tf2.buffer_interface import ConvertRegistration, TransformRegistration
from robolink.tf2.rigid import IDENTITY, Rigid, compose, unit

T = TypeVar("T")


def rigid_of(transform: Transform) -> Rigid:
    """Return `transform`, a Transform, as seven floats: its quaternion is scaled to length 1; all zero is none."""
    place, turn = transform.translation, transform.rotation
    return (place.x, place.y, place.z, *_unit_quaternion(turn))


def _unit_quaternion(turn: Quaternion) -> tuple[float, float, float, float]:
    if not any((turn.x, turn.y, turn.z, turn.w)):
        return IDENTITY[3:]
    return unit((0.0, 0.0, 0.0, turn.x, turn.y, turn.z, turn.w))[3:]


def rotation_of(transform: Transform) -> NDArray[np.float64]:
    """Return the rotation of `transform`, a Transform, as a 3x3 matrix."""
    return quaternion_matrix(_unit_quaternion(transform.rotation))[:3, :3]


def _moved(rigid: Rigid, point: Any) -> dict[str, float]:
    x, y, z = compose(rigid, (point.x, point.y, point.z, *IDENTITY[3:]))[:3]
    return {"x": x, "y": y, "z": z}


def _turned(rigid: Rigid, vector: Any) -> dict[str, float]:
    return _moved((0.0, 0.0, 0.0, *rigid[3:]), vector)


def _oriented(rigid: Rigid, orientation: Quaternion) -> Quaternion:
    x, y, z, w = compose(rigid, (0.0, 0.0, 0.0, *_unit_quaternion(orientation)))[3:]
    return Quaternion(x=-x, y=-y, z=-z, w=-w) if w < 0.0 else Quaternion(x=x, y=y, z=z, w=w)


def _stamped(made: T, transform: TransformStamped) -> T:
    made.header = deepcopy(transform.header)  # type: ignore[attr-defined]
    return made


# Points and vectors


def do_transform_point(point: Any, transform: TransformStamped) -> Any:
    """Return `point`, a PointStamped or a bare Point, rotated and moved by `transform`."""
    rigid = rigid_of(transform.transform)
    if isinstance(point, Point):
        return Point(**_moved(rigid, point))
    return _stamped(PointStamped(point=Point(**_moved(rigid, point.point))), transform)


def do_transform_vector3(vector3: Any, transform: TransformStamped) -> Any:
    """Return `vector3`, a Vector3Stamped or a bare Vector3, rotated by `transform`: a vector has no place to move."""
    rigid = rigid_of(transform.transform)
    if isinstance(vector3, Vector3):
        return Vector3(**_turned(rigid, vector3))
    return _stamped(Vector3Stamped(vector=Vector3(**_turned(rigid, vector3.vector))), transform)


def do_transform_polygon(polygon: Polygon, transform: TransformStamped) -> Polygon:
    """Return `polygon` with its points rotated and moved by `transform`."""
    rigid = rigid_of(transform.transform)
    return Polygon(points=[Point32(**_moved(rigid, each)) for each in polygon.points])


def do_transform_polygon_stamped(polygon: PolygonStamped, transform: TransformStamped) -> PolygonStamped:
    """Return `polygon`, stamped as `transform` is, with its points rotated and moved by it."""
    return _stamped(PolygonStamped(polygon=do_transform_polygon(polygon.polygon, transform)), transform)


# Rotations and poses


def do_transform_quaternion(quaternion: Any, transform: TransformStamped) -> Any:
    """Return `quaternion`, a QuaternionStamped or a bare Quaternion, rotated by `transform`; its w is positive."""
    rigid = rigid_of(transform.transform)
    if isinstance(quaternion, Quaternion):
        return _oriented(rigid, quaternion)
    return _stamped(QuaternionStamped(quaternion=_oriented(rigid, quaternion.quaternion)), transform)


def do_transform_pose(pose: Any, transform: TransformStamped) -> Any:
    """Return `pose` rotated and moved by `transform`; a PoseStamped too, as some programs for older releases need."""
    if isinstance(pose, PoseStamped):
        return do_transform_pose_stamped(pose, transform)
    rigid = rigid_of(transform.transform)
    return Pose(position=Point(**_moved(rigid, pose.position)), orientation=_oriented(rigid, pose.orientation))


def do_transform_pose_stamped(pose: PoseStamped, transform: TransformStamped) -> PoseStamped:
    """Return `pose`, stamped as `transform` is, rotated and moved by it."""
    return _stamped(PoseStamped(pose=do_transform_pose(pose.pose, transform)), transform)


def do_transform_pose_with_covariance(pose: PoseWithCovariance, transform: TransformStamped) -> PoseWithCovariance:
    """Return `pose` and its covariance rotated and moved by `transform`."""
    moved = do_transform_pose(pose.pose, transform)
    return PoseWithCovariance(pose=moved, covariance=transform_covariance(pose.covariance, transform))


def do_transform_pose_with_covariance_stamped(
    pose: PoseWithCovarianceStamped, transform: TransformStamped
) -> PoseWithCovarianceStamped:
    """Return `pose` and its covariance, stamped as `transform` is, rotated and moved by it."""
    return _stamped(PoseWithCovarianceStamped(pose=do_transform_pose_with_covariance(pose.pose, transform)), transform)


def transform_covariance(cov_in: Any, transform: TransformStamped) -> NDArray[np.float64]:
    """Return a covariance of position and orientation, rotated by `transform`.

    `cov_in` has 36 numbers, the rows of a 6x6 matrix; each of its quarters C becomes `R C R^T`.
    """
    quarters = np.asarray(cov_in, np.float64).reshape(2, 3, 2, 3)
    rotation = rotation_of(transform.transform)
    turned: NDArray[np.float64] = np.einsum("ij,ajbk,lk->aibl", rotation, quarters, rotation)
    return turned.reshape(36)


# Forces


def do_transform_wrench(wrench: Any, transform: TransformStamped) -> Any:
    """Return `wrench`, stamped or not, as it acts at the other frame's origin, by `transform`.

    The lever of the force adds a torque.
    """
    if isinstance(wrench, WrenchStamped):
        return do_transform_wrench_stamped(wrench, transform)
    rigid = rigid_of(transform.transform)
    force, torque = Vector3(**_turned(rigid, wrench.force)), Vector3(**_turned(rigid, wrench.torque))
    x, y, z = rigid[:3]
    torque.x += y * force.z - z * force.y
    torque.y += z * force.x - x * force.z
    torque.z += x * force.y - y * force.x
    return Wrench(force=force, torque=torque)


def do_transform_wrench_stamped(wrench: WrenchStamped, transform: TransformStamped) -> WrenchStamped:
    """Return `wrench`, stamped as `transform` is, as it acts at the other frame's origin."""
    return _stamped(WrenchStamped(wrench=do_transform_wrench(wrench.wrench, transform)), transform)


# Registration for Buffer.transform


def to_msg_msg(msg: T) -> T:
    """Return `msg` unchanged."""
    return msg


from_msg_msg = to_msg_msg

_FUNCTIONS: dict[type[Any], Callable[[Any, TransformStamped], Any]] = {
    PointStamped: do_transform_point,
    Vector3Stamped: do_transform_vector3,
    PolygonStamped: do_transform_polygon_stamped,
    QuaternionStamped: do_transform_quaternion,
    PoseStamped: do_transform_pose_stamped,
    PoseWithCovarianceStamped: do_transform_pose_with_covariance_stamped,
    WrenchStamped: do_transform_wrench_stamped,
}

for _type, _function in _FUNCTIONS.items():
    TransformRegistration().add(_type, _function)
    ConvertRegistration().add_to_msg(_type, to_msg_msg)
    ConvertRegistration().add_from_msg(_type, from_msg_msg)
