"""InputAligner: messages of several topics, put out one by one in the order of their stamps."""

from __future__ import annotations

import heapq
import math
import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from robolink.companions.message_filters.simple_filter import SimpleFilter
from robolink.duration import Duration
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.timer import Timer


@dataclass
class QueueStatus:
    """State of an input: whether the others wait for it, what waits in it, and what went out or was too late.

    Args:
        active: True if the others wait for it.
        queue_size: Number of messages that wait.
        msgs_processed: Number of messages that went out.
        msgs_dropped: Number of messages that were too late.
    """

    active: bool
    queue_size: int
    msgs_processed: int
    msgs_dropped: int


class _Input:
    """Queue of an input: messages by stamp and arrival, and when the next is due."""

    def __init__(self) -> None:
        self.output = SimpleFilter()
        self.waiting: list[tuple[int, int, Any]] = []
        self.period = 0
        self.due = 0
        self.active = False
        self.processed = self.dropped = self.arrived = 0

    def put(self, stamp: int, message: Any) -> None:
        heapq.heappush(self.waiting, (stamp, self.arrived, message))
        self.arrived += 1

    def first(self) -> float:
        """Return the stamp of its first message, else that at which the next is due, in ns; infinity for neither."""
        if self.waiting:
            self.active, self.due = True, self.waiting[0][0] + self.period
            return self.waiting[0][0]
        return self.due if self.active else math.inf


class InputAligner(SimpleFilter):
    """Filter that puts out the messages of several filters one by one, in the order of their stamps.

    It waits for an input that is late, for `timeout` at most: until another has a message that is so much later than
    the one that is due. What comes with an earlier stamp than a message that went out is dropped.

    Args:
        timeout: Time by which an input may be late.
        filters: The inputs; `connectInput` may say them later.
    """

    def __init__(self, timeout: Duration, *filters: SimpleFilter) -> None:
        super().__init__()
        self.timeout = timeout
        self.dispatch_timer: Timer | None = None
        self._name = ""
        self._inputs: list[_Input] = []
        self._connections: list[tuple[SimpleFilter, int]] = []
        self._last_in = self._last_out = 0
        self._lock = threading.Lock()
        self.connectInput(*filters)

    def connectInput(self, *filters: SimpleFilter) -> None:  # noqa: N802
        """Take the outputs of `filters`, with empty queues, and no longer those of before."""
        self.disconnectAll()
        with self._lock:
            self._inputs = [_Input() for _ in filters]
        self._connections = [(each, each.registerCallback(self.add, at)) for at, each in enumerate(filters)]

    def disconnectAll(self) -> None:  # noqa: N802
        """Take the output of no filter any more."""
        for each, connection in self._connections:
            each.unregisterCallback(connection)
        self._connections = []

    def registerCallback(self, index: int, callback: Callable[..., Any], *args: Any) -> int:  # type: ignore[override]  # noqa: N802
        """Register a callback of the messages of one input.

        Args:
            index: Index of the input.
            callback: Called with each message.
            args: Further arguments of each call, after the message.

        Returns:
            The number of this connection.
        """
        return self._inputs[index].output.registerCallback(callback, *args)

    def setName(self, name: str) -> None:  # noqa: N802
        """Set its name, `name`, which nothing depends on."""
        self._name = name

    def getName(self) -> str:  # noqa: N802
        """Return its name."""
        return self._name

    def add(self, msg: Any, queue_index: int) -> None:
        """Queue `msg`, a message with a header, of the input `queue_index`."""
        stamp = Time.from_msg(msg.header.stamp).nanoseconds
        with self._lock:
            if stamp < self._last_out:
                self._inputs[queue_index].dropped += 1
                return
            self._last_in = max(self._last_in, stamp)
            self._inputs[queue_index].put(stamp, msg)

    def setInputPeriod(self, index: int, period: Duration) -> None:  # noqa: N802
        """Set `period`, the time between two messages of the input `index`: the next is due so long after one."""
        self._inputs[index].period = period.nanoseconds

    def getQueueStatus(self, index: int) -> QueueStatus:  # noqa: N802
        """Return the state of the input `index`."""
        it = self._inputs[index]
        return QueueStatus(it.active, len(it.waiting), it.processed, it.dropped)

    def setupDispatchTimer(self, node: Node, update_rate: Duration) -> None:  # noqa: N802
        """Put out what is ready by a timer of `node` whose period is `update_rate`."""
        self.dispatch_timer = node.create_timer(update_rate.nanoseconds / 1e9, self.dispatchMessages)

    def dispatchMessages(self) -> None:  # noqa: N802
        """Put out what is ready."""
        while (found := self._next()) is not None:
            source, message = found
            source.output.signalMessage(message)  # outside the lock: a callback may add

    def _next(self) -> tuple[_Input, Any] | None:
        """Take the next message; None while nothing waits, or an input that is not too late is waited for."""
        with self._lock:
            while any(each.waiting for each in self._inputs):
                first = min(self._inputs, key=_Input.first)
                if first.waiting:
                    self._last_out, _, message = heapq.heappop(first.waiting)
                    first.processed += 1
                    return first, message
                if self._last_in - first.due < self.timeout.nanoseconds:
                    return None
                first.active = False
            return None
