"""The services of webots_ros2_msgs: emitters, and things to add to the world."""

from robolink.interfaces.webots_ros2_msgs.msg import UrdfRobot
from robolink.message import Message, Service, int64, string


class EmitterSendString(Service):
    """Send a text by an emitter."""

    class Request(Message):
        """The text."""

        value: string

    class Response(Message):
        """1 if the text was sent, 0 if the queue was full."""

        result: int64


class GetBool(Service):
    """Ask a question that has a truth value for an answer."""

    class Request(Message):
        """Ignored."""

        ask: bool

    class Response(Message):
        """The answer."""

        value: bool


class SetString(Service):
    """Set a text."""

    class Request(Message):
        """The text."""

        value: string

    class Response(Message):
        """Success."""

        success: bool


class SpawnNodeFromString(Service):
    """Add a node to the world."""

    class Request(Message):
        """The node, written as in a world file."""

        data: string

    class Response(Message):
        """Success."""

        success: bool


class SpawnUrdfRobot(Service):
    """Add a robot to the world, made from a URDF."""

    class Request(Message):
        """The robot."""

        robot: UrdfRobot

    class Response(Message):
        """Success."""

        success: bool
