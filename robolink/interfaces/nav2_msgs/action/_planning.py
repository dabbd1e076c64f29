"""Planning paths and routes, and following a route."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.nav2_msgs.msg import Route
from robolink.interfaces.nav_msgs.msg import Path
from robolink.message import Action, Message, Sequence, string, uint16


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


class SmoothPath(Action):
    """Smooth a path."""

    class Goal(Message):
        """The path, the name of the smoother (an empty one takes the usual), and the time that it may take."""

        path: Path
        smoother_id: string
        max_smoothing_duration: Duration
        check_for_collisions: bool

    class Result(Message):
        """The smoother path, whether the smoother came to its end, and the time that it took, or why there is none."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 500
        INVALID_SMOOTHER: ClassVar[uint16] = 501
        TIMEOUT: ClassVar[uint16] = 502
        SMOOTHED_PATH_IN_COLLISION: ClassVar[uint16] = 503
        FAILED_TO_SMOOTH_PATH: ClassVar[uint16] = 504
        INVALID_PATH: ClassVar[uint16] = 505

        path: Path
        smoothing_duration: Duration
        was_completed: bool
        error_code: uint16
        error_msg: string

    class Feedback(Message):
        """Nothing."""


class ComputeRoute(Action):
    """Find a route through the graph."""

    class Goal(Message):
        """Start and goal, as poses (`use_poses`) or as numbers of nodes.

        The route begins at `start` if `use_start`, otherwise where the robot is.
        """

        start_id: uint16
        start: PoseStamped
        goal_id: uint16
        goal: PoseStamped
        use_start: bool
        use_poses: bool

    class Result(Message):
        """Route and path, and the time that they took to find, or why there are none."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 400
        TF_ERROR: ClassVar[uint16] = 401
        NO_VALID_GRAPH: ClassVar[uint16] = 402
        INDETERMINANT_NODES_ON_GRAPH: ClassVar[uint16] = 403
        TIMEOUT: ClassVar[uint16] = 404
        NO_VALID_ROUTE: ClassVar[uint16] = 405
        INVALID_EDGE_SCORER_USE: ClassVar[uint16] = 407

        planning_time: Duration
        path: Path
        route: Route
        error_code: uint16 = 0

    class Feedback(Message):
        """Nothing."""


class ComputeAndTrackRoute(Action):
    """Find a route through the graph and report the robot's progress on it."""

    class Goal(Message):
        """Start and goal, as poses (`use_poses`) or as numbers of nodes.

        The route begins at `start` if `use_start`, otherwise where the robot is.
        """

        start_id: uint16
        start: PoseStamped
        goal_id: uint16
        goal: PoseStamped
        use_start: bool
        use_poses: bool

    class Result(Message):
        """Outcome: NONE or the kind of failure, and the time that it took."""

        NONE: ClassVar[uint16] = 0
        UNKNOWN: ClassVar[uint16] = 400
        TF_ERROR: ClassVar[uint16] = 401
        NO_VALID_GRAPH: ClassVar[uint16] = 402
        INDETERMINANT_NODES_ON_GRAPH: ClassVar[uint16] = 403
        TIMEOUT: ClassVar[uint16] = 404
        NO_VALID_ROUTE: ClassVar[uint16] = 405
        OPERATION_FAILED: ClassVar[uint16] = 406
        INVALID_EDGE_SCORER_USE: ClassVar[uint16] = 407

        execution_duration: Duration
        error_code: uint16 = 0

    class Feedback(Message):
        """Progress: the nodes behind and before the robot, the edge between them, the route, and what was triggered."""

        last_node_id: uint16
        next_node_id: uint16
        current_edge_id: uint16
        route: Route
        path: Path
        operations_triggered: Sequence[string]
        rerouted: bool
