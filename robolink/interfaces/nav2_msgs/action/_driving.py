"""Driving to poses and along paths."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geographic_msgs.msg import GeoPose
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs.msg import MissedWaypoint
from robolink.interfaces.nav_msgs.msg import Path
from robolink.interfaces.std_msgs.msg import Empty
from robolink.message import Action, Message, Sequence, float32, int16, string, uint16, uint32


class NavigateToPose(Action):
    """Drive to a pose."""

    class Goal(Message):
        """The pose, and the XML file of the behaviour tree to use; an empty name is the usual one."""

        pose: PoseStamped
        behavior_tree: string

    class Result(Message):
        """NONE, or why the goal was not reached: a code and, in `error_msg`, words for people."""

        NONE: ClassVar[uint16] = 0

        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Progress: the time since the start, the time and the metres that are left, both as estimated.

        `number_of_recoveries` counts how often the robot was stuck and had to try something else.
        """

        current_pose: PoseStamped
        navigation_time: Duration
        estimated_time_remaining: Duration
        number_of_recoveries: int16
        distance_remaining: float32


class NavigateThroughPoses(Action):
    """Drive through poses to the last of them."""

    class Goal(Message):
        """The poses in their order, and the XML file of the behaviour tree to use; an empty name is the usual one."""

        poses: Sequence[PoseStamped]
        behavior_tree: string

    class Result(Message):
        """NONE, or why the goal was not reached: a code and, in `error_msg`, words for people."""

        NONE: ClassVar[uint16] = 0

        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """As for NavigateToPose, and how many poses are left."""

        current_pose: PoseStamped
        navigation_time: Duration
        estimated_time_remaining: Duration
        number_of_recoveries: int16
        distance_remaining: float32
        number_of_poses_remaining: int16


class FollowWaypoints(Action):
    """Drive to poses one after the other, with a task to do at each."""

    class Goal(Message):
        """The poses, from which one to begin, and how many more times to go through all of them."""

        number_of_loops: uint32
        goal_index: uint32 = 0
        poses: Sequence[PoseStamped]

    class Result(Message):
        """The waypoints that were missed, and why."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 600
        TASK_EXECUTOR_FAILED: ClassVar[uint16] = 601

        missed_waypoints: Sequence[MissedWaypoint]
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The place in the list of the waypoint that the robot is on its way to."""

        current_waypoint: uint32


class FollowGPSWaypoints(Action):
    """Drive to positions on the Earth one after the other."""

    class Goal(Message):
        """The poses, from which one to begin, and how many more times to go through all of them."""

        number_of_loops: uint32
        goal_index: uint32 = 0
        gps_poses: Sequence[GeoPose]

    class Result(Message):
        """The waypoints that were missed, and why."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 600
        TASK_EXECUTOR_FAILED: ClassVar[uint16] = 601

        missed_waypoints: Sequence[MissedWaypoint]
        error_code: int16
        error_msg: string

    class Feedback(Message):
        """The place in the list of the waypoint that the robot is on its way to."""

        current_waypoint: uint32


class FollowPath(Action):
    """Follow a path with a controller."""

    class Goal(Message):
        """The path, and the names of the controller and the checkers to use; an empty name takes the usual one."""

        path: Path
        controller_id: string
        goal_checker_id: string
        progress_checker_id: string

    class Result(Message):
        """NONE, or why the end was not reached; words for people are in `error_msg`."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 100
        INVALID_CONTROLLER: ClassVar[uint16] = 101
        TF_ERROR: ClassVar[uint16] = 102
        INVALID_PATH: ClassVar[uint16] = 103
        PATIENCE_EXCEEDED: ClassVar[uint16] = 104
        FAILED_TO_MAKE_PROGRESS: ClassVar[uint16] = 105
        NO_VALID_CONTROL: ClassVar[uint16] = 106
        CONTROLLER_TIMED_OUT: ClassVar[uint16] = 107

        result: Empty
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Metres to the goal, and the speed in m/s."""

        distance_to_goal: float32
        speed: float32


class FollowObject(Action):
    """Follow an object."""

    class Goal(Message):
        """Topic of the object's pose, or its frame, and for how long to follow it."""

        pose_topic: string
        tracked_frame: string
        max_duration: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        TF_ERROR: ClassVar[uint16] = 901
        FAILED_TO_DETECT_OBJECT: ClassVar[uint16] = 902
        FAILED_TO_CONTROL: ClassVar[uint16] = 903
        TIMEOUT: ClassVar[uint16] = 904
        UNKNOWN: ClassVar[uint16] = 999

        total_elapsed_time: Duration
        error_code: uint16 = 0
        num_retries: uint16 = 0
        error_msg: string

    class Feedback(Message):
        """State of the following, for how long, and the number of attempts."""

        NONE: ClassVar[uint16] = 0
        INITIAL_PERCEPTION: ClassVar[uint16] = 1
        CONTROLLING: ClassVar[uint16] = 2
        STOPPING: ClassVar[uint16] = 3
        RETRY: ClassVar[uint16] = 4

        state: uint16
        following_time: Duration
        num_retries: uint16 = 0
