# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.control_msgs.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.sensor_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.trajectory_msgs.msg

__all__ = ["ExecuteMotionPrimitiveSequence", "FollowJointTrajectory", "GripperCommand", "JointTrajectory", "ParallelGripperCommand", "PointHead", "SingleJointPosition"]

class ExecuteMotionPrimitiveSequence(robolink.message.Action):
    """Run motions one after the other.

    The motions.
    """
    class Goal(robolink.message.Message):
        trajectory: robolink.interfaces.control_msgs.msg.MotionPrimitiveSequence
        def __init__(self, *, trajectory: robolink.interfaces.control_msgs.msg.MotionPrimitiveSequence = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: SUCCESSFUL, or the kind of failure, with words for people in `error_string`."""
        SUCCESSFUL: typing.ClassVar[builtins.int]
        INVALID_GOAL: typing.ClassVar[builtins.int]
        OLD_HEADER_TIMESTAMP: typing.ClassVar[builtins.int]
        error_code: builtins.int
        error_string: builtins.str
        def __init__(self, *, error_code: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The place in the list of the motion that runs now."""
        current_primitive_index: builtins.int
        def __init__(self, *, current_primitive_index: builtins.int = ...) -> None: ...
class FollowJointTrajectory(robolink.message.Action):
    """Move joints along a trajectory.

    The trajectory, and how far the joints may be from it.

    A joint that leaves `path_tolerance` on the way ends the action with PATH_TOLERANCE_VIOLATED. At the end all
    joints must be within `goal_tolerance`, at the latest `goal_time_tolerance` after the trajectory's own end;
    otherwise it is GOAL_TOLERANCE_VIOLATED. What is not given is the controller's own. `multi_dof_trajectory` and
    the component tolerances are for joints with several degrees of freedom.
    """
    class Goal(robolink.message.Message):
        trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory
        multi_dof_trajectory: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectory
        path_tolerance: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.JointTolerance]
        component_path_tolerance: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.JointComponentTolerance]
        goal_tolerance: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.JointTolerance]
        component_goal_tolerance: collections.abc.MutableSequence[robolink.interfaces.control_msgs.msg.JointComponentTolerance]
        goal_time_tolerance: robolink.interfaces.builtin_interfaces.msg.Duration
        def __init__(self, *, trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory = ..., multi_dof_trajectory: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectory = ..., path_tolerance: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.JointTolerance] = ..., component_path_tolerance: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.JointComponentTolerance] = ..., goal_tolerance: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.JointTolerance] = ..., component_goal_tolerance: collections.abc.Iterable[robolink.interfaces.control_msgs.msg.JointComponentTolerance] = ..., goal_time_tolerance: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
    class Result(robolink.message.Message):
        """Outcome: SUCCESSFUL, or the kind of failure, with words for people in `error_string`."""
        SUCCESSFUL: typing.ClassVar[builtins.int]
        INVALID_GOAL: typing.ClassVar[builtins.int]
        INVALID_JOINTS: typing.ClassVar[builtins.int]
        OLD_HEADER_TIMESTAMP: typing.ClassVar[builtins.int]
        PATH_TOLERANCE_VIOLATED: typing.ClassVar[builtins.int]
        GOAL_TOLERANCE_VIOLATED: typing.ClassVar[builtins.int]
        error_code: builtins.int
        error_string: builtins.str
        def __init__(self, *, error_code: builtins.int = ..., error_string: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Wanted and actual state of the joints, and the first less the second; times count from the start."""
        header: robolink.interfaces.std_msgs.msg.Header
        joint_names: collections.abc.MutableSequence[builtins.str]
        desired: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
        actual: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
        error: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint
        multi_dof_joint_names: collections.abc.MutableSequence[builtins.str]
        multi_dof_desired: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
        multi_dof_actual: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
        multi_dof_error: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint
        def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., desired: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., actual: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., error: robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint = ..., multi_dof_joint_names: collections.abc.Iterable[builtins.str] = ..., multi_dof_desired: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., multi_dof_actual: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ..., multi_dof_error: robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint = ...) -> None: ...
class GripperCommand(robolink.message.Action):
    """Open or close a gripper.

    Width and force.
    """
    class Goal(robolink.message.Message):
        command: robolink.interfaces.control_msgs.msg.GripperCommand
        def __init__(self, *, command: robolink.interfaces.control_msgs.msg.GripperCommand = ...) -> None: ...
    class Result(robolink.message.Message):
        """Width of the gripper's opening, in metres, and its force, in newtons.

        `reached_goal` is True where it is as wide as wanted, `stalled` where it presses as hard as it may and does
        not move.
        """
        position: builtins.float
        effort: builtins.float
        stalled: builtins.bool
        reached_goal: builtins.bool
        def __init__(self, *, position: builtins.float = ..., effort: builtins.float = ..., stalled: builtins.bool = ..., reached_goal: builtins.bool = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The same, on the way."""
        position: builtins.float
        effort: builtins.float
        stalled: builtins.bool
        reached_goal: builtins.bool
        def __init__(self, *, position: builtins.float = ..., effort: builtins.float = ..., stalled: builtins.bool = ..., reached_goal: builtins.bool = ...) -> None: ...
class JointTrajectory(robolink.message.Action):
    """Move joints along a trajectory; nothing is reported.

    The trajectory.
    """
    class Goal(robolink.message.Message):
        trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory
        def __init__(self, *, trajectory: robolink.interfaces.trajectory_msgs.msg.JointTrajectory = ...) -> None: ...
    class Result(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
    class Feedback(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
class ParallelGripperCommand(robolink.message.Action):
    """Open or close a gripper, by its joints.

    The joints' positions in radians or metres; velocities and efforts, where given, are limits.
    """
    class Goal(robolink.message.Message):
        command: robolink.interfaces.sensor_msgs.msg.JointState
        def __init__(self, *, command: robolink.interfaces.sensor_msgs.msg.JointState = ...) -> None: ...
    class Result(robolink.message.Message):
        """The joints as they are now.

        `reached_goal` is True where they are as wanted, `stalled` where the gripper presses as hard as it may and
        does not move.
        """
        state: robolink.interfaces.sensor_msgs.msg.JointState
        stalled: builtins.bool
        reached_goal: builtins.bool
        def __init__(self, *, state: robolink.interfaces.sensor_msgs.msg.JointState = ..., stalled: builtins.bool = ..., reached_goal: builtins.bool = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The joints as they are now."""
        state: robolink.interfaces.sensor_msgs.msg.JointState
        def __init__(self, *, state: robolink.interfaces.sensor_msgs.msg.JointState = ...) -> None: ...
class PointHead(robolink.message.Action):
    """Turn a head to look at a point.

    The point to look at, in metres in the frame of its header.

    `pointing_axis` of the frame `pointing_frame` (of a camera, say) is turned towards it, in no less than
    `min_duration` and no faster than `max_velocity` rad/s; zeros set no limit.
    """
    class Goal(robolink.message.Message):
        target: robolink.interfaces.geometry_msgs.msg.PointStamped
        pointing_axis: robolink.interfaces.geometry_msgs.msg.Vector3
        pointing_frame: builtins.str
        min_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        max_velocity: builtins.float
        def __init__(self, *, target: robolink.interfaces.geometry_msgs.msg.PointStamped = ..., pointing_axis: robolink.interfaces.geometry_msgs.msg.Vector3 = ..., pointing_frame: builtins.str = ..., min_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., max_velocity: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
    class Feedback(robolink.message.Message):
        """Angle by which the axis is off, in radians."""
        pointing_angle_error: builtins.float
        def __init__(self, *, pointing_angle_error: builtins.float = ...) -> None: ...
class SingleJointPosition(robolink.message.Action):
    """Move one joint.

    To a position in radians or metres.

    It takes no less than `min_duration`, and is no faster than `max_velocity` rad/s or m/s; zeros set no limit.
    """
    class Goal(robolink.message.Message):
        position: builtins.float
        min_duration: robolink.interfaces.builtin_interfaces.msg.Duration
        max_velocity: builtins.float
        def __init__(self, *, position: builtins.float = ..., min_duration: robolink.interfaces.builtin_interfaces.msg.Duration = ..., max_velocity: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """Nothing."""
        def __init__(self) -> None: ...
    class Feedback(robolink.message.Message):
        """Position of the joint, its velocity, and its error."""
        header: robolink.interfaces.std_msgs.msg.Header
        position: builtins.float
        velocity: builtins.float
        error: builtins.float
        def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., position: builtins.float = ..., velocity: builtins.float = ..., error: builtins.float = ...) -> None: ...
