# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.geometry_msgs.msg

__all__ = ["Patrol"]

class Patrol(robolink.message.Action):
    """Patrol along a shape.

    The shape: `x` is its kind, 1 for a square and 2 for a triangle; `y` its length in metres; `z` how often.
    """
    class Goal(robolink.message.Message):
        goal: robolink.interfaces.geometry_msgs.msg.Vector3
        def __init__(self, *, goal: robolink.interfaces.geometry_msgs.msg.Vector3 = ...) -> None: ...
    class Result(robolink.message.Message):
        """Words for people."""
        result: builtins.str
        def __init__(self, *, result: builtins.str = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """Words for people about what the robot is at."""
        state: builtins.str
        def __init__(self, *, state: builtins.str = ...) -> None: ...
