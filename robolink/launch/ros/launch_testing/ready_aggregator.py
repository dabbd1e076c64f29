"""Function that calls another one once it was called itself so many times."""

from __future__ import annotations

import threading
from collections.abc import Callable


class ReadyAggregator:
    """Calls a function when all of several parts are ready.

    Args:
        ready_fn: The function, which is called once.
        num_to_aggregate: Number of calls of this object's own `ready_fn` that it takes.
    """

    def __init__(self, ready_fn: Callable[[], object], num_to_aggregate: int) -> None:
        self._whole_is_ready, self._left = ready_fn, num_to_aggregate
        self._lock = threading.Lock()

    def ready_fn(self) -> None:
        """Note that one part is ready; on any thread."""
        with self._lock:
            self._left -= 1
            is_last = self._left == 0
        if is_last:  # outside of the lock: the function may take others
            self._whole_is_ready()
