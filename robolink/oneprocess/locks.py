"""Locks and queues that hosted programs make: in virtual time whoever waits for one lets the others go on.

Python's own block in C, where a host only notices after a while that nothing goes on. What Python's modules make for
themselves stays Python's: nobody waits while holding such a lock.
"""

from __future__ import annotations

import _thread
import queue
import sys
import threading
from typing import TYPE_CHECKING, Any

from robolink.defaults import get_defaults
from robolink.oneprocess.places import is_users
from robolink.oneprocess.turn_taking import runner_of, wait_until

if TYPE_CHECKING:
    from robolink.oneprocess.program import Program

REAL: dict[str, Any] = {"Lock": threading.Lock, "RLock": threading.RLock, "SimpleQueue": queue.SimpleQueue}


def _is_for_program() -> bool:
    """Whether it is a hosted program's own code, in virtual time, that makes one."""
    program: Program | None = get_defaults().program
    return program is not None and program.host.turns is not None and is_users(sys._getframe(2).f_code.co_filename)


class Lock:
    """`threading.Lock` while there is a host; for everybody but its programs it gives Python's."""

    __slots__ = ("_lock", "locked", "release")

    def __new__(cls) -> Any:
        """Give a lock to whoever asks."""
        return super().__new__(cls) if _is_for_program() else REAL["Lock"]()

    def __init__(self) -> None:
        self._lock = _thread.allocate_lock()
        self.locked, self.release = self._lock.locked, self._lock.release

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Take it; whether that was possible, with `timeout` within so many virtual seconds."""
        if self._lock.acquire(False):
            return True
        program: Program | None = get_defaults().program
        if not blocking or program is None or runner_of(program) is None or (timeout < 0 and timeout != -1):
            return self._lock.acquire(blocking, timeout)
        time = program.time
        begin = time.steady()
        while not self._lock.acquire(False):
            left = None if timeout == -1 else timeout - (time.steady() - begin) / 1e9
            if left is not None and left <= 0:
                return False
            wait_until(time, lambda: not self._lock.locked(), left)
        return True

    def __enter__(self) -> bool:
        return self.acquire()

    def __exit__(self, *_: object) -> None:
        self.release()


class RLock(threading._PyRLock):  # type: ignore[name-defined,misc] # Python's own, written in Python
    """`threading.RLock` while there is a host; for everybody but its programs it gives Python's."""

    def __new__(cls) -> Any:
        """Give a lock to whoever asks."""
        return super().__new__(cls) if _is_for_program() else REAL["RLock"]()

    def __init__(self) -> None:
        super().__init__()
        self._block = _OfRLock()


class _OfRLock(Lock):
    """The lock in an `RLock`."""

    def __new__(cls) -> Any:
        return object.__new__(cls)


class SimpleQueue(queue._PySimpleQueue):  # type: ignore[name-defined,misc] # Python's own, written in Python
    """`queue.SimpleQueue` while there is a host; for everybody but its programs it gives Python's."""

    def __new__(cls) -> Any:
        """Give a queue to whoever asks, and an object of a class that was derived from this one."""
        is_ours = cls is not SimpleQueue or _is_for_program()
        return super().__new__(cls) if is_ours else REAL["SimpleQueue"]()
