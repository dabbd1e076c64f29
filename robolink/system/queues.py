"""Queue `get` with a timeout, without a deadlock of Python before 3.13."""

from __future__ import annotations

import queue
from typing import TypeVar

T = TypeVar("T")


def get_within(source: queue.SimpleQueue[T], seconds: float) -> T:
    """Return the oldest element; wait for one, in one piece, for at most `seconds`. Raises queue.Empty.

    `source.get(timeout=...)` alone may wait for ever before Python 3.13, if the time is shorter than the call itself: a
    `get_nowait` that finds something leaves the queue's lock open; the call passes through it, works out what is left
    of its time, and takes less than nothing for no limit. A `get_nowait` that finds nothing shuts the lock.
    """
    try:
        return source.get_nowait()
    except queue.Empty:
        if seconds <= 0:
            raise
    return source.get(timeout=seconds)
