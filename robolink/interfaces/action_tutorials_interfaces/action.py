"""The action of action_tutorials_interfaces, which the ROS 2 tutorials use."""

from robolink.message import Action, Message, Sequence, int32


class Fibonacci(Action):
    """Compute Fibonacci numbers, slowly."""

    class Goal(Message):
        """Index of the last number, where the sequence begins 0, 1, 1, 2."""

        order: int32

    class Result(Message):
        """All numbers."""

        sequence: Sequence[int32]

    class Feedback(Message):
        """The numbers so far."""

        partial_sequence: Sequence[int32]
