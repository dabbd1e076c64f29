"""State machine of a goal: an event leads from one status to the next, or is refused."""

from __future__ import annotations

from enum import Enum

from robolink.exceptions import RCLError
from robolink.interfaces.action_msgs.msg import GoalStatus


class GoalEvent(Enum):
    """Events of a goal, numbered as in rcl."""

    EXECUTE = 0
    CANCEL_GOAL = 1
    SUCCEED = 2
    ABORT = 3
    CANCELED = 4


NAMES = {
    GoalStatus.STATUS_UNKNOWN: "UNKNOWN",
    GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
    GoalStatus.STATUS_EXECUTING: "EXECUTING",
    GoalStatus.STATUS_CANCELING: "CANCELING",
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}
"""Names of the states."""
ACTIVE = {GoalStatus.STATUS_ACCEPTED, GoalStatus.STATUS_EXECUTING, GoalStatus.STATUS_CANCELING}
"""States of a goal that has not ended."""
ENDED = {GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED}
"""States of a goal that has ended."""

_NEXT = {
    GoalStatus.STATUS_ACCEPTED: {
        GoalEvent.EXECUTE: GoalStatus.STATUS_EXECUTING,
        GoalEvent.CANCEL_GOAL: GoalStatus.STATUS_CANCELING,
    },
    GoalStatus.STATUS_EXECUTING: {
        GoalEvent.CANCEL_GOAL: GoalStatus.STATUS_CANCELING,
        GoalEvent.SUCCEED: GoalStatus.STATUS_SUCCEEDED,
        GoalEvent.ABORT: GoalStatus.STATUS_ABORTED,
    },
    GoalStatus.STATUS_CANCELING: {
        GoalEvent.SUCCEED: GoalStatus.STATUS_SUCCEEDED,
        GoalEvent.ABORT: GoalStatus.STATUS_ABORTED,
        GoalEvent.CANCELED: GoalStatus.STATUS_CANCELED,
    },
}
"""Next state by state and event: https://design.ros2.org/articles/actions.html, "Goal States"."""


def next_status(status: int, event: GoalEvent) -> int:
    """Return the status after an event. Raises RCLError that names what could happen instead."""
    possible = _NEXT.get(status, {})
    if event not in possible:
        instead = ", ".join(each.name for each in possible) or "nothing any more"
        raise RCLError(f"a goal that is {NAMES.get(status, status)} cannot {event.name}; possible: {instead}")
    return possible[event]


def is_cancelable(status: int) -> bool:
    """True if a goal in this state can be cancelled."""
    return GoalEvent.CANCEL_GOAL in _NEXT.get(status, {})
