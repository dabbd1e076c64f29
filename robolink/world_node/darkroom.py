"""Thread that renders and publishes images, one by one, so that the steps of the world go on meanwhile."""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable
from queue import SimpleQueue

from robolink.exceptions import InvalidHandle
from robolink.system import waits

MOST = 10
"""Number of jobs with one key that may wait: a short stall loses nothing."""


class Darkroom:
    """Works off jobs in their order, on one thread, which begins with the first.

    Args:
        warn: Function that is called with a line about what went wrong.
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        self._warn = warn
        self._jobs: SimpleQueue[tuple[object, Callable[[], object]] | None] = SimpleQueue()
        self._waiting: Counter[object] = Counter()
        self._lock = threading.Lock()
        self._thread: threading.Thread | None = None

    def submit(self, key: object, job: Callable[[], object]) -> bool:
        """Put a job in the queue; return False, and do nothing, if `MOST` with this key are waiting."""
        with self._lock:
            if self._waiting[key] >= MOST:
                return False
            self._waiting[key] += 1
        if self._thread is None:
            self._thread = threading.Thread(target=self._work, name="robolink images", daemon=True)
            self._thread.start()
        self._jobs.put((key, job))
        return True

    def close(self) -> None:
        """Do what has been submitted, and end the thread. Safe to call twice."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._jobs.put(None)
            waits.join(thread)

    def _work(self) -> None:
        while (found := self._jobs.get()) is not None:
            key, job = found
            try:
                job()
            except (InvalidHandle, ConnectionError):
                pass  # the robot has left, or the network, since the shot was taken
            except Exception as error:  # noqa: BLE001 - whatever it is, it is told, and later images are rendered
                self._warn(f"an image could not be published: {type(error).__name__}: {error}")
            finally:
                with self._lock:
                    self._waiting[key] -= 1
