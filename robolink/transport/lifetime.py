"""Exit and fork handlers of open sessions: closes them at interpreter exit, and disables them in forked children."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator
from typing import Protocol, TypeVar

from robolink.exceptions import TransportClosedError, TransportError
from robolink.system import clocks, exit_code, waits

_Item = TypeVar("_Item")


class Mortal(Protocol):
    """A resource with threads outside Python."""

    def close(self) -> None:
        """Stop these threads."""

    def disown(self) -> None:
        """Refuse every further use: in a forked child the threads do not exist."""


AFTER_FORK = "Zenoh does not survive a fork: start processes by 'spawn', or before the first session is opened"

LAST_WAIT = 3.0
"""Longest wait of the exit for closing sessions and for threads that are inside Zenoh, in seconds.

One with 30 peers takes 0.3 s; four that leave a busy machine at once take 0.7 s and more.
"""

OPENING_WAIT = 0.3
"""The same for sessions that are being opened for nobody any more, in seconds; Zenoh waits 10 s for a silent router."""

_open: weakref.WeakSet[Mortal] = weakref.WeakSet()
_with_goodbye: weakref.WeakSet[Mortal] = weakref.WeakSet()
"""Those of them whose end others would notice late if they did not tell it."""
_unfinished: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
_opening: weakref.WeakSet[threading.Thread] = weakref.WeakSet()
_last: list[object] = []
"""Sessions at the exit, and the exceptions that end daemon threads: kept alive, since freeing them runs Zenoh."""
_inside: set[int] = set()
"""Idents of the threads that are inside Zenoh now."""
_armed = False
_forked = False
_ending = False
_deadline = 0.0
"""End of the exit's wait, by `clocks.monotonic`."""


def watch_over(mortal: Mortal, *, says_goodbye: bool = False) -> None:
    """Register a resource: it is closed at exit if it still exists, and disowned in forked children.

    Args:
        mortal: The resource.
        says_goodbye: Whether others would take it for alive, until its lease ends, if it ended without `close`.
    """
    _arm()
    _open.add(mortal)
    if says_goodbye:
        _with_goodbye.add(mortal)
    if _ending:
        _last.append(mortal)


def forget(mortal: Mortal) -> None:
    """Unregister a resource that has been closed."""
    _open.discard(mortal)
    _with_goodbye.discard(mortal)


def say_goodbye() -> None:
    """Close those that others would miss late, in a process that ends without closing anything else."""
    for mortal in all_of(_with_goodbye):
        with contextlib.suppress(Exception):
            mortal.close()


def finish(work: Callable[[], object], within: float) -> None:
    """Run clean-up work, in the background if it takes longer than `within` seconds."""
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
    waits.wait(done, within)  # no join: before 3.13 Python takes a thread for ended when a Ctrl-C breaks into that


def interruptible(make: Callable[[], _Item], undo: Callable[[_Item], object]) -> _Item:
    """Return the result of `make()`, or raise its error; a Ctrl-C ends the wait at once, not when Zenoh comes back.

    Args:
        make: Function that may be inside Zenoh for seconds; in the main thread it is run on a thread beside.
        undo: Function that gets what was made, if nobody waits for it any more.
    """
    if threading.current_thread() is not threading.main_thread() or _ending:
        return make()
    made, errors, done, is_left = list[_Item](), list[BaseException](), threading.Event(), threading.Event()

    def drop() -> None:
        with contextlib.suppress(IndexError):  # the other thread has done it
            undo(made.pop())

    def work() -> None:
        try:
            made.append(make())
        except BaseException as error:  # noqa: BLE001 - raised where it is waited for
            errors.append(error)
        done.set()
        if is_left.is_set():
            drop()

    thread = threading.Thread(target=work, name="robolink open", daemon=True)
    _opening.add(thread)
    try:
        thread.start()
        while not done.wait(0.05):  # Windows notices a Ctrl-C between two waits
            pass
        if errors:
            raise errors.pop()
        return made.pop()
    except BaseException:
        is_left.set()
        if done.is_set():
            drop()
        raise


