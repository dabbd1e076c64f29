"""Messages of slam_toolbox: scans as beams, maps, poses, transforms, and the pose graph as markers."""

from __future__ import annotations

import math

import numpy as np

from robolink.geometry.plane import Pose
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
from robolink.interfaces.nav_msgs.msg import MapMetaData, OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.navigation import occupancy
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.occupancy import Beams, Lidar
from robolink.navigation.pose_graph import PoseGraph
from robolink.tf2.geometry import rigid_of, rotation_of

MOST_ANGLE = 100.0
"""Largest angle of a beam in radians: a larger one is a mistake."""


def scan_fault(scan: LaserScan) -> str:
    """Return the mistake of a scan; '' if it can be used."""
    last = scan.angle_min + scan.angle_increment * max(len(scan.ranges) - 1, 0)
    if not all(abs(each) <= MOST_ANGLE for each in (scan.angle_min, last)):
        return f"expected angles within {MOST_ANGLE:g} rad, got {scan.angle_min:g} to {last:g}"
    if not scan.header.frame_id:
        return "its frame_id is empty"
    return ""


def beams_of(scan: LaserScan, mount: TransformStamped, longest: float) -> Beams:
    """Return the beams of a scan in the frame of the robot, however its lidar is mounted.

    Beams that met nothing, or something too near, are left out.

    Args:
        scan: Scan without a fault.
        mount: Transform from the lidar's frame to the robot's.
        longest: Metres from which on a beam only says what is free; 0 for the lidar's longest.
    """
    ranges = np.array(scan.ranges, np.float64)
    angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
    most = scan.range_max if scan.range_max > 0.0 else math.inf
    turn, place = rotation_of(mount.transform), mount.transform.translation
    lidar = Lidar((place.x, place.y), turn[:2, :2])
    return occupancy.beams_of(ranges, angles, (scan.range_min, most), longest or most, lidar)


def plane_pose(message: TransformStamped) -> Pose:
    """Return a transform as a pose in the plane."""
    x, y, _, qx, qy, qz, qw = rigid_of(message.transform)
    return Pose(x, y, math.atan2(2.0 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz))


def _pose(x: float, y: float, theta: float) -> PoseMessage:
    return PoseMessage(position=Point(x=x, y=y, z=0.0), orientation=_turned(theta))


def _turned(theta: float) -> Quaternion:
    return Quaternion(x=0.0, y=0.0, z=math.sin(theta / 2), w=math.cos(theta / 2))


def pose_message(
    pose: Pose, covariance: Floats, scales: tuple[float, float], header: Header
) -> PoseWithCovarianceStamped:
    """Return a pose as a message; `scales` are factors of the covariances of the position and of the heading."""
    message = PoseWithCovarianceStamped(header=header)
    message.pose.pose = _pose(*pose)
    whole = np.zeros((6, 6))
    whole[:2, :2] = covariance[:2, :2] * scales[0]
    whole[5, 5] = covariance[2, 2] * scales[1]
    message.pose.covariance = whole.ravel().tolist()
    return message


def transform_message(pose: Pose, header: Header, child: str) -> TransformStamped:
    """Return the transform to a frame `child` that lies at a pose of the frame of the header."""
    transform = Transform(translation=Vector3(x=pose.x, y=pose.y, z=0.0), rotation=_turned(pose.theta))
    return TransformStamped(header=header, child_frame_id=child, transform=transform)


def map_message(grid: Grid, header: Header) -> OccupancyGrid:
    """Return a map as a message."""
    height, width = grid.cells.shape
    information = MapMetaData(
        map_load_time=header.stamp, resolution=grid.resolution, width=width, height=height, origin=_pose(*grid.origin)
    )
    return OccupancyGrid(header=header, info=information, data=grid.cells.ravel())


def graph_message(graph: PoseGraph, frame: str, stamp: Time) -> MarkerArray:
    """Return a pose graph as markers: a ball for each pose, and a line for each relation that is believed."""
    header, red, blue = Header(stamp=stamp, frame_id=frame), ColorRGBA(r=1.0, a=1.0), ColorRGBA(b=1.0, a=1.0)
    markers = [Marker(header=header, action=Marker.DELETEALL)]
    points = [Point(x=x, y=y, z=0.0) for x, y, _ in graph.poses.tolist()]
    for number, point in enumerate(points):
        ball = Marker(header=header, ns="slam_toolbox", id=number, type=Marker.SPHERE, color=red)
        ball.pose.position, ball.pose.orientation.w = point, 1.0
        ball.scale = Vector3(x=0.1, y=0.1, z=0.1)
        markers.append(ball)
    lines = Marker(header=header, ns="slam_toolbox_edges", id=0, type=Marker.LINE_LIST, color=blue)
    lines.pose.orientation.w, lines.scale.x = 1.0, 0.05
    pairs = [(number, number + 1) for number in range(len(points) - 1)]
    pairs += [(each.source, each.target) for each in graph.loops if each.weight > 0.5]
    lines.points = [points[end] for pair in pairs for end in pair]
    return MarkerArray(markers=[*markers, lines])
