"""Following of one path: the goal's path in its own frame, and the part of it that lies ahead of the robot."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from robolink.counterparts.nav2_controller.checkers import GoalChecker, ProgressChecker
from robolink.counterparts.nav2_controller.controllers import Controller
from robolink.counterparts.nav2_costmap_2d.costmap_2d_ros import Costmap2DROS
from robolink.counterparts.nav2_costmap_2d.inputs import planar
from robolink.exceptions import RobolinkError
from robolink.geometry.plane import Pose, is_finite, placed_on, pose_of, seen_from
from robolink.interfaces.geometry_msgs.msg import PoseStamped, Quaternion
from robolink.interfaces.nav2_msgs.action import FollowPath
from robolink.interfaces.nav_msgs.msg import Path
from robolink.navigation.grid import Floats
from robolink.navigation.local_path import LocalPath, ahead, lengths, nearest
from robolink.tf2.exceptions import TransformException
from robolink.time import Time

SPACING = 0.05
"""Distance in metres of the points of the path ahead."""


class DriveError(RobolinkError):
    """A drive that cannot go on: `code` is one of FollowPath's error codes."""

    def __init__(self, code: int, text: str) -> None:
        super().__init__(text)
        self.code = code


class FollowedPath:
    """A path in its own frame, and how far the robot has come along it.

    Args:
        path: The path; poses are in the frame of its header.
        frame: Frame of a path without one.

    Raises:
        DriveError: if it is empty, or a pose is not finite.
    """

    def __init__(self, path: Path, frame: str) -> None:
        self.frame: str = path.header.frame_id.removeprefix("/") or frame
        poses = [pose_of(each.pose) for each in path.poses]
        if not poses:
            raise DriveError(FollowPath.Result.INVALID_PATH, "Path is empty.")
        for number, pose in enumerate(poses):
            if not is_finite(pose):
                raise DriveError(FollowPath.Result.INVALID_PATH, f"Pose {number} of the path is not finite: {pose}")
        self._poses: Floats = np.array(poses)
        self._along = lengths(self._poses)
        self._place = 0.0
        self._is_new = True

    def ahead(self, robot: Pose, frame: Pose, reach: float) -> tuple[LocalPath, Pose]:
        """Return the part of the path ahead, and its goal, in the frame of the robot's pose.

        Args:
            robot: Pose of the robot.
            frame: Pose of the path's frame, in the frame of the robot's pose.
            reach: Length of the part in metres.
        """
        own = seen_from(frame, robot)
        # A new path may begin far behind the robot; later it does not jump to where the path comes by again.
        window = math.inf if self._is_new else max(1.0, reach)
        self._place = nearest(self._poses, self._along, own.x, own.y, self._place, window)
        self._is_new = False
        part = ahead(self._poses, self._along, self._place, reach, SPACING)
        cos, sin = math.cos(frame.theta), math.sin(frame.theta)
        x, y = frame.x + cos * part.x - sin * part.y, frame.y + sin * part.x + cos * part.y
        goal = placed_on(frame, Pose(*map(float, self._poses[-1])))
        return part._replace(x=x, y=y, theta=part.theta + frame.theta), goal


@dataclass
class Drive:
    """A drive along a path, with its plugins; `valid_time` in seconds is that of the last valid command."""

    path: FollowedPath
    controller: Controller
    goal_checker: GoalChecker
    progress: ProgressChecker | None
    valid_time: float = 0.0


def fresh_transform(costmap: Costmap2DROS, frame: str, oldest: float) -> Pose:
    """Return the pose of a frame in the costmap's. Raises DriveError if it is not known, or `oldest` seconds old."""
    if frame == costmap.global_frame:
        return Pose()
    try:
        found = costmap.tf_buffer.lookup_transform_core(costmap.global_frame, frame, Time())
    except TransformException as error:
        raise DriveError(FollowPath.Result.TF_ERROR, f"no transform from '{frame}': {error}") from error
    stamp = found.header.stamp.sec + found.header.stamp.nanosec * 1e-9
    age = costmap.get_clock().now().nanoseconds / 1e9 - stamp
    if stamp and age > oldest:
        raise DriveError(
            FollowPath.Result.TF_ERROR,
            f"the transform from '{frame}' to '{costmap.global_frame}' is {age:.1f} s old, and may be {oldest:g} s old",
        )
    pose = planar(found.transform)
    if not is_finite(pose):
        raise DriveError(FollowPath.Result.TF_ERROR, f"the transform from '{frame}' is not finite")
    return pose


def path_message(poses: Floats) -> Path:
    """Return a path without a header, of poses of shape (poses, 3)."""
    path = Path()
    for x, y, theta in poses.tolist():
        stamped = PoseStamped()
        stamped.pose.position.x, stamped.pose.position.y = x, y
        stamped.pose.orientation = Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))
        path.poses.append(stamped)
    return path
