"""Blocking waits in slices: each single wait is short, so that Ctrl-C is noticed between two of them.

On Windows Ctrl-C does not interrupt a wait for a lock before Python 3.14, and everything in `threading`, `queue` and
`concurrent.futures` waits for one. `time.sleep` it does interrupt.
"""

from __future__ import annotations

import contextlib
import math
import queue
import threading
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeVar

from robolink.system.queues import get_within

if TYPE_CHECKING:
    from concurrent.futures import Future

A_WHILE = 0.25
"""Longest single wait, in seconds."""

T = TypeVar("T")


def slices(seconds: float | None) -> Iterator[float]:
    """Yield the lengths of the single waits that make up a wait of so many seconds, 0 at least once; None is for ever.

    They are counted instead of looking at a clock: in a host's virtual time the waits of a program go by another one.
    """
    left = math.inf if seconds is None else seconds
    while left > A_WHILE:
        yield A_WHILE
        left -= A_WHILE
    yield max(0.0, left)


def wait(event: threading.Event, seconds: float | None = None) -> bool:
    """Wait until an event is set, for so many seconds at most; return whether it is."""
    return any(event.wait(each) for each in slices(seconds))


def wait_for(changed: threading.Condition, holds: Callable[[], bool], seconds: float | None = None) -> bool:
    """Wait until `holds()`, which is called whenever `changed` is notified; return what it is at last."""
    with changed:
        return any(changed.wait_for(holds, each) for each in slices(seconds))


def join(thread: threading.Thread, seconds: float | None = None) -> bool:
    """Wait until a thread has ended, for so many seconds at most; return whether it has."""
    for each in slices(seconds):
        thread.join(each)
        if not thread.is_alive():
            return True
    return False


def get(source: queue.SimpleQueue[T], seconds: float | None = None) -> T:
    """Return the oldest element; wait for one, for so many seconds at most. Raises queue.Empty."""
    for each in slices(seconds):
        with contextlib.suppress(queue.Empty):
            return get_within(source, each)
    raise queue.Empty


def result(future: Future[T], seconds: float | None = None) -> T:
    """Return the result of a future of `concurrent.futures` as soon as it is there.

    Raises what the other thread raised, and `concurrent.futures.TimeoutError` after so many seconds.
    """
    from concurrent import futures  # late: it takes some milliseconds

    for each in slices(seconds):
        if futures.wait([future], each).done:
            return future.result()
    raise futures.TimeoutError(f"no result within {seconds:g} s")
