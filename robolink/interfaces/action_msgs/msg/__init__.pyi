# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.action_msgs.msg
import robolink.interfaces.builtin_interfaces.msg
import robolink.interfaces.unique_identifier_msgs.msg

__all__ = ["GoalInfo", "GoalStatus", "GoalStatusArray"]

class GoalInfo(robolink.message.Message):
    """A goal's identifier and the time at which the server accepted it."""
    goal_id: robolink.interfaces.unique_identifier_msgs.msg.UUID
    stamp: robolink.interfaces.builtin_interfaces.msg.Time
    def __init__(self, *, goal_id: robolink.interfaces.unique_identifier_msgs.msg.UUID = ..., stamp: robolink.interfaces.builtin_interfaces.msg.Time = ...) -> None: ...
class GoalStatus(robolink.message.Message):
    """A goal and the state that it is in.

    A goal begins as ACCEPTED, is worked on as EXECUTING, passes through CANCELING where a client wants it
    stopped, and ends as SUCCEEDED, CANCELED (as a client wished) or ABORTED (by the server itself). UNKNOWN says
    that nobody has set the status.
    """
    STATUS_UNKNOWN: typing.ClassVar[builtins.int]
    STATUS_ACCEPTED: typing.ClassVar[builtins.int]
    STATUS_EXECUTING: typing.ClassVar[builtins.int]
    STATUS_CANCELING: typing.ClassVar[builtins.int]
    STATUS_SUCCEEDED: typing.ClassVar[builtins.int]
    STATUS_CANCELED: typing.ClassVar[builtins.int]
    STATUS_ABORTED: typing.ClassVar[builtins.int]
    goal_info: robolink.interfaces.action_msgs.msg.GoalInfo
    status: builtins.int
    def __init__(self, *, goal_info: robolink.interfaces.action_msgs.msg.GoalInfo = ..., status: builtins.int = ...) -> None: ...
class GoalStatusArray(robolink.message.Message):
    """All goals that an action server remembers, as it publishes them on ``ACTION/_action/status``."""
    status_list: collections.abc.MutableSequence[robolink.interfaces.action_msgs.msg.GoalStatus]
    def __init__(self, *, status_list: collections.abc.Iterable[robolink.interfaces.action_msgs.msg.GoalStatus] = ...) -> None: ...
