# Made of the files beside it by tools/interface_stubs.py.
import builtins
import collections.abc
import typing
import robolink.message
import robolink.interfaces.action_msgs.msg

__all__ = ["CancelGoal"]

class CancelGoal(robolink.message.Service):
    """Ask an action server to stop working on goals.

    Which goals: the one with `goal_id`, and all that were accepted at `stamp` or before.

    An identifier of zeros names no goal and a stamp of zero no time; when both are zero, all goals are meant.
    """
    class Request(robolink.message.Message):
        goal_info: robolink.interfaces.action_msgs.msg.GoalInfo
        def __init__(self, *, goal_info: robolink.interfaces.action_msgs.msg.GoalInfo = ...) -> None: ...
    class Response(robolink.message.Message):
        """The goals that are being cancelled now; when there are none, `return_code` says why.

        ERROR_REJECTED: the server goes on. ERROR_UNKNOWN_GOAL_ID: it has no such goal. ERROR_GOAL_TERMINATED:
        the goal has ended already.
        """
        ERROR_NONE: typing.ClassVar[builtins.int]
        ERROR_REJECTED: typing.ClassVar[builtins.int]
        ERROR_UNKNOWN_GOAL_ID: typing.ClassVar[builtins.int]
        ERROR_GOAL_TERMINATED: typing.ClassVar[builtins.int]
        return_code: builtins.int
        goals_canceling: collections.abc.MutableSequence[robolink.interfaces.action_msgs.msg.GoalInfo]
        def __init__(self, *, return_code: builtins.int = ..., goals_canceling: collections.abc.Iterable[robolink.interfaces.action_msgs.msg.GoalInfo] = ...) -> None: ...
