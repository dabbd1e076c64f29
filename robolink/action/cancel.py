"""Selection of the goals that a cancel request means."""

from __future__ import annotations

from collections.abc import Sequence

from robolink.action.states import is_cancelable
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.builtin_interfaces.msg import Time

NO_GOAL = bytes(16)
"""Goal id that means none in particular."""


def goals_to_cancel(asked: GoalInfo, goals: Sequence[GoalStatus]) -> tuple[int, list[GoalInfo]]:
    """Return a return code of CancelGoal, and the goals that are meant and can still be cancelled.

    An id without a stamp means that goal; a stamp means all goals that were accepted then or earlier, beside the one of
    the id if there is one; neither means all. Only a goal that is asked for alone can be unknown, or have ended.
    """
    wanted, until = bytes(asked.goal_id.uuid), _nanoseconds(asked.stamp)
    if wanted != NO_GOAL and not until:
        return _one(wanted, goals)
    everything = wanted == NO_GOAL and not until
    meant = [
        each.goal_info
        for each in goals
        if is_cancelable(each.status)
        and (everything or _nanoseconds(each.goal_info.stamp) <= until or bytes(each.goal_info.goal_id.uuid) == wanted)
    ]
    return CancelGoal.Response.ERROR_NONE, meant


def _one(wanted: bytes, goals: Sequence[GoalStatus]) -> tuple[int, list[GoalInfo]]:
    for each in goals:
        if bytes(each.goal_info.goal_id.uuid) == wanted:
            if is_cancelable(each.status):
                return CancelGoal.Response.ERROR_NONE, [each.goal_info]
            return CancelGoal.Response.ERROR_GOAL_TERMINATED, []
    return CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, []


def _nanoseconds(stamp: Time) -> int:
    return stamp.sec * 10**9 + stamp.nanosec
