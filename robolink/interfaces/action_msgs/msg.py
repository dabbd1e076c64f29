"""The messages of action_msgs: which goals an action server has, and what became of each."""

from typing import ClassVar

from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.message import Message, Sequence, int8


class GoalInfo(Message):
    """A goal's identifier and the time at which the server accepted it."""

    goal_id: UUID
    stamp: Time


class GoalStatus(Message):
    """A goal and the state that it is in.

    A goal begins as ACCEPTED, is worked on as EXECUTING, passes through CANCELING where a client wants it
    stopped, and ends as SUCCEEDED, CANCELED (as a client wished) or ABORTED (by the server itself). UNKNOWN says
    that nobody has set the status.
    """

    STATUS_UNKNOWN: ClassVar[int8] = 0
    STATUS_ACCEPTED: ClassVar[int8] = 1
    STATUS_EXECUTING: ClassVar[int8] = 2
    STATUS_CANCELING: ClassVar[int8] = 3
    STATUS_SUCCEEDED: ClassVar[int8] = 4
    STATUS_CANCELED: ClassVar[int8] = 5
    STATUS_ABORTED: ClassVar[int8] = 6

    goal_info: GoalInfo
    status: int8


class GoalStatusArray(Message):
    """All goals that an action server remembers, as it publishes them on ``ACTION/_action/status``."""

    status_list: Sequence[GoalStatus]
