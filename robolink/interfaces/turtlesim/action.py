"""The action of turtlesim: turning to a heading."""

from robolink.message import Action, Message, float32


class RotateAbsolute(Action):
    """Turn a turtle to a heading."""

    class Goal(Message):
        """The heading, in radians."""

        theta: float32

    class Result(Message):
        """The angle turned, in radians."""

        delta: float32

    class Feedback(Message):
        """The angle that is left, in radians."""

        remaining: float32
