"""The service of action_msgs: stopping goals before they are reached."""

from typing import ClassVar

from robolink.interfaces.action_msgs.msg import GoalInfo
from robolink.message import Message, Sequence, Service, int8


class CancelGoal(Service):
    """Ask an action server to stop working on goals."""

    class Request(Message):
        """Which goals: the one with `goal_id`, and all that were accepted at `stamp` or before.

        An identifier of zeros names no goal and a stamp of zero no time; when both are zero, all goals are meant.
        """

        goal_info: GoalInfo

    class Response(Message):
        """The goals that are being cancelled now; when there are none, `return_code` says why.

        ERROR_REJECTED: the server goes on. ERROR_UNKNOWN_GOAL_ID: it has no such goal. ERROR_GOAL_TERMINATED:
        the goal has ended already.
        """

        ERROR_NONE: ClassVar[int8] = 0
        ERROR_REJECTED: ClassVar[int8] = 1
        ERROR_UNKNOWN_GOAL_ID: ClassVar[int8] = 2
        ERROR_GOAL_TERMINATED: ClassVar[int8] = 3

        return_code: int8
        goals_canceling: Sequence[GoalInfo]
