"""The actions of nav2_msgs: drive to poses, plan and follow paths, dock, and the small movements of recoveries."""

from robolink.interfaces.nav2_msgs.action._behaviors import (
    AssistedTeleop,
    BackUp,
    DriveOnHeading,
    DummyBehavior,
    Spin,
    Wait,
)
from robolink.interfaces.nav2_msgs.action._docking import DockRobot, UndockRobot
from robolink.interfaces.nav2_msgs.action._driving import (
    FollowGPSWaypoints,
    FollowObject,
    FollowPath,
    FollowWaypoints,
    NavigateThroughPoses,
    NavigateToPose,
)
from robolink.interfaces.nav2_msgs.action._planning import (
    ComputeAndTrackRoute,
    ComputePathThroughPoses,
    ComputePathToPose,
    ComputeRoute,
    SmoothPath,
)

__all__ = [
    "AssistedTeleop",
    "BackUp",
    "ComputeAndTrackRoute",
    "ComputePathThroughPoses",
    "ComputePathToPose",
    "ComputeRoute",
    "DockRobot",
    "DriveOnHeading",
    "DummyBehavior",
    "FollowGPSWaypoints",
    "FollowObject",
    "FollowPath",
    "FollowWaypoints",
    "NavigateThroughPoses",
    "NavigateToPose",
    "SmoothPath",
    "Spin",
    "UndockRobot",
    "Wait",
]
