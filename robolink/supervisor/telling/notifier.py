"""Hand events to a function, in order and from one thread."""

from __future__ import annotations

from collections.abc import Callable

from robolink.supervisor.events import Event, Output
from robolink.supervisor.telling.courier import Courier, Troubles

OnEvent = Callable[[Event], object]
_SIZE = 200
"""Bytes that an event takes, about, besides a line of output."""


class Notifier:
    """Calls `on_event`, which may raise OSError and ValueError when it cannot write."""

    def __init__(self, on_event: OnEvent, troubles: Troubles) -> None:
        self._courier: Courier[Event] = Courier(lambda one: on_event(*one), troubles, name="events", at_once=1)

    def put(self, event: Event) -> None:
        """Hand over an event; only one of output ever waits. All others are few."""
        if isinstance(event, Output):
            self._courier.put(event, _SIZE + len(event.line))
        else:
            self._courier.put_own(event, _SIZE)

    def close(self, timeout: float = 1.0) -> None:
        """Hand over what waits, for at most `timeout` seconds."""
        self._courier.close(timeout)
