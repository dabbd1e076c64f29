"""The messages of actionlib_msgs: goals as ROS 1's actions had them. ROS 2's own are in action_msgs."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, string, uint8


class GoalID(Message):
    """A goal's name, which no other goal has, and when it was asked for."""

    stamp: Time
    id: string


class GoalStatus(Message):
    """A goal and how far it is; `text` is for people.

    A goal is PENDING, then ACTIVE, and ends as SUCCEEDED, ABORTED or REJECTED. One that a client withdraws goes
    through PREEMPTING to PREEMPTED once work has begun, through RECALLING to RECALLED before. LOST is a client's own
    word for a goal that the server no longer speaks of.
    """

    PENDING: ClassVar[uint8] = 0
    ACTIVE: ClassVar[uint8] = 1
    PREEMPTED: ClassVar[uint8] = 2
    SUCCEEDED: ClassVar[uint8] = 3
    ABORTED: ClassVar[uint8] = 4
    REJECTED: ClassVar[uint8] = 5
    PREEMPTING: ClassVar[uint8] = 6
    RECALLING: ClassVar[uint8] = 7
    RECALLED: ClassVar[uint8] = 8
    LOST: ClassVar[uint8] = 9

    goal_id: GoalID
    status: uint8
    text: string


class GoalStatusArray(Message):
    """All goals that a server keeps track of."""

    header: Header
    status_list: Sequence[GoalStatus]
