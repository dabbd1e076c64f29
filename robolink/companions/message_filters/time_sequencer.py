"""TimeSequencer: messages of a topic in the order of their stamps, a while after these."""

from __future__ import annotations

import heapq
import threading
from typing import TYPE_CHECKING, Any

from robolink.companions.message_filters.simple_filter import SimpleFilter
from robolink.duration import Duration
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.node import Node


class TimeSequencer(SimpleFilter):
    """Filter that puts messages out in the order of their stamps, each `delay` after its stamp.

    What comes with an earlier stamp than a message that went out is dropped, unless the clock was set back since: then
    it begins anew, where upstream drops everything.

    Args:
        input_filter: Filter whose messages come in; None if `connectInput` says it later.
        delay: Time after its stamp at which a message goes out, in seconds or as a Duration.
        update_rate: Time between two looks for what goes out, in seconds or as a Duration.
        queue_size: Number of messages that wait, the earliest of which is dropped; 0 for any number.
        node: Node whose timer looks, and by whose clock it is late enough.
        msg_stamp_attr: Path of the stamp in a message.
    """

    def __init__(
        self,
        input_filter: SimpleFilter | None,
        delay: Duration | float,
        update_rate: Duration | float,
        queue_size: int,
        node: Node,
        msg_stamp_attr: str = "header.stamp",
    ) -> None:
        super().__init__()
        self.delay = delay if isinstance(delay, Duration) else Duration(seconds=delay)
        self.update_rate = update_rate if isinstance(update_rate, Duration) else Duration(seconds=update_rate)
        self.queue_size, self.node = queue_size, node
        self.msg_stamp_attrs = msg_stamp_attr.split(".")
        self.lock = threading.Lock()
        self.messages: list[tuple[int, int, Any]] = []
        self.incoming_connection: int | None = None
        self._last = self._looked = self._arrived = 0
        self.update_timer = node.create_timer(self.update_rate.nanoseconds / 1e9, self._dispatch)
        if input_filter is not None:
            self.connectInput(input_filter)

    @property
    def last_time(self) -> Time:
        """The stamp of the message that went out last."""
        return Time(nanoseconds=self._last)

    def connectInput(self, input_filter: SimpleFilter) -> None:  # noqa: N802
        """Take the output of `input_filter`. Raises RuntimeError if one is connected already."""
        if self.incoming_connection is not None:
            raise RuntimeError("Already connected to an input filter.")
        self.incoming_connection = input_filter.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Queue `msg`. Raises TypeError if what is at the path of the stamp is something else."""
        stamp = self._stamp_of(msg)
        if stamp is None:
            return
        with self.lock:
            if stamp >= self._last:
                heapq.heappush(self.messages, (stamp, self._arrived, msg))
                self._arrived += 1
            if 0 < self.queue_size < len(self.messages):
                heapq.heappop(self.messages)

    def shutdown(self) -> None:
        """End it: nothing goes out any more."""
        self.update_timer.cancel()
        self.node.destroy_timer(self.update_timer)

    def _stamp_of(self, msg: Any) -> int | None:
        found = msg
        for name in self.msg_stamp_attrs:
            found = getattr(found, name, None)
        path = ".".join(self.msg_stamp_attrs)
        if found is None:
            kind = type(msg).__name__
            self.node.get_logger().warning(f"{kind} has no {path}: a message without a stamp is left out", once=True)
            return None
        if not isinstance(found, TimeMsg):
            raise TypeError(f"{path} of {type(msg).__name__}: expected a Time, got {type(found).__name__}")
        return int(found.sec * 10**9 + found.nanosec)

    def _dispatch(self) -> None:
        now = self.node.get_clock().now().nanoseconds
        due: list[Any] = []
        with self.lock:
            if now < self._looked:  # the clock was set back
                self._last = 0
            self._looked = now
            while self.messages and self.messages[0][0] + self.delay.nanoseconds <= now:
                self._last, _, message = heapq.heappop(self.messages)
                due.append(message)
        for each in due:  # outside the lock: a callback may add
            self.signalMessage(each)
