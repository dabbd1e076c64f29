"""What arrives on topics, each with the moment at which it did, undecoded: for commands that measure.

The moment is taken where the network hands a message over, not where somebody gets round to looking at it: a queue
that is long because the reader is slow changes no figure. What the network calls is C from end to end, as in
`robolink.inbox`: a Struct class whose default factory reads the clock and whose `__post_init__` is a queue's `put`.
A thread of its own takes what arrived off the queue, so that a blocked terminal piles up nothing.
"""

from __future__ import annotations

import functools
import queue
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import msgspec

from robolink import systemclock
from robolink.exceptions import RobolinkError
from robolink.qos import HistoryPolicy, QoSProfile, ReliabilityPolicy
from robolink.transport.base import Handle
from robolink.wire import CPU_BACKEND, DataKey, EndpointKind, EndpointToken, buffer_key, format_key

if TYPE_CHECKING:
    from robolink.node import Node

Take = Callable[[Any, int], None]
"""Called with what arrived, for `Transport.read` or `Transport.size`, and when: nanoseconds of the clock."""

QOS = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.BEST_EFFORT)


class Arrivals:
    """Listens to topics in whatever types they are published, those of later publishers too."""

    def __init__(self, node: Node, clock: Callable[[], int] = systemclock.steady) -> None:
        self._node, self._context = node, node.context
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = msgspec.defstruct(
            "Arrival",
            ["take", "content", ("at", int, msgspec.field(default_factory=clock))],
            namespace={"__post_init__": self._queue.put},
            gc=False,
        )
        self._listeners: dict[str, Callable[[EndpointToken], Take]] = {}
        self._heard: set[str] = set()
        self._declared: list[Handle] = []
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._drain, name="robolink arrivals", daemon=True)
        self._thread.start()

    def listen(self, topic: str, how: Callable[[EndpointToken], Take]) -> None:
        """Listen to a topic, named in full; `how(publisher)` gives what takes the messages of its type."""
        self._listeners[topic] = how
        self.follow()

    def follow(self) -> None:
        """Listen also to the types that new publishers have brought. Raises what went wrong in a Take."""
        if self._error is not None:
            raise self._error
        for publisher in self._unheard():
            keys = _keys(publisher) - self._heard
            if keys:
                self._heard |= keys
                self._subscribe(publisher, keys, self._listeners[publisher.name](publisher))

    def wait(self, until: float) -> None:
        """Wait until this moment of `time.monotonic`, and follow meanwhile. Raises KeyboardInterrupt at the end."""
        graph, context = self._context.graph, self._context

        def stirred() -> bool:
            return self._error is not None or not context.ok() or bool(self._unheard())

        while True:
            left = until - time.monotonic()
            if left > 0:
                graph.wait_for(stirred, left)
            if not context.ok():
                raise KeyboardInterrupt
            self.follow()
            if left <= 0:
                return

    def close(self) -> None:
        """Listen no longer."""
        for each in self._declared:
            each.close()
        self._queue.put(None)
        self._thread.join(1.0)

    def _unheard(self) -> list[EndpointToken]:
        graph = self._context.graph
        publishers = (each for name in self._listeners for each in graph.endpoints(EndpointKind.PUBLISHER, name=name))
        return [each for each in publishers if not _keys(each) <= self._heard]

    def _subscribe(self, publisher: EndpointToken, keys: set[str], take: Take) -> None:
        transport, owner = self._context.transport, self._node._owner_
        for key in sorted(keys):
            self._declared.append(transport.subscribe(key, QOS, functools.partial(self._arrival, take)))
        own = EndpointToken(
            publisher.domain,
            transport.session_id,
            owner.node_id,
            self._context.next_id(),
            EndpointKind.SUBSCRIPTION,
            owner.enclave,
            owner.namespace,
            owner.node_name,
            *publisher[8:11],
            QOS,
            CPU_BACKEND if publisher.names_backends else "",
        )
        self._declared.append(self._context.graph.announce(own))

    def _drain(self) -> None:
        for arrived in iter(self._queue.get, None):
            try:
                arrived.take(arrived.content, arrived.at)
            except RobolinkError as error:  # told by whoever waits in the main thread
                self._error = error
                self._context.graph.wake()
                return


def _keys(publisher: EndpointToken) -> set[str]:
    """Where a publisher's messages may come."""
    key = format_key(DataKey(publisher.domain, publisher.name, publisher.type_name, publisher.type_hash))
    return {key, buffer_key(key)} if publisher.names_backends else {key}
