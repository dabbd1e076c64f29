"""The message of nav2_msgs that its actions need."""

from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.message import Message, uint16, uint32


class MissedWaypoint(Message):
    """A waypoint that was not reached: its place in the list, its pose, and the code that says why."""

    index: uint32
    goal: PoseStamped
    error_code: uint16
