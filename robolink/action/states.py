"""State machine of goals: how an event leads from one to the next, which goals a cancel means, and their list."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from enum import Enum

from robolink.exceptions import RCLError
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.builtin_interfaces.msg import Time


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


NO_GOAL = bytes(16)
"""Goal id that means none in particular."""


def goals_to_cancel(requested: GoalInfo, goals: Sequence[GoalStatus]) -> tuple[int, list[GoalInfo]]:
    """Return a return code of CancelGoal, and the goals that are meant and can still be cancelled.

    An id without a stamp means that goal; a stamp means all goals that were accepted then or earlier, beside the one of
    the id if there is one; neither means all. Only a goal that is asked for alone can be unknown, or have ended.
    """
    expected, until = bytes(requested.goal_id.uuid), _nanoseconds(requested.stamp)
    if expected != NO_GOAL and not until:
        return _one(expected, goals)
    everything = expected == NO_GOAL and not until
    meant = [
        each.goal_info
        for each in goals
        if is_cancelable(each.status)
        and (
            everything or _nanoseconds(each.goal_info.stamp) <= until or bytes(each.goal_info.goal_id.uuid) == expected
        )
    ]
    return CancelGoal.Response.ERROR_NONE, meant


def _one(expected: bytes, goals: Sequence[GoalStatus]) -> tuple[int, list[GoalInfo]]:
    for each in goals:
        if bytes(each.goal_info.goal_id.uuid) == expected:
            if is_cancelable(each.status):
                return CancelGoal.Response.ERROR_NONE, [each.goal_info]
            return CancelGoal.Response.ERROR_GOAL_TERMINATED, []
    return CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, []


def _nanoseconds(stamp: Time) -> int:
    return stamp.sec * 10**9 + stamp.nanosec


_HEAD = b"\x00\x01\x00\x00"
_COUNT = struct.Struct("<I")
_STATUS = struct.Struct("<16s3xiIb")
"""Layout of an id, a stamp and a code. It ends with a single byte, so three must come before the next one's stamp."""
_ID_BYTES, _FIRST_STAMP = 16, 19
"""Bounds of the three bytes that are left out of the first element, which begins at a multiple of four."""


class Statuses:
    """The states of a server's goals as encoded bytes, those of an action_msgs/msg/GoalStatusArray, in order.

    Each step of a goal has all of them published. To make and encode a message for each goal again and again took more
    than half of a busy server's time. Not thread-safe: the server has a lock.
    """

    def __init__(self) -> None:
        self._encoded: dict[bytes, bytes] = {}

    def put(self, goal: GoalInfo, status: int) -> None:
        """Set a goal's state, a code of action_msgs/msg/GoalStatus."""
        key, stamp = bytes(goal.goal_id.uuid), goal.stamp
        self._encoded[key] = _STATUS.pack(key, stamp.sec, stamp.nanosec, status)

    def drop(self, key: bytes) -> None:
        """Remove a goal, by the bytes of its id."""
        self._encoded.pop(key, None)

    def message(self) -> bytes:
        """Return the encoded message of all of them."""
        all_of_them = b"".join(self._encoded.values())
        count = _COUNT.pack(len(self._encoded))
        return b"".join((_HEAD, count, all_of_them[:_ID_BYTES], memoryview(all_of_them)[_FIRST_STAMP:]))
