"""Time of a message: that of its header, of a function of the program's own, or of its arrival."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from robolink.clock import ROSClock
from robolink.logging import get_logger
from robolink.time import Time

TimeGetter: TypeAlias = Callable[[Any], "Time | None"]
"""Function that returns the time of a message, None if it has none."""


def get_time_from_message_header(message: Any) -> Time | None:
    """Return the time in the header of `message`; None if it has none. Raises ValueError for a stamp before 0."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return stamp if stamp is None or hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)


class Stamps:
    """Source of a message's time: what `time_getter` finds, or its arrival.

    Args:
        logger: Name of the logger of warnings.
        allow_headerless: True takes the time of arrival for a message without one.
        fs: Filters, the first Subscriber of which has the node by whose clock messages arrive.
        time_getter: Function that returns the time of a message.
        arrival: True takes the time of arrival for all messages.
    """

    def __init__(
        self,
        logger: str,
        allow_headerless: bool,
        fs: Sequence[Any],
        time_getter: TimeGetter = get_time_from_message_header,
        arrival: bool = False,
    ) -> None:
        node = next((each.node for each in fs if "node" in vars(each)), None)
        self.clock = ROSClock() if node is None else node.get_clock()
        self.logger, self.allow_headerless, self.arrival = logger, allow_headerless, arrival
        self.time_getter = time_getter
        self.reported = False

    def of(self, msg: Any) -> Time | None:
        """Return the time of `msg`, None for one that is to be left out; the first of these is warned about."""
        if self.arrival:
            return self.clock.now()
        kind = type(msg).__name__
        try:
            stamp = self.time_getter(msg)
        except ValueError as error:  # anybody may have sent it
            self._tell(f"a message ({kind}) is left out for its stamp: {error}")
            return None
        if stamp is None and not self.allow_headerless:
            self._tell(
                f"{kind} has no header with a stamp: messages of it are left out; with allow_headerless=True the time"
                " at which one comes stands for its stamp"
            )
        return self.clock.now() if stamp is None and self.allow_headerless else stamp

    def _tell(self, problem: str) -> None:
        if not self.reported:
            self.reported = True
            get_logger(self.logger).warning(problem)
