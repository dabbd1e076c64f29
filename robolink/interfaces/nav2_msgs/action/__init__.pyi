# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geographic_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.nav2_msgs.msg
import robolink.interfaces.nav_msgs.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["AssistedTeleop", "BackUp", "ComputeAndTrackRoute", "ComputePathThroughPoses", "ComputePathToPose", "ComputeRoute", "DockRobot", "DriveOnHeading", "DummyBehavior", "FollowGPSWaypoints", "FollowObject", "FollowPath", "FollowWaypoints", "NavigateThroughPoses", "NavigateToPose", "SmoothPath", "Spin", "UndockRobot", "Wait"]

class AssistedTeleop(robolink.message.Action):
    """Drive by hand, with stops before collisions.

    The time to give up after.
    """
    class Goal(robolink.message.Message):
        time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The time since the start."""
        current_teleop_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, current_teleop_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class BackUp(robolink.message.Action):
    """Drive backwards.

    Distance back (`x` of the target, in metres), speed (m/s), and the time to give up after.
    """
    class Goal(robolink.message.Message):
        target: robolink.interfaces.geometry_msgs.msg.Point
        speed: builtins.float
        time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, target: robolink.interfaces.geometry_msgs.msg.Point = ..., speed: builtins.float = ..., time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        INVALID_INPUT: typing.ClassVar[builtins.int]
        COLLISION_AHEAD: typing.ClassVar[builtins.int]
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Metres driven so far."""
        distance_traveled: builtins.float
        def __init__(self, *, distance_traveled: builtins.float = ...) -> None: ...
