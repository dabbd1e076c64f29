"""Patches of Python's locks and simple queues: a hosted program that waits for one lets the other programs go on.

Python's own block in C, where a host only notices after a while that nothing goes on. What Python's modules make for
themselves stays Python's, but for the queue from which a pool of threads takes its work: nobody waits while holding it.
"""

from __future__ import annotations

import _thread
import queue
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import thread as pools
from typing import TYPE_CHECKING, Any, NoReturn

from robolink.host.call_sites import is_users
from robolink.host.participants import Killed, ProgramLike, runner_of, wait_until
from robolink.running.defaults import get_defaults

if TYPE_CHECKING:
    from robolink.running.timebase import TimeBase

REAL: dict[str, Any] = {"Lock": threading.Lock, "RLock": threading.RLock, "SimpleQueue": queue.SimpleQueue}
"""Python's own classes, by name."""

_real_condition = threading.Condition.__init__


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {
        "threading.Condition.__init__": make_condition,
        "threading.Lock": Lock,
        "threading.RLock": RLock,
        "queue.SimpleQueue": SimpleQueue,
    }


def imported() -> Iterator[tuple[Any, Any]]:
    """Yield each class of Python's with its replacement, for modules that imported it earlier."""
    return ((REAL[each.__name__], each) for each in (Lock, RLock, SimpleQueue))


def _is_for_program() -> bool:
    """True if it is a hosted program's own code that makes one."""
    program: ProgramLike | None = get_defaults().program
    return program is not None and is_users(sys._getframe(2).f_code.co_filename)


def make_condition(condition: Any, lock: Any = None) -> None:
    """Make a `threading.Condition`; a program's has an RLock of these, since it may wait while it holds it.

    It takes the place of `Condition.__init__`.
    """
    if lock is None and _is_for_program():
        lock = object.__new__(RLock)
        lock.__init__()
    _real_condition(condition, lock)


class Lock:
    """Replacement of `threading.Lock`; code that is not a program's gets Python's.

    Who comes while others wait for it lets them go first: else whoever takes it again and again would keep it for ever.
    """

    __slots__ = ("__weakref__", "_at_fork_reinit", "_lock", "_waiting", "locked", "release")

    def __new__(cls) -> Any:
        """Return a lock of this class, or Python's."""
        return super().__new__(cls) if _is_for_program() else REAL["Lock"]()

    def __init__(self) -> None:
        lock: Any = _thread.allocate_lock()
        self._lock: _thread.LockType = lock
        self.locked, self.release, self._at_fork_reinit = lock.locked, lock.release, lock._at_fork_reinit
        self._waiting = 0
        """Number of threads that wait for it in virtual time."""

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Acquire it, within `timeout` virtual seconds. Return True if that succeeded."""
        if not blocking or (timeout < 0 and timeout != -1):
            return self._lock.acquire(blocking, timeout)
        if not self._waiting and self._lock.acquire(False):
            return True
        program: ProgramLike | None = get_defaults().program
        if program is None or runner_of(program) is None:
            return self._lock.acquire(blocking, timeout)
        return self._wait(program, timeout)

    def _wait(self, program: ProgramLike, timeout: float) -> bool:
        left = None if timeout == -1 else timeout
        time, begin = program.time, program.time.steady()
        if self._waiting:
            time.sleep(0)
        while not self._lock.acquire(False):
            if left is not None and left < 0:
                return False
            self._waiting += 1
            try:
                wait_until(time, lambda: not self._lock.locked(), left)
            finally:
                self._waiting -= 1
            left = None if left is None else _left(time, begin, timeout)
        return True

    def __enter__(self) -> bool:
        return (not self._waiting and self._lock.acquire(False)) or self.acquire()

    def __exit__(self, *_: object) -> None:
        self.release()

    def __repr__(self) -> str:
        return repr(self._lock)

    def __reduce__(self) -> NoReturn:
        """Raise TypeError, as Python's do: a copy would be held by nobody."""
        raise TypeError(f"cannot pickle {type(self).__name__!r} object")


class RLock(threading._PyRLock):  # type: ignore[name-defined,misc] # Python's own, written in Python
    """Replacement of `threading.RLock`; code that is not a program's gets Python's."""

    def __new__(cls) -> Any:
        """Return a lock of this class, or Python's."""
        return super().__new__(cls) if _is_for_program() else REAL["RLock"]()

    def __init__(self) -> None:
        super().__init__()
        self._block = _OfRLock()

    def __reduce__(self) -> NoReturn:
        """Raise TypeError, as Python's do."""
        raise TypeError(f"cannot pickle {type(self).__name__!r} object")


class _OfRLock(Lock):
    """The lock inside an `RLock`."""

    __slots__ = ()

    def __new__(cls) -> Any:
        return object.__new__(cls)


class SimpleQueue:
    """Replacement of `queue.SimpleQueue`; code that is not a program's gets Python's."""

    def __new__(cls) -> Any:
        """Return a queue of this class, or Python's; of a derived class always an object of that."""
        is_ours = cls is not SimpleQueue or _is_for_program()
        return super().__new__(cls) if is_ours else REAL["SimpleQueue"]()

    def __init__(self) -> None:
        self._take_from(REAL["SimpleQueue"]())

    def _take_from(self, items: Any) -> None:
        self._items = items
        self.put, self.put_nowait = items.put, items.put_nowait  # in C: whatever breaks in may put something, too
        self.get_nowait, self.empty, self.qsize = items.get_nowait, items.empty, items.qsize

    @classmethod
    def around(cls, items: Any) -> SimpleQueue:
        """Return a queue with the items of one of Python's."""
        made: SimpleQueue = object.__new__(cls)
        made._take_from(items)
        return made

    def __class_getitem__(cls, _: Any) -> type[SimpleQueue]:
        """Return the class itself, as `SimpleQueue[int]` is only a type."""
        return cls

    def get(self, block: bool = True, timeout: float | None = None) -> Any:
        """Take the oldest; wait for one, with `timeout` for so many virtual seconds. Raises queue.Empty."""
        program: ProgramLike | None = get_defaults().program
        runner = runner_of(program)
        if program is None or runner is None or not block or (timeout is not None and timeout < 0):
            return self._items.get(block, timeout)
        if runner.killed:
            raise Killed
        runner.is_idle = sys._getframe(1).f_code.co_filename == pools.__file__
        try:
            return self._wait(program.time, timeout)
        finally:
            runner.is_idle = False

    def _wait(self, time: TimeBase, timeout: float | None) -> Any:
        left, begin = timeout, time.steady()
        while True:
            try:
                return self._items.get_nowait()
            except queue.Empty:
                if left is not None and left < 0:
                    raise
            wait_until(time, lambda: not self._items.empty(), left)
            left = None if timeout is None else _left(time, begin, timeout)


def _left(time: TimeBase, begin: int, timeout: float) -> float:
    """Return how many seconds are left; less than 0 once there are none."""
    left = timeout - (time.steady() - begin) / 1e9
    return left if left > 0 else -1.0


def work_in_turns(worker: threading.Thread) -> None:
    """Let a thread of one of Python's pools wait for work in virtual time."""
    args = vars(worker)["_args"]
    vars(worker)["_args"] = tuple(
        SimpleQueue.around(each) if type(each) is REAL["SimpleQueue"] else each for each in args
    )
