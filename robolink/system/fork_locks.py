"""Re-entrant locks that a forked child finds free: the thread that held one is not in the child."""

from __future__ import annotations

import os
import threading
import weakref

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
