"""Hand events to a function, in order and from one thread, so that a slow one holds up no decision."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable

from robolink.supervisor.events import Event, Output

OnEvent = Callable[[Event], object]
_QUEUED = 1000
"""Lines of output that may wait; then the process that prints waits. All other events are few: they always may."""


class Notifier:
    """Calls `on_event`; when that cannot write, since nobody reads any more, `on_broken`, and then neither."""

    def __init__(self, on_event: OnEvent, on_broken: Callable[[], object]) -> None:
        self._on_event = on_event
        self._on_broken = on_broken
        self._events: queue.SimpleQueue[Event | None] = queue.SimpleQueue()
        self._room = threading.Semaphore(_QUEUED)
        self._thread = threading.Thread(target=self._work, name="events", daemon=True)
        self._thread.start()

    def put(self, event: Event) -> None:
        """Hand over an event; only one of output ever waits."""
        if isinstance(event, Output):
            self._room.acquire()
        self._events.put(event)

    def close(self, timeout: float = 1.0) -> None:
        """Hand over what waits, for at most `timeout` seconds."""
        self._events.put(None)
        self._thread.join(timeout)

    def _work(self) -> None:
        is_broken = False
        while (event := self._events.get()) is not None:
            if isinstance(event, Output):
                self._room.release()
            if is_broken:
                continue
            try:
                self._on_event(event)
            except (OSError, ValueError):  # a closed pipe or a closed file
                is_broken = True
                self._on_broken()
