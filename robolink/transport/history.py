"""History of a topic, as its QoS says: what a receiver stores (Mailbox), and what a publisher retains (Latch).

The depth of a profile is read here and nowhere else, but for what Zenoh itself is configured with.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any, Generic, TypeVar

from robolink.qos import HistoryPolicy, QoSProfile, resolved
from robolink.system.waits import fork_lock

ALL = 0
"""Depth of a mailbox without a bound, as that of a subscription with KEEP_ALL."""

ItemT = TypeVar("ItemT")


def stored_depth(qos: QoSProfile) -> int:
    """Return the number of messages that a subscription of this profile stores; ALL with KEEP_ALL."""
    return ALL if qos.history is HistoryPolicy.KEEP_ALL else resolved(qos).depth


def latched_depth(qos: QoSProfile) -> int:
    """Return the number of samples that a transient-local publisher retains, and that such a subscription requests.

    With KEEP_ALL it is the profile's depth too: a publisher that retained all would grow for as long as it lives.
    """
    return resolved(qos).depth


def _nothing() -> None:
    pass


def bounded(depth: int) -> deque[Any]:
    """Return a queue of the last `depth` items, or of ALL: a bare deque, to which a network appends without Python."""
    return deque(maxlen=depth or None)


class Mailbox:
    """Store of one receiver until its turn comes: the last `depth`, or ALL. The oldest is dropped, and counted.

    Args:
        depth: Largest number of items that wait; ALL is any number.
        on_stored: Function that is called when there is one more than before, unless the receiver is `listed`.
        on_dropped: Function that is called when the oldest gives way to what arrives.
        prepare: Function of what arrives, which returns what is stored in its place, or None for nothing.
    """

    __slots__ = ("depth", "dropped", "listed", "put", "waiting")

    def __init__(
        self,
        depth: int,
        on_stored: Callable[[], object] = _nothing,
        on_dropped: Callable[[], object] = _nothing,
        prepare: Callable[[Any], Any] | None = None,
    ) -> None:
        self.depth = depth
        self.waiting = bounded(depth)
        """Samples that wait, oldest first."""
        self.dropped = 0
        """Number of items that gave way to newer ones."""
        self.listed = False
        """True while the receiver is among what is ready, or its turn is still to come."""
        self.put: Callable[[Any], None] = _putting(self, on_stored, on_dropped)
        """Store what arrives, under the lock of whoever takes."""
        if prepare is not None:
            self.put = _preparing(prepare, self.put)

    @property
    def dropped_before_last(self) -> int:
        """Number of items that had given way when the last one was taken."""
        return self.dropped

    def take(self) -> Any:
        """Take the oldest. Raises IndexError if there is none."""
        return self.waiting.popleft()

    def __len__(self) -> int:
        return len(self.waiting)


def _putting(
    mailbox: Mailbox, on_stored: Callable[[], object], on_dropped: Callable[[], object]
) -> Callable[[Any], None]:
    """Return the `put` of a mailbox: a closure, which costs half of a method, since every message comes here."""
    waiting, most = mailbox.waiting, mailbox.waiting.maxlen
    append = waiting.append

    def put(arrived: Any) -> None:
        if len(waiting) == most:
            mailbox.dropped += 1
            append(arrived)
            on_dropped()
            return
        append(arrived)
        if not mailbox.listed:
            on_stored()

    return put


def _preparing(prepare: Callable[[Any], Any], put: Callable[[Any], None]) -> Callable[[Any], None]:
    def prepare_and_put(arrived: Any) -> None:
        prepared = prepare(arrived)
        if prepared is not None:
            put(prepared)

    return prepare_and_put


class Latch(Generic[ItemT]):
    """Samples that a publisher retains for whoever comes late, or has lost some: its last, in order.

    Args:
        depth: Largest number of samples.
        most_bytes: Largest size of all together, in bytes; 0 is any size.
    """

    __slots__ = ("_bytes", "_most_bytes", "_retained", "lock")

    def __init__(self, depth: int, most_bytes: int = 0) -> None:
        self.lock = fork_lock()  # re-entrant: a signal handler may publish, too
        """Held while a sample is retained; also to be held while it is sent, where both must be in one order."""
        self._retained: deque[tuple[ItemT, int]] = deque(maxlen=depth)
        self._most_bytes, self._bytes = most_bytes, 0

    def retain(self, item: ItemT, size: int = 0) -> None:
        """Retain a sample, in the place of the oldest ones if there are enough; `size` in bytes, if that is bounded."""
        retained = self._retained
        with self.lock:
            if len(retained) == retained.maxlen:
                self._bytes -= retained[0][1]
            retained.append((item, size))
            self._bytes += size
            if self._most_bytes:
                while self._bytes > self._most_bytes:
                    self._bytes -= retained.popleft()[1]

    def last(self, most: int | None = None) -> list[ItemT]:
        """Return the last samples, oldest first: all that are retained, or `most` of them."""
        with self.lock:
            found = [item for item, _ in self._retained]
        return found if most is None else found[-most:]

    def clear(self) -> None:
        """Retain nothing of what has been sent so far."""
        with self.lock:
            self._retained.clear()
            self._bytes = 0
