"""A point in time of one kind of clock, in whole nanoseconds."""

from __future__ import annotations

from typing import TYPE_CHECKING, overload

from robolink.clock_type import ClockType
from robolink.constants import S_TO_NS
from robolink.duration import Duration

if TYPE_CHECKING:
    from datetime import datetime

    from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg

__all__ = ["ClockType", "Duration", "Time"]

_LIMIT, _LIMIT_OF_SECONDS = 2**63, 2**31


class Time:
    """Point in time, since the epoch of its clock: `Time(seconds=1.5)`.

    Times of different kinds of clocks cannot be compared or subtracted: that raises `TypeError`.

    Args:
        seconds: Seconds, also with a fraction; not negative.
        nanoseconds: Nanoseconds, which are added; not negative.
        clock_type: Kind of the clock, by default the system's.

    Raises:
        ValueError: if the time is negative.
        OverflowError: if it does not fit in 64 signed bits (292 years).
        TypeError: if `clock_type` is not a ClockType.
    """

    __slots__ = ("_clock_type", "_nanoseconds")

    def __init__(
        self,
        *,
        seconds: float = 0,
        nanoseconds: float = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        if not isinstance(clock_type, ClockType):
            raise TypeError(f"clock_type must be a ClockType, got {clock_type!r}")
        if seconds < 0 or nanoseconds < 0:
            raise ValueError(f"a Time cannot be negative, got seconds={seconds}, nanoseconds={nanoseconds}")
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if total >= _LIMIT:
            raise OverflowError(f"a Time holds 63 bits of nanoseconds, got {total}")
        self._nanoseconds = total
        self._clock_type = clock_type

    @property
    def nanoseconds(self) -> int:
        """Nanoseconds since the clock's epoch."""
        return self._nanoseconds

    @property
    def clock_type(self) -> ClockType:
        """Kind of the clock that this time belongs to."""
        return self._clock_type

    def seconds_nanoseconds(self) -> tuple[int, int]:
        """Return whole seconds and the nanoseconds that remain."""
        return divmod(self._nanoseconds, S_TO_NS)

    def __repr__(self) -> str:
        return f"Time(nanoseconds={self._nanoseconds}, clock_type={self._clock_type.name})"

    def __add__(self, other: Duration) -> Time:
        if not isinstance(other, Duration):
            return NotImplemented
        return Time(nanoseconds=self._nanoseconds + other.nanoseconds, clock_type=self._clock_type)

    __radd__ = __add__

    @overload
    def __sub__(self, other: Time) -> Duration: ...

    @overload
    def __sub__(self, other: Duration) -> Time: ...

    def __sub__(self, other: Time | Duration) -> Duration | Time:
        if isinstance(other, Time):
            return Duration(nanoseconds=self._nanoseconds - self._same_clock(other, "subtract"))
        if isinstance(other, Duration):
            return Time(nanoseconds=self._nanoseconds - other.nanoseconds, clock_type=self._clock_type)
        return NotImplemented

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        return self._nanoseconds == self._same_clock(other, "compare")

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    def __lt__(self, other: Time) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        return self._nanoseconds < self._same_clock(other, "compare")

    def __le__(self, other: Time) -> bool:
        if not isinstance(other, Time):
            return NotImplemented
        return self._nanoseconds <= self._same_clock(other, "compare")

    def to_msg(self) -> TimeMsg:
        """Return the message; beyond the year 2038 its 32-bit `sec` refuses the value when it is published."""
        from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg

        seconds, nanoseconds = self.seconds_nanoseconds()
        return TimeMsg(sec=seconds, nanosec=nanoseconds)

    def to_datetime(self) -> datetime:
        """Return the time as a date and a time of day, by the local clock and to a microsecond, without a time zone.

        Raises:
            TypeError: if it is of a steady clock, whose times are not dates.
        """
        from datetime import datetime

        if self._clock_type not in (ClockType.ROS_TIME, ClockType.SYSTEM_TIME):
            raise TypeError("a time of a steady clock is not a date: expected one of ROS_TIME or SYSTEM_TIME")
        return datetime.fromtimestamp(self._nanoseconds / S_TO_NS)

    @classmethod
    def from_msg(cls, msg: TimeMsg, clock_type: ClockType = ClockType.ROS_TIME) -> Time:
        """Return the time of a `builtin_interfaces/msg/Time`.

        Args:
            msg: Message to read.
            clock_type: Kind of the clock that the time is of, which the message does not say.

        Raises:
            TypeError: if `msg` is another message.
        """
        from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg

        if not isinstance(msg, TimeMsg):
            raise TypeError(f"expected a builtin_interfaces.msg.Time, got {type(msg).__name__}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec, clock_type=clock_type)

    def _same_clock(self, other: Time, verb: str) -> int:
        if self._clock_type != other._clock_type:
            raise TypeError(
                f"cannot {verb} times of different clocks: {self._clock_type.name} and {other._clock_type.name}"
            )
        return other._nanoseconds


def sent_time(msg: TimeMsg) -> Time:
    """Return the ROS time of a stamp that somebody sent, if a message can have it again.

    Args:
        msg: The stamp.

    Raises:
        ValueError: for a time before 1970, and for one whose nanoseconds carry its seconds beyond 32 bits.
    """
    time = Time.from_msg(msg)
    if time.nanoseconds // S_TO_NS >= _LIMIT_OF_SECONDS:
        raise ValueError(f"a message has no time after 2038, got sec={msg.sec}, nanosec={msg.nanosec}")
    return time
