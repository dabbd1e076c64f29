"""The actions of control_msgs: moving joints, grippers and heads."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.control_msgs.msg import GripperCommand as GripperCommandMessage
from robolink.interfaces.control_msgs.msg import JointComponentTolerance, JointTolerance, MotionPrimitiveSequence
from robolink.interfaces.geometry_msgs.msg import PointStamped, Vector3
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.trajectory_msgs.msg import JointTrajectory as JointTrajectoryMessage
from robolink.interfaces.trajectory_msgs.msg import (
    JointTrajectoryPoint,
    MultiDOFJointTrajectory,
    MultiDOFJointTrajectoryPoint,
)
from robolink.message import Action, Message, Sequence, float64, int32, string, uint8


class FollowJointTrajectory(Action):
    """Move joints along a trajectory."""

    class Goal(Message):
        """The trajectory, and how far the joints may be from it.

        A joint that leaves `path_tolerance` on the way ends the action with PATH_TOLERANCE_VIOLATED. At the end all
        joints must be within `goal_tolerance`, at the latest `goal_time_tolerance` after the trajectory's own end;
        otherwise it is GOAL_TOLERANCE_VIOLATED. What is not given is the controller's own. `multi_dof_trajectory` and
        the component tolerances are for joints with several degrees of freedom.
        """

        trajectory: JointTrajectoryMessage
        multi_dof_trajectory: MultiDOFJointTrajectory
        path_tolerance: Sequence[JointTolerance]
        component_path_tolerance: Sequence[JointComponentTolerance]
        goal_tolerance: Sequence[JointTolerance]
        component_goal_tolerance: Sequence[JointComponentTolerance]
        goal_time_tolerance: Duration

    class Result(Message):
        """Outcome: SUCCESSFUL, or the kind of failure, with words for people in `error_string`."""

        SUCCESSFUL: ClassVar[int32] = 0
        INVALID_GOAL: ClassVar[int32] = -1
        INVALID_JOINTS: ClassVar[int32] = -2
        OLD_HEADER_TIMESTAMP: ClassVar[int32] = -3
        PATH_TOLERANCE_VIOLATED: ClassVar[int32] = -4
        GOAL_TOLERANCE_VIOLATED: ClassVar[int32] = -5

        error_code: int32
        error_string: string

    class Feedback(Message):
        """Wanted and actual state of the joints, and the first less the second; times count from the start."""

        header: Header
        joint_names: Sequence[string]
        desired: JointTrajectoryPoint
        actual: JointTrajectoryPoint
        error: JointTrajectoryPoint
        multi_dof_joint_names: Sequence[string]
        multi_dof_desired: MultiDOFJointTrajectoryPoint
        multi_dof_actual: MultiDOFJointTrajectoryPoint
        multi_dof_error: MultiDOFJointTrajectoryPoint


class JointTrajectory(Action):
    """Move joints along a trajectory; nothing is reported."""

    class Goal(Message):
        """The trajectory."""

        trajectory: JointTrajectoryMessage

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """Nothing."""


class GripperCommand(Action):
    """Open or close a gripper."""

    class Goal(Message):
        """Width and force."""

        command: GripperCommandMessage

    class Result(Message):
        """Width of the gripper's opening, in metres, and its force, in newtons.

        `reached_goal` is True where it is as wide as wanted, `stalled` where it presses as hard as it may and does
        not move.
        """

        position: float64
        effort: float64
        stalled: bool
        reached_goal: bool

    class Feedback(Message):
        """The same, on the way."""

        position: float64
        effort: float64
        stalled: bool
        reached_goal: bool


class ParallelGripperCommand(Action):
    """Open or close a gripper, by its joints."""

    class Goal(Message):
        """The joints' positions in radians or metres; velocities and efforts, where given, are limits."""

        command: JointState

    class Result(Message):
        """The joints as they are now.

        `reached_goal` is True where they are as wanted, `stalled` where the gripper presses as hard as it may and
        does not move.
        """

        state: JointState
        stalled: bool
        reached_goal: bool

    class Feedback(Message):
        """The joints as they are now."""

        state: JointState


class PointHead(Action):
    """Turn a head to look at a point."""

    class Goal(Message):
        """The point to look at, in metres in the frame of its header.

        `pointing_axis` of the frame `pointing_frame` (of a camera, say) is turned towards it, in no less than
        `min_duration` and no faster than `max_velocity` rad/s; zeros set no limit.
        """

        target: PointStamped
        pointing_axis: Vector3
        pointing_frame: string
        min_duration: Duration
        max_velocity: float64

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """Angle by which the axis is off, in radians."""

        pointing_angle_error: float64


class SingleJointPosition(Action):
    """Move one joint."""

    class Goal(Message):
        """To a position in radians or metres.

        It takes no less than `min_duration`, and is no faster than `max_velocity` rad/s or m/s; zeros set no limit.
        """

        position: float64
        min_duration: Duration
        max_velocity: float64

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """Position of the joint, its velocity, and its error."""

        header: Header
        position: float64
        velocity: float64
        error: float64


class ExecuteMotionPrimitiveSequence(Action):
    """Run motions one after the other."""

    class Goal(Message):
        """The motions."""

        trajectory: MotionPrimitiveSequence

    class Result(Message):
        """Outcome: SUCCESSFUL, or the kind of failure, with words for people in `error_string`."""

        SUCCESSFUL: ClassVar[int32] = 0
        INVALID_GOAL: ClassVar[int32] = -1
        OLD_HEADER_TIMESTAMP: ClassVar[int32] = -3

        error_code: int32
        error_string: string

    class Feedback(Message):
        """The place in the list of the motion that runs now."""

        current_primitive_index: uint8
