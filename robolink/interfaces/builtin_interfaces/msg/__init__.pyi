# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Duration", "Time"]

class Duration(robolink.message.Message):
    """A span of time: `sec` seconds plus `nanosec` nanoseconds (0 to 999,999,999).

    Minus half a second is ``sec=-1, nanosec=500_000_000``.
    """
    sec: builtins.int
    nanosec: builtins.int
    def __init__(self, *, sec: builtins.int = ..., nanosec: builtins.int = ...) -> None: ...
class Time(robolink.message.Message):
    """A point in ROS time: seconds since the clock's epoch, and the nanoseconds on top (0 to 999,999,999)."""
    sec: builtins.int
    nanosec: builtins.int
    def __init__(self, *, sec: builtins.int = ..., nanosec: builtins.int = ...) -> None: ...
