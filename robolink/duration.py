"""Duration: a span of time in whole nanoseconds."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from robolink.constants import S_TO_NS

if TYPE_CHECKING:
    from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg

__all__ = ["Duration", "Infinite"]

_LIMIT = 2**63


class Duration:
    """Span of time, which may be negative: `Duration(seconds=0.5)`, `Duration(seconds=1, nanoseconds=5)`.

    Both parts are added up and cut to whole nanoseconds.

    Args:
        seconds: Seconds, also with a fraction.
        nanoseconds: Nanoseconds, which are added.

    Raises:
        OverflowError: if the span does not fit in 64 signed bits (292 years).
    """

    __slots__ = ("_nanoseconds",)

    def __init__(self, *, seconds: float = 0, nanoseconds: float = 0) -> None:
        total = int(seconds * S_TO_NS) + int(nanoseconds)
        if not -_LIMIT <= total < _LIMIT:
            raise OverflowError(f"a Duration holds 64 bits of nanoseconds, got {total}")
        self._nanoseconds = total

    @property
    def nanoseconds(self) -> int:
        """Whole span in nanoseconds."""
        return self._nanoseconds

    def __repr__(self) -> str:
        return f"Duration(nanoseconds={self._nanoseconds})"

    def __str__(self) -> str:
        return "Infinite" if self == Infinite else f"{self._nanoseconds} nanoseconds"

    def __add__(self, other: Duration) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self._nanoseconds + other._nanoseconds)

    def __sub__(self, other: Duration) -> Duration:
        if not isinstance(other, Duration):
            return NotImplemented
        return Duration(nanoseconds=self._nanoseconds - other._nanoseconds)

    def __mul__(self, factor: float) -> Duration:
        """Scale the span; times +inf is `Infinite`, times nan or -inf raises `ValueError`."""
        if isinstance(factor, int):
            return Duration(nanoseconds=self._nanoseconds * factor)
        if not isinstance(factor, float):
            return NotImplemented
        if factor == math.inf:
            return Infinite
        if not math.isfinite(factor):
            raise ValueError(f"a Duration cannot be multiplied by {factor}")
        return Duration(nanoseconds=int(self._nanoseconds * factor))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._nanoseconds == other._nanoseconds

    __hash__ = None  # type: ignore[assignment]  # as in rclpy

    def __lt__(self, other: Duration) -> bool:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._nanoseconds < other._nanoseconds

    def __le__(self, other: Duration) -> bool:
        if not isinstance(other, Duration):
            return NotImplemented
        return self._nanoseconds <= other._nanoseconds

    def to_msg(self) -> DurationMsg:
        """Return the message; its `nanosec` is never negative, so -1 ns is sec=-1, nanosec=999999999."""
        from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg

        seconds, nanoseconds = divmod(self._nanoseconds, S_TO_NS)
        return DurationMsg(sec=seconds, nanosec=nanoseconds)

    @classmethod
    def from_msg(cls, msg: DurationMsg) -> Duration:
        """Return the duration of `msg`, a `builtin_interfaces/msg/Duration`. Raises TypeError for another message."""
        from robolink.interfaces.builtin_interfaces.msg import Duration as DurationMsg

        if not isinstance(msg, DurationMsg):
            raise TypeError(f"expected a builtin_interfaces.msg.Duration, got {type(msg).__name__}")
        return cls(seconds=msg.sec, nanoseconds=msg.nanosec)


Infinite = Duration(nanoseconds=_LIMIT - 1)
"""Duration that stands for "for ever" in DDS and rmw; longer than any wait."""
