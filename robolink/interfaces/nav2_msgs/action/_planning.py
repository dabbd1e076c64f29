"""Planning paths and routes, and following a route."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import PoseStamped
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
