"""Registry of the threads that spin an executor: a thread that is among them is inside a callback."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager

from robolink.system.waits import wait_for


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
        return wait_for(self._left, lambda: {*self.threads} <= {threading.get_ident()}, limit(timeout_sec))

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


def limit(timeout_sec: float | None) -> float | None:
    """Return the limit of a wait as rclpy spells it: a negative one is none."""
    return None if timeout_sec is None or timeout_sec < 0 else timeout_sec
