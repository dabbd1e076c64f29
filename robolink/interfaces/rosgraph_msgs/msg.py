"""The message of rosgraph_msgs: simulated time."""

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.message import Message


class Clock(Message):
    """The time that nodes with `use_sim_time` live in, as published on /clock."""

    clock: Time
