"""Patches of Python's threads and conditions: a program's threads take turns with all others of the host.

Who waits at a `threading.Condition` (and so at an Event, a Queue, a Semaphore, a Future ...) or joins a thread lets the
others go on. The threads of `concurrent.futures` are threads of the program whose work made the pool start them.
"""

from __future__ import annotations

import _thread
import logging
import sys
import threading
from concurrent.futures import _base as futures
from concurrent.futures import thread as pools
from typing import Any

from robolink.host.call_sites import is_users, note_use
from robolink.host.participants import Killed, ProgramLike, runner_of, wait_until
from robolink.host.patches import locks
from robolink.host.threads import Worker, take_part
from robolink.running.defaults import get_defaults

_real_start, _real_join, _real_wait = threading.Thread.start, threading.Thread.join, threading.Condition.wait


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {
        "threading.Thread.start": _start,
        "threading.Thread.join": _join,
        "threading.Condition.wait": _wait,
        "concurrent.futures._base.LOGGER.filters": [*futures.LOGGER.filters, _is_no_end],
    }


def _is_no_end(record: logging.LogRecord) -> bool:
    """Return False for the mere end of a program, which a thread of one of its pools has met."""
    return record.exc_info is None or not isinstance(record.exc_info[1], Killed)


def _start(thread: threading.Thread) -> None:
    program: ProgramLike | None = get_defaults().program
    if program is None:
        return _real_start(thread)
    caller = sys._getframe(1)
    if is_users(caller.f_code.co_filename):
        note_use(program, "threading.Thread", caller)
    runner = runner_of(program)
    if runner is None:
        return _real_start(thread)
    runner.is_real = True  # Python waits until the thread runs
    try:
        if isinstance(thread, Worker):
            return _real_start(thread)
        if _awaits_process(thread):
            _real_start(thread)
            return program.host.scheduler.real_waits.add_thread(thread, program)
        if getattr(getattr(thread, "_target", None), "__module__", "") == pools.__name__:
            locks.work_in_turns(thread)
        return take_part(thread, program, _real_start)
    finally:
        runner.is_real = False


def _awaits_process(thread: threading.Thread) -> bool:
    """Return True for a thread in which asyncio waits for the end of a process."""
    return getattr(getattr(thread, "_target", None), "__qualname__", "").endswith("ThreadedChildWatcher._do_waitpid")


def _join(thread: threading.Thread, timeout: float | None = None) -> None:
    program: ProgramLike | None = get_defaults().program
    joined = getattr(thread, "_robolink_runner", None)
    if program is None or joined is None or runner_of(program) is None:
        return _real_join(thread, timeout)
    wait_until(program.time, lambda: joined.is_done, timeout)
    return _real_join(thread) if joined.is_done else None


def _wait(condition: Any, timeout: float | None = None) -> bool:
    program: ProgramLike | None = get_defaults().program
    if program is None or runner_of(program) is None:
        return _real_wait(condition, timeout)
    if timeout is not None and timeout <= 0 and sys._getframe(2).f_code.co_filename == pools.__file__:
        return False  # whether a thread of a pool is idle: the pool's own lock is held meanwhile
    if not condition._is_owned():
        raise RuntimeError("cannot wait on un-acquired lock")
    waiter = _thread.allocate_lock()
    waiter.acquire()
    condition._waiters.append(waiter)
    saved = condition._release_save()
    try:
        wait_until(program.time, lambda: not waiter.locked(), timeout)
    finally:
        condition._acquire_restore(saved)
        if waiter.locked() and waiter in condition._waiters:
            condition._waiters.remove(waiter)
    return not waiter.locked()
