"""What becomes of open sessions when the interpreter exits or the process forks."""

from __future__ import annotations

import atexit
import contextlib
import os
import threading
import time
import weakref
from collections.abc import Callable
from typing import Protocol

from robolink.exceptions import TransportError


class Mortal(Protocol):
    """Something that threads outside Python work for."""

    def close(self) -> None:
        """Stop these threads."""

    def disown(self) -> None:
        """Refuse every further use: this is a forked child, in which the threads are gone."""


AFTER_FORK = "Zenoh does not survive a fork: start processes by 'spawn', or before the first session is opened"

LAST_WAIT = 3.0
"""Seconds that the exit waits for sessions that are still closing.

One with 30 peers takes 0.3 s; four that leave a busy machine at once take 0.7 s and more.
"""

_open: weakref.WeakSet[Mortal] = weakref.WeakSet()
_unfinished: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
_armed = False
_forked = False


def watch_over(mortal: Mortal) -> None:
    """Close it at exit, if it is still there, and disown it in forked children."""
    _arm()
    _open.add(mortal)


def forget(mortal: Mortal) -> None:
    """It has been closed."""
    _open.discard(mortal)


def finish(work: Callable[[], object], within: float) -> None:
    """Do some last work, in the background if it takes longer than `within` seconds."""
    thread = threading.Thread(target=work, name="robolink close", daemon=True)
    try:
        thread.start()
    except RuntimeError:  # Python 3.12 starts no threads any more at exit
        work()
        return
    thread.join(within)
    if thread.is_alive():
        _unfinished.add(thread)


def outlive(thread: threading.Thread) -> None:
    """Have the exit wait for a thread that is inside Zenoh until its session has been closed."""
    _unfinished.add(thread)


def bury(remains: object) -> None:
    """Keep for good what must not even be freed in a forked child, where freeing it waits for ever."""
    import ctypes

    ctypes.pythonapi.Py_IncRef(ctypes.py_object(remains))


def refuse_if_forked() -> None:
    """Raise TransportError in a child of a process that has used Zenoh: its threads are gone, opening would hang."""
    if _forked:
        raise TransportError(AFTER_FORK)


def _close_all() -> None:
    for mortal in list(_open):
        with contextlib.suppress(Exception):
            mortal.close()
    _wait_for_the_unfinished()


def _wait_for_the_unfinished() -> None:
    # A thread that comes back from Zenoh while the interpreter ends aborts the process (Python < 3.14). So most get
    # the time that they need; what takes longer, 10 s for a frozen peer, is not back before the process is gone.
    deadline = time.monotonic() + LAST_WAIT
    for thread in list(_unfinished):
        thread.join(max(0, deadline - time.monotonic()))


def _disown_all() -> None:
    global _forked
    _forked = True
    _unfinished.clear()
    for mortal in list(_open):
        mortal.disown()


def _arm() -> None:
    global _armed
    if _armed:
        return
    _armed = True
    _at_thread_shutdown(_close_all)
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=_disown_all)


def _at_thread_shutdown(close_all: Callable[[], None]) -> None:
    # atexit runs after the interpreter has waited for all threads: too late, since Zenoh's wait for a session to be
    # closed. What concurrent.futures uses runs before; it is private, hence the fallback.
    register = getattr(threading, "_register_atexit", atexit.register)
    register(close_all)