class Inside:
    """Context of a thread inside Zenoh, for which the exit waits; a daemon thread cannot enter it during the exit."""

    def __enter__(self) -> None:
        _inside.add(threading.get_ident())
        if _ending:
            self.__exit__()
            end_if_daemon()

    def __exit__(self, *_: object) -> None:
        _inside.discard(threading.get_ident())


inside = Inside()


def outlive(thread: threading.Thread) -> None:
    """Register a thread that is inside Zenoh until its session is closed: the exit waits for it."""
    _unfinished.add(thread)


def end_if_daemon() -> None:
    """End the calling daemon thread silently if the interpreter exits, as Python is about to do."""
    if _ending and threading.current_thread().daemon:
        end = SystemExit()
        _last.append(end)  # its traceback holds what the thread was about to undeclare: it would be freed now
        raise end


def closed(why: str) -> TransportClosedError:
    """Return the error for the use of what is closed; a daemon thread ends silently instead, if that is by the exit."""
    end_if_daemon()
    return TransportClosedError(why)


def is_ending() -> bool:
    """True while the interpreter exits; waiting threads are not notified of anything any more."""
    return _ending


def in_use(entities: list[object]) -> bool:
    """True if a thread is inside a method of one of these entities, to which nobody else refers."""
    (idle,) = (sys.getrefcount(each) for each in [object()])
    return any(sys.getrefcount(each) > idle for each in entities)


def leak(leaked: object) -> None:
    """Leak an object on purpose: in a forked child, freeing it would be a deadlock."""
    import ctypes

    ctypes.pythonapi.Py_IncRef(ctypes.py_object(leaked))


def refuse_if_forked() -> None:
    """Raise TransportError in a forked child of a process that has used Zenoh: without its threads, opening hangs."""
    if _forked:
        raise TransportError(AFTER_FORK)


def close_all() -> None:
    """Close everything at exit; after an interruption by a signal, another call continues in the remaining time."""
    global _ending, _deadline
    _last.extend([*all_of(_open)])
    if not _ending:
        _deadline = clocks.monotonic() + LAST_WAIT
    _ending = True
    with _undisturbed():
        # Before anything is closed: opening a session may take 10 s when the one that it meets is just closing.
        while _inside - {threading.get_ident()} and clocks.monotonic() < _deadline:
            time.sleep(0.001)
        for mortal in all_of(_open):
            with contextlib.suppress(Exception):
                mortal.close()
        _wait_for_the_unfinished(_deadline)
        _end_if_stuck()


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """Replace signal handlers by empty ones: a second Ctrl-C would leave threads inside Zenoh."""
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
    # Where the exit code is known, the process can end without asking them.
    soon = deadline if exit_code.noted() is None else min(deadline, clocks.monotonic() + OPENING_WAIT)
    for thread in (*all_of(_unfinished), *all_of(_opening)):
        with contextlib.suppress(RuntimeError):  # not started: a Ctrl-C came before, or it is about to be
            waits.join(thread, (soon if thread in _opening else deadline) - clocks.monotonic())


def _end_if_stuck() -> None:
    """End the process early if threads are still inside Zenoh, and its exit code is known: they would abort it."""
    own = threading.current_thread()
    waiting = [*all_of(_unfinished), *all_of(_opening)]
    if exit_code.noted() is not None and (_inside - {own.ident} or any(each.is_alive() for each in waiting)):
        exit_code.end_early()


def all_of(them: weakref.WeakSet[_Item]) -> list[_Item]:
    """Return a copy of a set to which other threads may be adding."""
    while True:
        with contextlib.suppress(RuntimeError):  # another thread has just added one
            return list(them)


def _disown_all() -> None:
    global _forked
    _forked = True
    _unfinished.clear()
    _opening.clear()
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
