"""Messages of AMCL as plain values, and back: poses with a covariance, maps, particles, transforms."""

from __future__ import annotations

import math

import numpy as np

from robolink.geometry.plane import Pose, pose_of
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    PoseWithCovarianceStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.nav2_msgs.msg import Particle, ParticleCloud
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.std_msgs.msg import Header
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.particle_filter import ParticleFilter
from robolink.tf2.geometry import rigid_of

DOUBT = (0.25, 0.25, (math.pi / 12) ** 2)
"""Variances of x, y (m²) and heading (rad²) of an initial pose that says nothing of them, as Nav2 begins with."""

PLACES = ((0, 0), (0, 1), (0, 5), (1, 0), (1, 1), (1, 5), (5, 0), (5, 1), (5, 5))
"""Rows and columns of a message's covariance (6 x 6) that the plane has: x, y and heading."""

_FARTHEST = 1e7


def pose_fault(message: PoseWithCovarianceStamped) -> str:
    """Return the mistake of an initial pose; '' if a robot can be there."""
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    if not message.header.frame_id:
        return "its frame_id is empty"
    if not all(abs(each) <= _FARTHEST for each in (place.x, place.y, place.z)):
        return f"expected a finite position, got {place}"
    if not abs(math.hypot(turn.x, turn.y, turn.z, turn.w) - 1.0) < 1e-2:
        return f"expected a quaternion of length 1, such as w: 1 for no rotation, got {turn}"
    if not all(map(math.isfinite, message.pose.covariance)):
        return "its covariance is not finite"
    return ""


def covariance_of(message: PoseWithCovarianceStamped) -> Floats:
    """Return the covariance of an initial pose (3 x 3: x, y, heading); if it is all zero, that of a rough guess."""
    given = np.array(message.pose.covariance, np.float64).reshape(6, 6)
    found = np.array([given[place] for place in PLACES]).reshape(3, 3)
    return found if found.any() else np.diag(DOUBT)


def pose_message(pose: Pose, frame: str, stamp: Time, covariance: Floats | None = None) -> PoseWithCovarianceStamped:
    """Return a pose and its covariance (3 x 3: x, y, heading; None for none) as a message."""
    message = PoseWithCovarianceStamped(header=Header(stamp=stamp, frame_id=frame))
    message.pose.pose = _pose(*pose)
    if covariance is not None:
        whole = np.zeros((6, 6))
        for place, value in zip(PLACES, covariance.ravel().tolist(), strict=True):
            whole[place] = value
        message.pose.covariance = whole.ravel().tolist()
    return message


def _pose(x: float, y: float, theta: float) -> PoseMessage:
    half = theta / 2
    return PoseMessage(
        position=Point(x=x, y=y, z=0.0), orientation=Quaternion(x=0.0, y=0.0, z=math.sin(half), w=math.cos(half))
    )


def map_fault(message: OccupancyGrid) -> str:
    """Return the mistake of a map; '' if it can be used."""
    info, place = message.info, message.info.origin.position
    if not info.width or not info.height or len(message.data) != info.width * info.height:
        return f"{info.width} X {info.height} cells, and {len(message.data)} values"
    if not 1e-4 <= info.resolution <= 1e3:
        return f"expected a resolution from 0.0001 to 1000 m, got {info.resolution:g}"
    if not all(abs(each) <= _FARTHEST for each in (place.x, place.y)) or not math.isfinite(pose_of(info.origin).theta):
        return f"expected a finite origin, got {info.origin}"
    return ""


def grid_of(message: OccupancyGrid) -> Grid:
    """Return a map's cells; `map_fault` has no objection."""
    info = message.info
    cells = np.array(message.data, np.int8).reshape(info.height, info.width)
    x, y, theta = pose_of(info.origin)
    return Grid(cells, float(info.resolution), (x, y, theta))


def cloud_of(particles: ParticleFilter, frame: str, stamp: Time) -> ParticleCloud:
    """Return particles as a message."""
    columns = zip(*particles.poses.tolist(), particles.weights.tolist(), strict=True)
    every = [Particle(pose=_pose(x, y, theta), weight=weight) for x, y, theta, weight in columns]
    return ParticleCloud(header=Header(stamp=stamp, frame_id=frame), particles=every)


def plane_pose(message: TransformStamped) -> Pose:
    """Return a transform as a pose in the plane."""
    x, y, _, qx, qy, qz, qw = rigid_of(message.transform)
    return Pose(x, y, math.atan2(2.0 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz))


def transform_of(pose: Pose, frame: str, child: str, stamp: Time) -> TransformStamped:
    """Return the transform to a frame that lies at a pose of another one."""
    transform = Transform(translation=Vector3(x=pose.x, y=pose.y, z=0.0), rotation=_pose(*pose).orientation)
    return TransformStamped(header=Header(stamp=stamp, frame_id=frame), child_frame_id=child, transform=transform)
