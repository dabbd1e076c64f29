# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message

__all__ = ["Color", "Pose"]

class Color(robolink.message.Message):
    """The colour of the picture below the turtle: red, green and blue from 0 to 255."""
    r: builtins.int
    g: builtins.int
    b: builtins.int
    def __init__(self, *, r: builtins.int = ..., g: builtins.int = ..., b: builtins.int = ...) -> None: ...
class Pose(robolink.message.Message):
    """Pose and speed of the turtle.

    `x` and `y` are in metres from the lower left corner of the window, which is 11.09 m wide and high; `theta` is in
    radians, counter-clockwise from the x axis. The velocities are in m/s and rad/s.
    """
    x: builtins.float
    y: builtins.float
    theta: builtins.float
    linear_velocity: builtins.float
    angular_velocity: builtins.float
    def __init__(self, *, x: builtins.float = ..., y: builtins.float = ..., theta: builtins.float = ..., linear_velocity: builtins.float = ..., angular_velocity: builtins.float = ...) -> None: ...
