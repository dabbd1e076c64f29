"""The messages of trajectory_msgs: how joints shall move over time."""

from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import Transform, Twist
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float64, string


class JointTrajectoryPoint(Message):
    """Wanted state of a trajectory's joints at one moment, in the order of its `joint_names`.

    For a joint that turns, positions are in radians, velocities in rad/s, accelerations in rad/s² and effort in
    newton metres; for one that slides, in metres, m/s, m/s² and newtons. Give positions, and as well velocities,
    velocities and accelerations, or effort; what is not given stays empty. `time_from_start` counts from the start of
    the trajectory.
    """

    positions: Sequence[float64]
    velocities: Sequence[float64]
    accelerations: Sequence[float64]
    effort: Sequence[float64]
    time_from_start: Duration


class JointTrajectory(Message):
    """A motion of several joints through a row of points.

    The header's stamp is when it starts: zero means at once.
    """

    header: Header
    joint_names: Sequence[string]
    points: Sequence[JointTrajectoryPoint]


class MultiDOFJointTrajectoryPoint(Message):
    """Wanted state of joints with several degrees of freedom (planar, floating) at one moment.

    There is one element for each name in `joint_names`: the pose of the joint, its velocity (m/s, rad/s) and its
    acceleration (m/s², rad/s²). `time_from_start` counts from the start of the trajectory.
    """

    transforms: Sequence[Transform]
    velocities: Sequence[Twist]
    accelerations: Sequence[Twist]
    time_from_start: Duration


class MultiDOFJointTrajectory(Message):
    """A motion of joints with several degrees of freedom, in the frame of the header."""

    header: Header
    joint_names: Sequence[string]
    points: Sequence[MultiDOFJointTrajectoryPoint]
