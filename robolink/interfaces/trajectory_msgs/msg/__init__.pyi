# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.geometry_msgs.msg
import robolink.interfaces.std_msgs.msg
import robolink.interfaces.trajectory_msgs.msg

__all__ = ["JointTrajectory", "JointTrajectoryPoint", "MultiDOFJointTrajectory", "MultiDOFJointTrajectoryPoint"]

class JointTrajectory(robolink.message.Message):
    """A motion of several joints through a row of points.

    The header's stamp is when it starts: zero means at once.
    """
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    points: collections.abc.MutableSequence[robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., points: collections.abc.Iterable[robolink.interfaces.trajectory_msgs.msg.JointTrajectoryPoint] = ...) -> None: ...
class JointTrajectoryPoint(robolink.message.Message):
    """Wanted state of a trajectory's joints at one moment, in the order of its `joint_names`.

    For a joint that turns, positions are in radians, velocities in rad/s, accelerations in rad/s² and effort in
    newton metres; for one that slides, in metres, m/s, m/s² and newtons. Give positions, and as well velocities,
    velocities and accelerations, or effort; what is not given stays empty. `time_from_start` counts from the start of
    the trajectory.
    """
    positions: collections.abc.MutableSequence[builtins.float]
    velocities: collections.abc.MutableSequence[builtins.float]
    accelerations: collections.abc.MutableSequence[builtins.float]
    effort: collections.abc.MutableSequence[builtins.float]
    time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration
    def __init__(self, *, positions: collections.abc.Iterable[builtins.float] = ..., velocities: collections.abc.Iterable[builtins.float] = ..., accelerations: collections.abc.Iterable[builtins.float] = ..., effort: collections.abc.Iterable[builtins.float] = ..., time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
class MultiDOFJointTrajectory(robolink.message.Message):
    """A motion of joints with several degrees of freedom, in the frame of the header."""
    header: robolink.interfaces.std_msgs.msg.Header
    joint_names: collections.abc.MutableSequence[builtins.str]
    points: collections.abc.MutableSequence[robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., joint_names: collections.abc.Iterable[builtins.str] = ..., points: collections.abc.Iterable[robolink.interfaces.trajectory_msgs.msg.MultiDOFJointTrajectoryPoint] = ...) -> None: ...
class MultiDOFJointTrajectoryPoint(robolink.message.Message):
    """Wanted state of joints with several degrees of freedom (planar, floating) at one moment.

    There is one element for each name in `joint_names`: the pose of the joint, its velocity (m/s, rad/s) and its
    acceleration (m/s², rad/s²). `time_from_start` counts from the start of the trajectory.
    """
    transforms: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Transform]
    velocities: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    accelerations: collections.abc.MutableSequence[robolink.interfaces.geometry_msgs.msg.Twist]
    time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration
    def __init__(self, *, transforms: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Transform] = ..., velocities: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ..., accelerations: collections.abc.Iterable[robolink.interfaces.geometry_msgs.msg.Twist] = ..., time_from_start: robolink.interfaces.builtin_interfaces.msg.Duration = ...) -> None: ...
