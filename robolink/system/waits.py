"""Blocking waits in slices, each so short that Ctrl-C is noticed between two of them; locks that a fork finds free.

On Windows Ctrl-C does not interrupt a wait for a lock before Python 3.14, and everything in `threading`, `queue` and
`concurrent.futures` waits for one. `time.sleep` it does interrupt.
"""

from __future__ import annotations

import contextlib
import math
import os
import queue
import threading
import weakref
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from concurrent.futures import Future

A_WHILE = 0.25
"""Longest single wait, in seconds: a signal just before a wait begins would be noticed only at its end."""

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


# Locks

_locks: weakref.WeakSet[threading.RLock] = weakref.WeakSet()


def fork_lock() -> threading.RLock:
    """Return a new lock, like `threading.RLock`, that is free in each child of a fork."""
    lock = threading.RLock()
    _locks.add(lock)
    return lock


def _free() -> None:
    for each in list(_locks):
        # In place, since others hold its methods; Python's own modules free theirs in this way.
        each._at_fork_reinit()  # type: ignore[attr-defined]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_free)
