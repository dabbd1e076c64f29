"""The services of irobot_create_msgs: emergency stop, power, and the pose of odometry."""

from robolink.interfaces.geometry_msgs.msg import Pose
from robolink.message import Message, Service, string


class EStop(Service):
    """Stop the motors in an emergency, or release them."""

    class Request(Message):
        """True cuts the motors' power, False returns it."""

        e_stop_on: bool

    class Response(Message):
        """Success, and words for people, above all after a failure."""

        success: bool
        message: string


class ResetPose(Service):
    """Set the pose of odometry."""

    class Request(Message):
        """The pose that the robot has from now on."""

        pose: Pose

    class Response(Message):
        """Nothing."""


class RobotPower(Service):
    """Switch the robot off."""

    class Request(Message):
        """Nothing."""

    class Response(Message):
        """Success and words for people; the robot may be off before they are sent."""

        success: bool
        message: string
