"""Cache of an action server's goal states as encoded bytes, those of an action_msgs/msg/GoalStatusArray.

Each step of a goal has all of them published. To make and encode a message for each goal again and again took more than
half of a busy server's time.
"""

from __future__ import annotations

import struct

from robolink.interfaces.action_msgs.msg import GoalInfo

_HEAD = b"\x00\x01\x00\x00"
_COUNT = struct.Struct("<I")
_STATUS = struct.Struct("<16s3xiIb")
"""Layout of an id, a stamp and a code. It ends with a single byte, so three must come before the next one's stamp."""
_ID_BYTES, _FIRST_STAMP = 16, 19
"""Bounds of the three bytes that are left out of the first element, which begins at a multiple of four."""


class Statuses:
    """The states of a server's goals, in the order in which they came. Not thread-safe: the server has a lock."""

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
