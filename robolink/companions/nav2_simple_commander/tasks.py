"""Kinds and outcomes of a navigator's tasks, and small conversions for their goals."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

from robolink.duration import Duration
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav_msgs.msg import Goals


class TaskResult(Enum):
    """Outcome of a task; UNKNOWN before its end."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


class RunningTask(Enum):
    """Kind of a task, as the methods that start one return it."""

    NONE = 0
    NAVIGATE_TO_POSE = 1
    NAVIGATE_THROUGH_POSES = 2
    FOLLOW_PATH = 3
    FOLLOW_WAYPOINTS = 4
    FOLLOW_GPS_WAYPOINTS = 5
    SPIN = 6
    BACKUP = 7
    DRIVE_ON_HEADING = 8
    ASSISTED_TELEOP = 9
    DOCK_ROBOT = 10
    UNDOCK_ROBOT = 11
    COMPUTE_AND_TRACK_ROUTE = 12


RESULTS: dict[int | None, TaskResult] = {
    GoalStatus.STATUS_SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.STATUS_ABORTED: TaskResult.FAILED,
    GoalStatus.STATUS_CANCELED: TaskResult.CANCELED,
}
"""Outcomes by the status of a goal that has ended."""


def poses_in(poses: Sequence[PoseStamped] | Goals) -> list[PoseStamped]:
    """Return the poses of a list or of Kilted's Goals.

    Args:
        poses: The list or the message.
    """
    return list(poses.goals if isinstance(poses, Goals) else poses)


def spot(pose: PoseStamped) -> str:
    """Return the place of a pose, for people: ``1.5 -2.0``.

    Args:
        pose: The pose.
    """
    return f"{pose.pose.position.x} {pose.pose.position.y}"


def time_of(seconds: float) -> DurationMsg:
    """Return a time in seconds as a message.

    Args:
        seconds: The time in s.
    """
    return Duration(seconds=seconds).to_msg()
