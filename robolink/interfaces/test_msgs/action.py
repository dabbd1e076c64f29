"""The actions of test_msgs, for tests."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.test_msgs.msg import BasicTypes, Builtins
from robolink.message import Action, Message, Sequence, int32


class Fibonacci(Action):
    """Compute Fibonacci numbers."""

    class Goal(Message):
        """How far to go: the index of the last number."""

        order: int32

    class Result(Message):
        """All numbers."""

        sequence: Sequence[int32]

    class Feedback(Message):
        """The numbers so far."""

        sequence: Sequence[int32]


class NestedMessage(Action):
    """Messages of several packages in every part."""

    class Goal(Message):
        """Three messages."""

        nested_field_no_pkg: Builtins
        nested_field: BasicTypes
        nested_different_pkg: Time

    class Result(Message):
        """The same."""

        nested_field_no_pkg: Builtins
        nested_field: BasicTypes
        nested_different_pkg: Time

    class Feedback(Message):
        """The same."""

        nested_field_no_pkg: Builtins
        nested_field: BasicTypes
        nested_different_pkg: Time
