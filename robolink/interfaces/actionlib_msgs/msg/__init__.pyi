# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.actionlib_msgs.msg
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.std_msgs.msg

__all__ = ["GoalID", "GoalStatus", "GoalStatusArray"]

class GoalID(robolink.message.Message):
    """A goal's name, which no other goal has, and when it was asked for."""
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    id: builtins.str
    def __init__(self, *, stamp: robolink.interfaces.builtin_interfaces.msg.Time = ..., id: builtins.str = ...) -> None: ...
class GoalStatus(robolink.message.Message):
    """A goal and how far it is; `text` is for people.

    A goal is PENDING, then ACTIVE, and ends as SUCCEEDED, ABORTED or REJECTED. One that a client withdraws goes
    through PREEMPTING to PREEMPTED once work has begun, through RECALLING to RECALLED before. LOST is a client's own
    word for a goal that the server no longer speaks of.
    """
    PENDING: typing.ClassVar[builtins.int]
    ACTIVE: typing.ClassVar[builtins.int]
    PREEMPTED: typing.ClassVar[builtins.int]
    SUCCEEDED: typing.ClassVar[builtins.int]
    ABORTED: typing.ClassVar[builtins.int]
    REJECTED: typing.ClassVar[builtins.int]
    PREEMPTING: typing.ClassVar[builtins.int]
    RECALLING: typing.ClassVar[builtins.int]
    RECALLED: typing.ClassVar[builtins.int]
    LOST: typing.ClassVar[builtins.int]
    goal_id: robolink.interfaces.actionlib_msgs.msg.GoalID
    status: builtins.int
    text: builtins.str
    def __init__(self, *, goal_id: robolink.interfaces.actionlib_msgs.msg.GoalID = ..., status: builtins.int = ..., text: builtins.str = ...) -> None: ...
class GoalStatusArray(robolink.message.Message):
    """All goals that a server keeps track of."""
    header: robolink.interfaces.std_msgs.msg.Header
    status_list: collections.abc.MutableSequence[robolink.interfaces.actionlib_msgs.msg.GoalStatus]
    def __init__(self, *, header: robolink.interfaces.std_msgs.msg.Header = ..., status_list: collections.abc.Iterable[robolink.interfaces.actionlib_msgs.msg.GoalStatus] = ...) -> None: ...
