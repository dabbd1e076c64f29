"""Event callback (`on_event`): called in order, from one background thread."""

from __future__ import annotations

from collections.abc import Callable

from robolink.supervisor.events import Event, Output
from robolink.supervisor.reporting.background_queue import BackgroundQueue, Troubles

OnEvent = Callable[[Event], object]
_SIZE = 200
"""Approximate size of an event, in bytes, without its line of output."""


class Notifier:
    """Calls `on_event`, which may raise OSError and ValueError when it cannot write."""

    def __init__(self, on_event: OnEvent, troubles: Troubles) -> None:
        self._queue: BackgroundQueue[Event] = BackgroundQueue(
            lambda one: on_event(*one), troubles, name="events", at_once=1
        )

    def put(self, event: Event) -> None:
        """Enqueue an event; only one with output ever blocks. All others are few."""
        if isinstance(event, Output):
            self._queue.put(event, _SIZE + len(event.line))
        else:
            self._queue.put_own(event, _SIZE)

    def close(self, timeout: float = 1.0) -> None:
        """Deliver what waits, for at most `timeout` seconds."""
        self._queue.close(timeout)
