# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["RotateAbsolute"]

class RotateAbsolute(robolink.message.Action):
    """Turn a turtle to a heading.

    The heading, in radians.
    """
    class Goal(robolink.message.Message):
        theta: builtins.float
        def __init__(self, *, theta: builtins.float = ...) -> None: ...
    class Result(robolink.message.Message):
        """The angle turned, in radians."""
        delta: builtins.float
        def __init__(self, *, delta: builtins.float = ...) -> None: ...
    class Feedback(robolink.message.Message):
        """The angle that is left, in radians."""
        remaining: builtins.float
        def __init__(self, *, remaining: builtins.float = ...) -> None: ...
