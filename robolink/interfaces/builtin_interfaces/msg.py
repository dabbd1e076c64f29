"""The messages of builtin_interfaces: time and duration, as seconds and nanoseconds."""

from robolink.message import Message, int32, uint32


class Time(Message):
    """A point in ROS time: seconds since the clock's epoch, and the nanoseconds on top (0 to 999,999,999)."""

    sec: int32
    nanosec: uint32


class Duration(Message):
    """A span of time: `sec` seconds plus `nanosec` nanoseconds (0 to 999,999,999).

    Minus half a second is ``sec=-1, nanosec=500_000_000``.
    """

    sec: int32
    nanosec: uint32
