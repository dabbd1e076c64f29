"""The services of control_msgs: asking and telling controllers."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import Message, Sequence, Service, float64, string


class QueryCalibrationState(Service):
    """Ask whether a robot is calibrated."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """True once it is."""

        is_calibrated: bool


class QueryTrajectoryState(Service):
    """Ask a joint trajectory controller where the joints should be at a time."""

    class Request(Message):
        """The time."""

        time: Time

    class Response(Message):
        """Success, and a sentence for people.

        For each joint of `name`: radians or metres, and these per second and per second².
        """

        success: bool
        message: string
        name: Sequence[string]
        position: Sequence[float64]
        velocity: Sequence[float64]
        acceleration: Sequence[float64]


class SetOdometry(Service):
    """Set the pose of a robot in its odometry."""

    class Request(Message):
        """The position in metres and the angles in radians."""

        x: float64
        y: float64
        z: float64
        roll: float64
        pitch: float64
        yaw: float64

    class Response(Message):
        """Success, and a sentence for people."""

        success: bool
        message: string
