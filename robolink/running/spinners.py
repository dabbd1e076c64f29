"""Registry of the threads that spin an executor: a thread that is among them is inside a callback."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from robolink.system.queues import A_WHILE


class Spinners:
    """Idents of the threads that spin; one that spins within its own callback is in it twice."""

    def __init__(self, lock: threading.RLock) -> None:
        self.threads: list[int] = []
        self._left = threading.Condition(lock)

    def tell(self) -> None:
        """Wake whoever waits in `wait_for_others`."""
        with self._left:
            self._left.notify_all()

    def wait_for_others(self, timeout_sec: float | None) -> bool:
        """Wait until no other thread spins; False if some still do after `timeout_sec` seconds."""
        return wait_for(self._left, lambda: {*self.threads} <= {threading.get_ident()}, timeout_sec)

    @contextmanager
    def counting_this(self, inside: bool) -> Iterator[None]:
        """Count the calling thread as one that spins, if it is inside a callback of another executor."""
        thread = threading.get_ident()
        if inside:
            self.threads.append(thread)
        try:
            yield
        finally:
            if inside:
                self.threads.remove(thread)


def wait_for(changed: threading.Condition, ended: Callable[[], bool], seconds: float | None) -> bool:
    """Wait until `ended()`, which is asked whenever `changed` is notified; for ever if None or negative.

    It waits by slices, so that a signal is noticed. Returns what `ended()` is at last.
    """
    left = float("inf") if seconds is None or seconds < 0 else seconds
    with changed:
        while not changed.wait_for(ended, min(left, A_WHILE)) and left > 0:
            left -= A_WHILE
        return ended()
