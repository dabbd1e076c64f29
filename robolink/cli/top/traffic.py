"""Traffic counters of every topic: messages, bytes, the last arrival, and gaps in the publishers' numbering.

Nothing is decoded and no payload is copied. The callback of the network is C from end to end
(`running.timed_arrivals`), and a thread of its own empties the queue.
"""

from __future__ import annotations

import functools
import queue
import threading
from collections import defaultdict
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import RobolinkError, TransportClosedError
from robolink.graph.endpoint import ALL_BEST_EFFORT, keys_of, listen, timed_arrival
from robolink.graph.graph import EVERY
from robolink.system import clocks, waits
from robolink.wire import EndpointKind, EndpointToken, is_attachment, unpack_attachment

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.transport.base import Handle


class Count(NamedTuple):
    """Traffic since the beginning: `last` is the time of the last arrival, in ns of the steady clock, 0 for none."""

    messages: int = 0
    bytes: int = 0
    lost: int = 0
    last: int = 0


class _Counter:
    """Counter of one publisher's messages, or of those of unknown senders, on a topic."""

    __slots__ = ("bytes", "last", "lost", "messages", "sequence")

    def __init__(self) -> None:
        self.messages = self.bytes = self.lost = self.last = self.sequence = 0

    def add(self, size: int, at: int, sequence: int) -> None:
        """Count a message; numbers that are missing between it and the one before are lost messages."""
        if self.sequence and sequence > self.sequence:
            self.lost += sequence - self.sequence - 1
        self.sequence = sequence
        self.messages += 1
        self.bytes += size
        self.last = at

    def count(self) -> Count:
        return Count(self.messages, self.bytes, self.lost, self.last)


class Traffic:
    """Listener to every topic of a node's domain, those that come later included.

    Args:
        node: Node whose subscriptions they are. It must be hidden: commands' nodes are.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._transport = node.context.transport
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = timed_arrival(self._queue.put, clocks.steady)
        self._counters: defaultdict[str, defaultdict[bytes, _Counter]] = defaultdict(lambda: defaultdict(_Counter))
        self._lock = threading.Lock()
        self._heard: set[str] = set()
        self._handles: list[Handle] = []
        self._thread = threading.Thread(target=self._drain, name="robolink traffic", daemon=True)
        self._thread.start()
        self._following = node.context.graph.follow(EVERY, EndpointKind.PUBLISHER, self._on_publisher)

    def counts(self) -> dict[tuple[str, bytes], Count]:
        """Return the counts of each topic and publisher, by the topic's name and the publisher's gid."""
        with self._lock:
            return {
                (name, gid): counter.count()
                for name, senders in self._counters.items()
                for gid, counter in senders.items()
            }

    def close(self) -> None:
        """Stop listening."""
        self._following.close()
        for each in self._handles:
            each.close()
        self._queue.put(None)
        waits.join(self._thread, 1.0)

    def _on_publisher(self, gid: bytes, token: EndpointToken, alive: bool) -> None:
        keys = keys_of(token) - self._heard
        if not alive or not keys:
            return
        self._heard |= keys
        try:
            sink = functools.partial(self._arrival, token.name)
            self._handles += listen(self._node._owner_, token, keys, ALL_BEST_EFFORT, sink)
        except TransportClosedError:  # the command ends just now
            return

    def _drain(self) -> None:
        transport = self._transport
        for arrived in iter(self._queue.get, None):
            try:
                size, attachment = transport.size(arrived.content), transport.attachment(arrived.content)
            except RobolinkError:  # overwritten by its sender while it waited
                continue
            sequence, gid = 0, b""
            if is_attachment(attachment):
                sequence, _, gid = unpack_attachment(attachment)
            with self._lock:
                self._counters[arrived.target][gid].add(size, arrived.at, sequence)
