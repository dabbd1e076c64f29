"""What becomes of open sessions when the interpreter exits or the process forks."""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from typing import Protocol, TypeVar

from robolink.exceptions import TransportError

_Kept = TypeVar("_Kept")


class Mortal(Protocol):
    """Something that threads outside Python work for."""

    def close(self) -> None:
        """Stop these threads."""

    def disown(self) -> None:
        """Refuse every further use: this is a forked child, in which the threads are gone."""


AFTER_FORK = "Zenoh does not survive a fork: start processes by 'spawn', or before the first session is opened"

LAST_WAIT = 3.0
"""Seconds that the exit waits for sessions that are still closing, and for threads that are at work in Zenoh.

One with 30 peers takes 0.3 s; four that leave a busy machine at once take 0.7 s and more.
"""

_open: weakref.WeakSet[Mortal] = weakref.WeakSet()
_unfinished: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
_last: list[object] = []
"""What the exit closes, and with what daemon threads end: held, since what they free as they end is work in Zenoh."""
_inside: set[int] = set()
"""Threads, by their idents, that are just at work in Zenoh."""
_armed = False
_forked = False
_ending = False
_deadline = 0.0
"""When the exit waits no longer, by `time.monotonic`."""


def watch_over(mortal: Mortal) -> None:
    """Close it at exit, if it is still there, and disown it in forked children."""
    _arm()
    _open.add(mortal)
    if _ending:
        _last.append(mortal)


def forget(mortal: Mortal) -> None:
    """It has been closed."""
    _open.discard(mortal)


def finish(work: Callable[[], object], within: float) -> None:
    """Do some last work, in the background if it takes longer than `within` seconds."""
    done = threading.Event()

    def finish_it() -> None:
        try:
            work()
        finally:
            done.set()

    thread = threading.Thread(target=finish_it, name="robolink close", daemon=True)
    _unfinished.add(thread)  # now, since a Ctrl-C may break into all that follows
    try:
        thread.start()
    except RuntimeError:  # Python 3.12 starts no threads any more at exit
        work()
        return
    done.wait(within)  # no join: before 3.13 Python takes a thread for ended when a Ctrl-C breaks into that


class Inside:
    """Within it a thread is at work in Zenoh, and the exit waits for it; not for what a daemon thread begins then."""

    def __enter__(self) -> None:
        _inside.add(threading.get_ident())
        if _ending:
            self.__exit__()
            end_if_daemon()

    def __exit__(self, *_: object) -> None:
        _inside.discard(threading.get_ident())


inside = Inside()


def outlive(thread: threading.Thread) -> None:
    """Have the exit wait for a thread that is inside Zenoh until its session has been closed."""
    _unfinished.add(thread)


def end_if_daemon() -> None:
    """End a daemon thread that wants a session at the exit: quietly, as Python is about to."""
    if _ending and threading.current_thread().daemon:
        end = SystemExit()
        _last.append(end)  # its traceback holds what the thread was about to undeclare: it would be freed now
        raise end


def is_ending() -> bool:
    """Tell whether the interpreter exits: threads that still wait for something are not told of it any more."""
    return _ending


def bury(remains: object) -> None:
    """Keep for good what must not even be freed in a forked child, where freeing it waits for ever."""
    import ctypes

    ctypes.pythonapi.Py_IncRef(ctypes.py_object(remains))


def refuse_if_forked() -> None:
    """Raise TransportError in a child of a process that has used Zenoh: its threads are gone, opening would hang."""
    if _forked:
        raise TransportError(AFTER_FORK)


def close_all() -> None:
    """Close what is open, at exit; what a signal has broken off is done by another call, in the time that is left."""
    global _ending, _deadline
    _last.extend([*all_of(_open)])
    if not _ending:
        _deadline = time.monotonic() + LAST_WAIT
    _ending = True
    with _undisturbed():
        # Before anything is closed: opening a session may take 10 s when the one that it meets is just closing.
        while _inside - {threading.get_ident()} and time.monotonic() < _deadline:
            time.sleep(0.001)
        for mortal in all_of(_open):
            with contextlib.suppress(Exception):
                mortal.close()
        _wait_for_the_unfinished(_deadline)


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """Let no signal raise an exception here: a second Ctrl-C would leave threads in Zenoh."""
    if threading.current_thread() is not threading.main_thread():  # none comes here, as in a Python that is embedded
        yield
        return
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    ours = {number: handler for number, handler in handlers.items() if callable(handler)}
    for number in ours:
        signal.signal(number, lambda number, frame: None)
    try:
        yield
    finally:
        for number, handler in ours.items():
            signal.signal(number, handler)


def _wait_for_the_unfinished(deadline: float) -> None:
    # A thread that comes back from Zenoh while the interpreter ends aborts the process (Python < 3.14). So most get
    # the time that they need; what takes longer, 10 s for a frozen peer, is not back before the process is gone.
    for thread in all_of(_unfinished):
        with contextlib.suppress(RuntimeError):  # not started: a Ctrl-C came before, or it is about to be
            thread.join(max(0, deadline - time.monotonic()))


def all_of(them: weakref.WeakSet[_Kept]) -> list[_Kept]:
    """List what is in a set to which other threads may be adding."""
    while True:
        with contextlib.suppress(RuntimeError):  # another thread has just added one
            return list(them)


def _disown_all() -> None:
    global _forked
    _forked = True
    _unfinished.clear()
    _inside.clear()
    for mortal in list(_open):
        mortal.disown()


def _arm() -> None:
    global _armed
    if _armed:
        return
    _armed = True
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=_disown_all)
