"""The actions of nav2_msgs: driving to poses, following paths, and the small movements of recoveries."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import Point, PoseStamped
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


class ComputePathToPose(Action):
    """Plan a path to a pose."""

    class Goal(Message):
        """The goal, and the name of the planner; an empty one takes the usual.

        The path begins at `start` if `use_start`, otherwise where the robot is.
        """

        goal: PoseStamped
        start: PoseStamped
        planner_id: string
        use_start: bool

    class Result(Message):
        """The path and the time that it took to plan, or why there is none."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 200
        INVALID_PLANNER: ClassVar[uint16] = 201
        TF_ERROR: ClassVar[uint16] = 202
        START_OUTSIDE_MAP: ClassVar[uint16] = 203
        GOAL_OUTSIDE_MAP: ClassVar[uint16] = 204
        START_OCCUPIED: ClassVar[uint16] = 205
        GOAL_OCCUPIED: ClassVar[uint16] = 206
        TIMEOUT: ClassVar[uint16] = 207
        NO_VALID_PATH: ClassVar[uint16] = 208

        path: Path
        planning_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Nothing."""


class ComputePathThroughPoses(Action):
    """Plan a path through poses."""

    class Goal(Message):
        """The poses in their order, and the name of the planner; an empty one takes the usual.

        The path begins at `start` if `use_start`, otherwise where the robot is.
        """

        goals: Sequence[PoseStamped]
        start: PoseStamped
        planner_id: string
        use_start: bool

    class Result(Message):
        """The path and the time that it took to plan, or why there is none."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 300
        INVALID_PLANNER: ClassVar[uint16] = 301
        TF_ERROR: ClassVar[uint16] = 302
        START_OUTSIDE_MAP: ClassVar[uint16] = 303
        GOAL_OUTSIDE_MAP: ClassVar[uint16] = 304
        START_OCCUPIED: ClassVar[uint16] = 305
        GOAL_OCCUPIED: ClassVar[uint16] = 306
        TIMEOUT: ClassVar[uint16] = 307
        NO_VALID_PATH: ClassVar[uint16] = 308
        NO_VIAPOINTS_GIVEN: ClassVar[uint16] = 309

        path: Path
        planning_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Nothing."""


class Spin(Action):
    """Turn on the spot."""

    class Goal(Message):
        """By how much, in radians, and the time to give up after."""

        target_yaw: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 700
        TIMEOUT: ClassVar[uint16] = 701
        TF_ERROR: ClassVar[uint16] = 702
        COLLISION_AHEAD: ClassVar[uint16] = 703

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The angle turned so far, in radians."""

        angular_distance_traveled: float32


class BackUp(Action):
    """Drive backwards."""

    class Goal(Message):
        """Distance back (`x` of the target, in metres), speed (m/s), and the time to give up after."""

        target: Point
        speed: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 710
        TIMEOUT: ClassVar[uint16] = 711
        TF_ERROR: ClassVar[uint16] = 712
        INVALID_INPUT: ClassVar[uint16] = 713
        COLLISION_AHEAD: ClassVar[uint16] = 714

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Metres driven so far."""

        distance_traveled: float32


class DriveOnHeading(Action):
    """Drive straight ahead."""

    class Goal(Message):
        """Distance (`x` of the target, in metres), speed (m/s), and the time to give up after."""

        target: Point
        speed: float32
        time_allowance: Duration

    class Result(Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 720
        TIMEOUT: ClassVar[uint16] = 721
        TF_ERROR: ClassVar[uint16] = 722
        COLLISION_AHEAD: ClassVar[uint16] = 723
        INVALID_INPUT: ClassVar[uint16] = 724

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Metres driven so far."""

        distance_traveled: float32


class Wait(Action):
    """Stand still for a while."""

    class Goal(Message):
        """Length of the wait."""

        time: Duration

    class Result(Message):
        """Outcome, and the length of the wait."""

        total_elapsed_time: Duration
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """The time that is left."""

        time_left: Duration
