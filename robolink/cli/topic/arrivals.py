"""Recorder of arrivals on topics, for commands that measure: undecoded messages, each with its time of arrival.

A thread of its own empties the queue, so that it does not grow while the terminal is blocked.
"""

from __future__ import annotations

import functools
import queue
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
from robolink.graph.endpoint import ALL_BEST_EFFORT, keys_of, listen, timed_arrival
from robolink.system import clocks, waits
from robolink.transport.base import Handle
from robolink.wire import EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.node import Node

Take = Callable[[Any, int], None]
"""Function of an arrival, for `Transport.read` or `Transport.size`, and its time, in ns of the clock."""


class Arrivals:
    """Listener to topics in all types with which they are published, also by later publishers."""

    def __init__(self, node: Node, clock: Callable[[], int] = clocks.steady) -> None:
        self._node, self._context = node, node.context
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._arrival = timed_arrival(self._queue.put, clock)
        self._listeners: dict[str, Callable[[EndpointToken], Take]] = {}
        self._heard: set[str] = set()
        self._declared: list[Handle] = []
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._drain, name="robolink arrivals", daemon=True)
        self._thread.start()

    def listen(self, topic: str, how: Callable[[EndpointToken], Take]) -> None:
        """Listen to a topic, named in full; `how(publisher)` returns the function for messages of its type."""
        self._listeners[topic] = how
        self.follow()

    def follow(self) -> None:
        """Listen also to the types of new publishers. Raises what a Take has raised."""
        if self._error is not None:
            raise self._error
        for publisher in self._unheard():
            keys = keys_of(publisher) - self._heard
            if keys:
                self._heard |= keys
                self._subscribe(publisher, keys, self._listeners[publisher.name](publisher))

    def wait(self, until: float) -> None:
        """Wait until a time of `monotonic`, and follow meanwhile. Raises KeyboardInterrupt if the context ends."""
        graph, context = self._context.graph, self._context

        def stirred() -> bool:
            return self._error is not None or not context.ok() or bool(self._unheard())

        while True:
            left = until - clocks.monotonic()
            if left > 0:
                graph.wait_for(stirred, left)
            if not context.ok():
                raise KeyboardInterrupt
            self.follow()
            if left <= 0:
                return

    def close(self) -> None:
        """Stop listening."""
        for each in self._declared:
            each.close()
        self._queue.put(None)
        waits.join(self._thread, 1.0)

    def _unheard(self) -> list[EndpointToken]:
        graph = self._context.graph
        publishers = (each for name in self._listeners for each in graph.endpoints(EndpointKind.PUBLISHER, name=name))
        return [each for each in publishers if not keys_of(each) <= self._heard]

    def _subscribe(self, publisher: EndpointToken, keys: set[str], take: Take) -> None:
        sink = functools.partial(self._arrival, take)
        self._declared += listen(self._node._owner_, publisher, keys, ALL_BEST_EFFORT, sink)

    def _drain(self) -> None:
        for arrived in iter(self._queue.get, None):
            try:
                arrived.target(arrived.content, arrived.at)
            except RobolinkError as error:  # told by whoever waits in the main thread
                self._error = error
                self._context.graph.wake()
                return
