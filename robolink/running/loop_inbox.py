"""Inbox of a node on an event loop: whatever arrives in it rouses the loop, from any thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from robolink.running.inbox import Inbox, arrival_type


class LoopInbox(Inbox):
    """Inbox that calls `rouse` when something arrives, in whatever thread that is.

    Args:
        rouse: Function that lets the loop look into the inbox soon; quick, and safe to call from any thread.
        threaded: True if threads of the network deliver. These may run no Python (see `running/inbox.py`): a thread
            waits for them here, and rouses the loop in their place.
    """

    def __init__(self, rouse: Callable[[], object], *, threaded: bool) -> None:
        super().__init__()
        self._rouse = rouse
        self._is_closed = False
        if threaded:
            threading.Thread(target=self._listen, name="robolink async node", daemon=True).start()
        else:
            self._arrival = arrival_type(self._put)

    def _put(self, arrival: Any) -> None:
        self._queue.put(arrival)
        self._rouse()

    def _listen(self) -> None:
        while not self._is_closed:
            arrival = self.get()
            if arrival is not None:
                self.deliver(arrival)
                self.sweep()
                self._rouse()

    def wake(self) -> None:
        """Rouse the loop."""
        self._rouse()

    def clear(self) -> None:
        """Deliver all that is here, for any thread, and rouse the loop."""
        if not self.empty():
            self.sweep()
            self._rouse()

    def close(self) -> None:
        """Listen no more."""
        self._is_closed = True
        self._queue.put(None)
