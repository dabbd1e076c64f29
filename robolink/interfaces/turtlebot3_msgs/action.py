"""The action of turtlebot3_msgs: a patrol."""

from robolink.interfaces.geometry_msgs.msg import Vector3
from robolink.message import Action, Message, string


class Patrol(Action):
    """Patrol along a shape."""

    class Goal(Message):
        """The shape: `x` is its kind, 1 for a square and 2 for a triangle; `y` its length in metres; `z` how often."""

        goal: Vector3

    class Result(Message):
        """Words for people."""

        result: string

    class Feedback(Message):
        """Words for people about what the robot is at."""

        state: string
