"""Subscriptions and publishers of one key within one session: samples go from one to the other without DDS."""

from __future__ import annotations

from collections.abc import Callable
from operator import itemgetter

from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.system.waits import fork_lock
from robolink.transport.base import Sink
from robolink.transport.history import Latch, latched_depth

Pair = tuple[bytes, bytes]
"""Payload and attachment."""
Retaining = Latch[tuple[int, Pair]]


class LocalTopic:
    """One key's subscriptions, and what its latched publishers retain."""

    __slots__ = ("__weakref__", "_latches", "_lock", "sinks")

    def __init__(self) -> None:
        # Held while sinks are called, which only enqueue: so all see one order, and what joins misses and repeats
        # nothing.
        self._lock = fork_lock()
        self.sinks: tuple[Sink, ...] = ()
        self._latches: tuple[Retaining, ...] = ()

    def add_latch(self, qos: QoSProfile) -> Retaining | None:
        """Return the latch of a publisher of this profile; None if it retains nothing."""
        if qos.durability is not DurabilityPolicy.TRANSIENT_LOCAL:
            return None
        latch = Retaining(latched_depth(qos))
        with self._lock:
            self._latches = (*self._latches, latch)
        return latch

    def remove_latch(self, latch: Retaining) -> None:
        """Forget what a publisher retained."""
        with self._lock:
            self._latches = tuple(each for each in self._latches if each is not latch)

    def put(self, pair: Pair, latch: Retaining | None, next_order: Callable[[], int]) -> None:
        """Retain a sample in its publisher's latch, and hand it to each subscription."""
        with self._lock:
            if latch is not None:
                latch.retain((next_order(), pair))
            for sink in self.sinks:
                sink(pair)

    def join(self, sink: Sink, qos: QoSProfile) -> None:
        """Add a subscription; with TRANSIENT_LOCAL it gets what was retained, in the order of publishing."""
        with self._lock:
            if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL:
                depth = latched_depth(qos)
                for _, pair in sorted(
                    (each for latch in self._latches for each in latch.last(depth)), key=itemgetter(0)
                ):
                    sink(pair)
            self.sinks = (*self.sinks, sink)

    def leave(self, sink: Sink) -> None:
        """Remove a subscription."""
        with self._lock:
            self.sinks = tuple(each for each in self.sinks if each is not sink)
