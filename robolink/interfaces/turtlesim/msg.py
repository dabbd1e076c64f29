"""The messages of turtlesim: where the turtle is, and the colour below it."""

from robolink.message import Message, float32, uint8


class Color(Message):
    """The colour of the picture below the turtle: red, green and blue from 0 to 255."""

    r: uint8
    g: uint8
    b: uint8


class Pose(Message):
    """Pose and speed of the turtle.

    `x` and `y` are in metres from the lower left corner of the window, which is 11.09 m wide and high; `theta` is in
    radians, counter-clockwise from the x axis. The velocities are in m/s and rad/s.
    """

    x: float32
    y: float32
    theta: float32
    linear_velocity: float32
    angular_velocity: float32