class ComputeAndTrackRoute(robolink.message.Action):
    """Find a route through the graph and report the robot's progress on it.

    Start and goal, as poses (`use_poses`) or as numbers of nodes.

    The route begins at `start` if `use_start`, otherwise where the robot is.
    """
    class Goal(robolink.message.Message):
        start_id: builtins.int
        start: robolink.interfaces.geometry_msgs.msg.PoseStamped
        goal_id: builtins.int
        goal: robolink.interfaces.geometry_msgs.msg.PoseStamped
        use_start: builtins.bool
        use_poses: builtins.bool
        def __init__(self, *, start_id: builtins.int = ..., start: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., goal_id: builtins.int = ..., goal: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., use_start: builtins.bool = ..., use_poses: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        NO_VALID_GRAPH: typing.ClassVar[builtins.int]
        INDETERMINANT_NODES_ON_GRAPH: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        NO_VALID_ROUTE: typing.ClassVar[builtins.int]
        OPERATION_FAILED: typing.ClassVar[builtins.int]
        INVALID_EDGE_SCORER_USE: typing.ClassVar[builtins.int]
        execution_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        def __init__(self, *, execution_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Progress: the nodes behind and before the robot, the edge between them, the route, and what was triggered."""
        last_node_id: builtins.int
        next_node_id: builtins.int
        current_edge_id: builtins.int
        route: robolink.interfaces.nav2_msgs.msg.Route
        path: robolink.interfaces.nav_msgs.msg.Path
        operations_triggered: collections.abc.MutableSequence[builtins.str]
        rerouted: builtins.bool
        def __init__(self, *, last_node_id: builtins.int = ..., next_node_id: builtins.int = ..., current_edge_id: builtins.int = ..., route: robolink.interfaces.nav2_msgs.msg.Route = ..., path: robolink.interfaces.nav_msgs.msg.Path = ..., operations_triggered: collections.abc.Iterable[builtins.str] = ..., rerouted: builtins.bool = ...) -> None: ...
class ComputePathThroughPoses(robolink.message.Action):
    """Plan a path through poses.

    The poses in their order, and the name of the planner; an empty one takes the usual.

    The path begins at `start` if `use_start`, otherwise where the robot is.
    """
    class Goal(robolink.message.Message):
        goals: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
        start: robolink.interfaces.geometry_msgs.msg.PoseStamped
        planner_id: builtins.str
        use_start: builtins.bool
        def __init__(self, *, goals: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ..., start: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., planner_id: builtins.str = ..., use_start: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """The path and the time that it took to plan, or why there is none."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        INVALID_PLANNER: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        START_OUTSIDE_MAP: typing.ClassVar[builtins.int]
        GOAL_OUTSIDE_MAP: typing.ClassVar[builtins.int]
        START_OCCUPIED: typing.ClassVar[builtins.int]
        GOAL_OCCUPIED: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        NO_VALID_PATH: typing.ClassVar[builtins.int]
        NO_VIAPOINTS_GIVEN: typing.ClassVar[builtins.int]
        path: robolink.interfaces.nav_msgs.msg.Path
        planning_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ..., planning_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class ComputePathToPose(robolink.message.Action):
    """Plan a path to a pose.

    The goal, and the name of the planner; an empty one takes the usual.

    The path begins at `start` if `use_start`, otherwise where the robot is.
    """
    class Goal(robolink.message.Message):
        goal: robolink.interfaces.geometry_msgs.msg.PoseStamped
        start: robolink.interfaces.geometry_msgs.msg.PoseStamped
        planner_id: builtins.str
        use_start: builtins.bool
        def __init__(self, *, goal: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., start: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., planner_id: builtins.str = ..., use_start: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """The path and the time that it took to plan, or why there is none."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        INVALID_PLANNER: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        START_OUTSIDE_MAP: typing.ClassVar[builtins.int]
        GOAL_OUTSIDE_MAP: typing.ClassVar[builtins.int]
        START_OCCUPIED: typing.ClassVar[builtins.int]
        GOAL_OCCUPIED: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        NO_VALID_PATH: typing.ClassVar[builtins.int]
        path: robolink.interfaces.nav_msgs.msg.Path
        planning_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ..., planning_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class ComputeRoute(robolink.message.Action):
    """Find a route through the graph.

    Start and goal, as poses (`use_poses`) or as numbers of nodes.

    The route begins at `start` if `use_start`, otherwise where the robot is.
    """
    class Goal(robolink.message.Message):
        start_id: builtins.int
        start: robolink.interfaces.geometry_msgs.msg.PoseStamped
        goal_id: builtins.int
        goal: robolink.interfaces.geometry_msgs.msg.PoseStamped
        use_start: builtins.bool
        use_poses: builtins.bool
        def __init__(self, *, start_id: builtins.int = ..., start: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., goal_id: builtins.int = ..., goal: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., use_start: builtins.bool = ..., use_poses: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """Route and path, and the time that they took to find, or why there are none."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        NO_VALID_GRAPH: typing.ClassVar[builtins.int]
        INDETERMINANT_NODES_ON_GRAPH: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        NO_VALID_ROUTE: typing.ClassVar[builtins.int]
        INVALID_EDGE_SCORER_USE: typing.ClassVar[builtins.int]
        planning_time: robolink.interfaces.builtin_interfaces.msg.Duration
        path: robolink.interfaces.nav_msgs.msg.Path
        route: robolink.interfaces.nav2_msgs.msg.Route
        error_code: builtins.int
        def __init__(self, *, planning_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., path: robolink.interfaces.nav_msgs.msg.Path = ..., route: robolink.interfaces.nav2_msgs.msg.Route = ..., error_code: builtins.int = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class DockRobot(robolink.message.Action):
    """Drive onto a dock.

    The dock, by its name or by pose and kind, and how to come near to it; times in seconds.
    """
    class Goal(robolink.message.Message):
        use_dock_id: builtins.bool
        dock_id: builtins.str
        dock_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        dock_type: builtins.str
        max_staging_time: builtins.float
        navigate_to_staging_pose: builtins.bool
        def __init__(self, *, use_dock_id: builtins.bool = ..., dock_id: builtins.str = ..., dock_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., dock_type: builtins.str = ..., max_staging_time: builtins.float = ..., navigate_to_staging_pose: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """Success or the kind of failure, and the number of attempts."""
        NONE: typing.ClassVar[builtins.int]
        DOCK_NOT_IN_DB: typing.ClassVar[builtins.int]
        DOCK_NOT_VALID: typing.ClassVar[builtins.int]
        FAILED_TO_STAGE: typing.ClassVar[builtins.int]
        FAILED_TO_DETECT_DOCK: typing.ClassVar[builtins.int]
        FAILED_TO_CONTROL: typing.ClassVar[builtins.int]
        FAILED_TO_CHARGE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        success: builtins.bool
        error_code: builtins.int
        num_retries: builtins.int
        error_msg: builtins.str
        def __init__(self, *, success: builtins.bool = ..., error_code: builtins.int = ..., num_retries: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """State of the docking, the time since its start, and the number of attempts."""
        NONE: typing.ClassVar[builtins.int]
        NAV_TO_STAGING_POSE: typing.ClassVar[builtins.int]
        INITIAL_PERCEPTION: typing.ClassVar[builtins.int]
        CONTROLLING: typing.ClassVar[builtins.int]
        WAIT_FOR_CHARGE: typing.ClassVar[builtins.int]
        RETRY: typing.ClassVar[builtins.int]
        state: builtins.int
        docking_time: robolink.interfaces.builtin_interfaces.msg.Duration
        num_retries: builtins.int
        def __init__(self, *, state: builtins.int = ..., docking_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., num_retries: builtins.int = ...) -> None: ...
class DriveOnHeading(robolink.message.Action):
    """Drive straight ahead.

    Distance (`x` of the target, in metres), speed (m/s), and the time to give up after.
    """
    class Goal(robolink.message.Message):
        target: robolink.interfaces.geometry_msgs.msg.Point
        speed: builtins.float
        time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, target: robolink.interfaces.geometry_msgs.msg.Point = ..., speed: builtins.float = ..., time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        COLLISION_AHEAD: typing.ClassVar[builtins.int]
        INVALID_INPUT: typing.ClassVar[builtins.int]
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Metres driven so far."""
        distance_traveled: builtins.float
        def __init__(self, *, distance_traveled: builtins.float = ...) -> None: ...
class DummyBehavior(robolink.message.Action):
    """Do nothing: Nav2's tests use it.

    Words to react to.
    """
    class Goal(robolink.message.Message):
        command: robolink.interfaces.std_msgs.msg.String
        def __init__(self, *, command: robolink.interfaces.std_msgs.msg.String = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome, and the time that it took."""
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class FollowGPSWaypoints(robolink.message.Action):
    """Drive to positions on the Earth one after the other.

    The poses, from which one to begin, and how many more times to go through all of them.
    """
    class Goal(robolink.message.Message):
        number_of_loops: builtins.int
        goal_index: builtins.int
        gps_poses: collections.abc.MutableSequence[robolink.interfaces.geographic_msgs.msg.GeoPose]
        def __init__(self, *, number_of_loops: builtins.int = ..., goal_index: builtins.int = ..., gps_poses: collections.abc.Iterable[robolink.interfaces.geographic_msgs.msg.GeoPose] = ...) -> None: ...
    class Result(robolink.message.Message):
        """The waypoints that were missed, and why."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TASK_EXECUTOR_FAILED: typing.ClassVar[builtins.int]
        missed_waypoints: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.MissedWaypoint]
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, missed_waypoints: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.MissedWaypoint] = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The place in the list of the waypoint that the robot is on its way to."""
        current_waypoint: builtins.int
        def __init__(self, *, current_waypoint: builtins.int = ...) -> None: ...
class FollowObject(robolink.message.Action):
    """Follow an object.

    Topic of the object's pose, or its frame, and for how long to follow it.
    """
    class Goal(robolink.message.Message):
        pose_topic: builtins.str
        tracked_frame: builtins.str
        max_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, pose_topic: builtins.str = ..., tracked_frame: builtins.str = ..., max_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        FAILED_TO_DETECT_OBJECT: typing.ClassVar[builtins.int]
        FAILED_TO_CONTROL: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        num_retries: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., num_retries: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """State of the following, for how long, and the number of attempts."""
        NONE: typing.ClassVar[builtins.int]
        INITIAL_PERCEPTION: typing.ClassVar[builtins.int]
        CONTROLLING: typing.ClassVar[builtins.int]
        STOPPING: typing.ClassVar[builtins.int]
        RETRY: typing.ClassVar[builtins.int]
        state: builtins.int
        following_time: robolink.interfaces.builtin_interfaces.msg.Duration
        num_retries: builtins.int
        def __init__(self, *, state: builtins.int = ..., following_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., num_retries: builtins.int = ...) -> None: ...
class FollowPath(robolink.message.Action):
    """Follow a path with a controller.

    The path, and the names of the controller and the checkers to use; an empty name takes the usual one.
    """
    class Goal(robolink.message.Message):
        path: robolink.interfaces.nav_msgs.msg.Path
        controller_id: builtins.str
        goal_checker_id: builtins.str
        progress_checker_id: builtins.str
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ..., controller_id: builtins.str = ..., goal_checker_id: builtins.str = ..., progress_checker_id: builtins.str = ...) -> None: ...
    class Result(robolink.message.Message):
        """NONE, or why the end was not reached; words for people are in `error_msg`."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        INVALID_CONTROLLER: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        INVALID_PATH: typing.ClassVar[builtins.int]
        PATIENCE_EXCEEDED: typing.ClassVar[builtins.int]
        FAILED_TO_MAKE_PROGRESS: typing.ClassVar[builtins.int]
        NO_VALID_CONTROL: typing.ClassVar[builtins.int]
        CONTROLLER_TIMED_OUT: typing.ClassVar[builtins.int]
        result: robolink.interfaces.std_msgs.msg.Empty
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, result: robolink.interfaces.std_msgs.msg.Empty = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Metres to the goal, and the speed in m/s."""
        distance_to_goal: builtins.float
        speed: builtins.float
        def __init__(self, *, distance_to_goal: builtins.float = ..., speed: builtins.float = ...) -> None: ...
class FollowWaypoints(robolink.message.Action):
    """Drive to poses one after the other, with a task to do at each.

    The poses, from which one to begin, and how many more times to go through all of them.
    """
    class Goal(robolink.message.Message):
        number_of_loops: builtins.int
        goal_index: builtins.int
        poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
        def __init__(self, *, number_of_loops: builtins.int = ..., goal_index: builtins.int = ..., poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ...) -> None: ...
    class Result(robolink.message.Message):
        """The waypoints that were missed, and why."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TASK_EXECUTOR_FAILED: typing.ClassVar[builtins.int]
        missed_waypoints: collections.abc.MutableSequence[robolink.interfaces.nav2_msgs.msg.MissedWaypoint]
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, missed_waypoints: collections.abc.Iterable[robolink.interfaces.nav2_msgs.msg.MissedWaypoint] = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The place in the list of the waypoint that the robot is on its way to."""
        current_waypoint: builtins.int
        def __init__(self, *, current_waypoint: builtins.int = ...) -> None: ...
class NavigateThroughPoses(robolink.message.Action):
    """Drive through poses to the last of them.

    The poses in their order, and the XML file of the behaviour tree to use; an empty name is the usual one.
    """
    class Goal(robolink.message.Message):
        poses: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.PoseStamped]
        behavior_tree: builtins.str
        def __init__(self, *, poses: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.PoseStamped] = ..., behavior_tree: builtins.str = ...) -> None: ...
    class Result(robolink.message.Message):
        """NONE, or why the goal was not reached: a code and, in `error_msg`, words for people."""
        NONE: typing.ClassVar[builtins.int]
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """As for NavigateToPose, and how many poses are left."""
        current_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        navigation_time: robolink.interfaces.builtin_interfaces.msg.Duration
        estimated_time_remaining: robolink.interfaces.builtin_interfaces.msg.Duration
        number_of_recoveries: builtins.int
        distance_remaining: builtins.float
        number_of_poses_remaining: builtins.int
        def __init__(self, *, current_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., navigation_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., estimated_time_remaining: robolink.interfaces.builtin_interfaces.msg.Duration = ..., number_of_recoveries: builtins.int = ..., distance_remaining: builtins.float = ..., number_of_poses_remaining: builtins.int = ...) -> None: ...
class NavigateToPose(robolink.message.Action):
    """Drive to a pose.

    The pose, and the XML file of the behaviour tree to use; an empty name is the usual one.
    """
    class Goal(robolink.message.Message):
        pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        behavior_tree: builtins.str
        def __init__(self, *, pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., behavior_tree: builtins.str = ...) -> None: ...
    class Result(robolink.message.Message):
        """NONE, or why the goal was not reached: a code and, in `error_msg`, words for people."""
        NONE: typing.ClassVar[builtins.int]
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Progress: the time since the start, the time and the metres that are left, both as estimated.

        `number_of_recoveries` counts how often the robot was stuck and had to try something else.
        """
        current_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped
        navigation_time: robolink.interfaces.builtin_interfaces.msg.Duration
        estimated_time_remaining: robolink.interfaces.builtin_interfaces.msg.Duration
        number_of_recoveries: builtins.int
        distance_remaining: builtins.float
        def __init__(self, *, current_pose: robolink.interfaces.geometry_msgs.msg.PoseStamped = ..., navigation_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., estimated_time_remaining: robolink.interfaces.builtin_interfaces.msg.Duration = ..., number_of_recoveries: builtins.int = ..., distance_remaining: builtins.float = ...) -> None: ...
class SmoothPath(robolink.message.Action):
    """Smooth a path.

    The path, the name of the smoother (an empty one takes the usual), and the time that it may take.
    """
    class Goal(robolink.message.Message):
        path: robolink.interfaces.nav_msgs.msg.Path
        smoother_id: builtins.str
        max_smoothing_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        check_for_collisions: builtins.bool
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ..., smoother_id: builtins.str = ..., max_smoothing_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., check_for_collisions: builtins.bool = ...) -> None: ...
    class Result(robolink.message.Message):
        """The smoother path, whether the smoother came to its end, and the time that it took, or why there is none."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        INVALID_SMOOTHER: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        SMOOTHED_PATH_IN_COLLISION: typing.ClassVar[builtins.int]
        FAILED_TO_SMOOTH_PATH: typing.ClassVar[builtins.int]
        INVALID_PATH: typing.ClassVar[builtins.int]
        path: robolink.interfaces.nav_msgs.msg.Path
        smoothing_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        was_completed: builtins.bool
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, path: robolink.interfaces.nav_msgs.msg.Path = ..., smoothing_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., was_completed: builtins.bool = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Spin(robolink.message.Action):
    """Turn on the spot.

    By how much, in radians, and the time to give up after.
    """
    class Goal(robolink.message.Message):
        target_yaw: builtins.float
        time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, target_yaw: builtins.float = ..., time_allowance: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: NONE or the kind of failure, with words for people in `error_msg`, and the time that it took."""
        NONE: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        TIMEOUT: typing.ClassVar[builtins.int]
        TF_ERROR: typing.ClassVar[builtins.int]
        COLLISION_AHEAD: typing.ClassVar[builtins.int]
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The angle turned so far, in radians."""
        angular_distance_traveled: builtins.float
        def __init__(self, *, angular_distance_traveled: builtins.float = ...) -> None: ...
class UndockRobot(robolink.message.Action):
    """Drive off a dock.

    Kind of the dock, and the time in seconds to give up after.
    """
    class Goal(robolink.message.Message):
        dock_type: builtins.str
        max_undocking_time: builtins.float
        def __init__(self, *, dock_type: builtins.str = ..., max_undocking_time: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Success or the kind of failure."""
        NONE: typing.ClassVar[builtins.int]
        DOCK_NOT_VALID: typing.ClassVar[builtins.int]
        FAILED_TO_CONTROL: typing.ClassVar[builtins.int]
        UNKNOWN: typing.ClassVar[builtins.int]
        success: builtins.bool
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, success: builtins.bool = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class Wait(robolink.message.Action):
    """Stand still for a while.

    Length of the wait.
    """
    class Goal(robolink.message.Message):
        time: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, time: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome, and the length of the wait."""
        total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration
        error_code: builtins.int
        error_msg: builtins.str
        def __init__(self, *, total_elapsed_time: robolink.interfaces.builtin_interfaces.msg.Duration = ..., error_code: builtins.int = ..., error_msg: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The time that is left."""
        time_left: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, time_left: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
