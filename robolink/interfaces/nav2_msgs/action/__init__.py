"""The actions of nav2_msgs: drive to poses, plan and follow paths, dock, and the small movements of recoveries."""

from robolink.interfaces.nav2_msgs.action._behaviors import BackUp, DriveOnHeading, Spin, Wait
from robolink.interfaces.nav2_msgs.action._driving import (
    FollowPath,
    FollowWaypoints,
    NavigateThroughPoses,
    NavigateToPose,
)
from robolink.interfaces.nav2_msgs.action._planning import ComputePathThroughPoses, ComputePathToPose

__all__ = [
    "BackUp",
    "ComputePathThroughPoses",
    "ComputePathToPose",
    "DriveOnHeading",
    "FollowPath",
    "FollowWaypoints",
    "NavigateThroughPoses",
    "NavigateToPose",
    "Spin",
    "Wait",
]
