"""What hosted programs do by the computer's own time: `time.sleep`, threads. It is noted, and taken as virtual time.

Another process that they start is noted, too, but goes by its own time.

While there is a host, some functions of Python's are replaced by ones that look who calls. For a hosted program
`time.sleep` and the clocks of `time` are the host's, a thread that it starts takes turns with all others, and so does
who waits for a lock or at a `threading.Condition` (and so at an Event, a Queue, a Semaphore, a Future ...), or joins a
thread. The threads of `concurrent.futures` are threads of the program whose work made the pool start them.
Everybody else gets what Python gives.
"""

from __future__ import annotations

import _thread
import logging
import math
import queue
import signal
import subprocess
import sys
import threading
import time
import types
from collections.abc import Callable
from concurrent.futures import _base as futures
from concurrent.futures import thread as pools
from typing import Any, NamedTuple

from robolink.defaults import get_defaults
from robolink.exceptions import InterruptedByUser
from robolink.oneprocess import chance, event_loops, locks
from robolink.oneprocess.parts import Killed
from robolink.oneprocess.places import is_users, place_of
from robolink.oneprocess.program import Program
from robolink.oneprocess.real_time import RealPace
from robolink.oneprocess.threads import go_along, take_part
from robolink.oneprocess.turn_taking import runner_of, wait_until
from robolink.oneprocess.workers import Worker


class RealTimeUse(NamedTuple):
    """Something that a program did by real time: what, and where in its code (``file:line``)."""

    program: str
    what: str
    place: str


_CALENDAR = ("localtime", "gmtime", "ctime", "asctime", "strftime")
"""What takes the clock's time where it is given none; its last argument."""

_CALL_FOR_OTHERS = (threading.__file__, pools.__file__)
"""What sleeps for nobody but who says so: ``Thread(target=time.sleep)``, ``pool.submit(time.sleep, 1.0)``."""

_CLOCKS = ("time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns")
_real = {name: getattr(time, name) for name in (*_CLOCKS, *_CALENDAR, "sleep")}
_real_start, _real_join, _real_wait = threading.Thread.start, threading.Thread.join, threading.Condition.wait
_real_handle, _real_popen = signal.signal, subprocess.Popen.__init__
_before: list[tuple[Any, str, Any]] = []
_hosts = 0
_counting = threading.Lock()


def install() -> None:
    """Have Python's functions look who calls; once for each host."""
    global _hosts
    with _counting:
        _hosts += 1
        if _hosts > 1:
            return
        for owner, name, function in _replacements():
            _before.append((owner, name, getattr(owner, name)))
            setattr(owner, name, function)


def uninstall() -> None:
    """Give Python's functions back, after the last host."""
    global _hosts
    with _counting:
        _hosts -= 1
        if _hosts:
            return
        while _before:
            setattr(*_before.pop())


def _replacements() -> list[tuple[Any, str, Any]]:
    return [
        *((time, name, function) for name, function in _REPLACED.items()),
        (threading.Thread, "start", _start),
        (threading.Thread, "join", _join),
        (threading.Condition, "wait", _wait),
        (threading.Condition, "__init__", locks.make_condition),
        (threading, "Lock", locks.Lock),
        (threading, "RLock", locks.RLock),
        (threading, "_time", _steady),
        (queue, "SimpleQueue", locks.SimpleQueue),
        (queue, "time", _steady),
        (futures, "time", types.SimpleNamespace(monotonic=_steady)),
        (futures.LOGGER, "filters", [*futures.LOGGER.filters, _is_no_end]),
        (signal, "signal", _handle),
        (subprocess.Popen, "__init__", _popen),
        *chance.replacements(),
        *event_loops.replacements(),
    ]


def adopt(module: types.ModuleType | None) -> None:
    """Replace what a module has imported before there was a host: ``from time import sleep``."""
    replaced = {id(_real[name]): function for name, function in _REPLACED.items()}
    replaced |= {id(real): getattr(locks, name) for name, real in locks.REAL.items()}
    for name, value in list(vars(module).items()) if module is not None else ():
        if id(value) in replaced:
            setattr(module, name, replaced[id(value)])


# Who calls


def _note(program: Program, what: str, frame: types.FrameType) -> None:
    if place := place_of(frame):  # else it was told of where the thread was started
        program.host.note_real_time(program, what, place)


# What is replaced


def _sleep(seconds: float, /) -> None:
    program: Program | None = get_defaults().program
    caller = sys._getframe(1)
    file = caller.f_code.co_filename
    if program is not None and (is_users(file) or file in _CALL_FOR_OTHERS):
        _note(program, "time.sleep", caller)
        if seconds >= 0 and runner_of(program) is not None:
            if seconds:
                program.time.sleep(math.ceil(seconds * 1e9))  # the rest of a span, however short, must come to its end
            else:
                program.time.pass_on()
            return
        if seconds >= 0 and program.defaults.in_main_thread():
            program.on_read()
            if program.interrupted.wait(seconds):
                program.interrupted.clear()
                raise InterruptedByUser
            return
    _real["sleep"](seconds)


def _clock(name: str, show: Callable[[Program], Any]) -> Callable[[], Any]:
    real = _real[name]

    def shown() -> Any:
        program: Program | None = get_defaults().program
        if program is None or program.host.turns is None or not is_users(sys._getframe(1).f_code.co_filename):
            return real()
        return show(program)

    shown.__name__ = name
    return shown


def _calendar(name: str) -> Callable[..., Any]:
    real, localtime, before = _real[name], _real["localtime"], 1 if name == "strftime" else 0

    def shown(*given: Any) -> Any:
        program: Program | None = get_defaults().program
        is_given = len(given) > before and given[-1] is not None
        if (
            is_given
            or program is None
            or program.host.turns is None
            or not is_users(sys._getframe(1).f_code.co_filename)
        ):
            return real(*given)
        now = program.time.now() / 1e9
        return real(*given[:before], localtime(now) if name in ("asctime", "strftime") else now)

    shown.__name__ = name
    return shown


_REPLACED: dict[str, Any] = {
    **{name: _calendar(name) for name in _CALENDAR},
    "sleep": _sleep,
    "time": _clock("time", lambda program: program.time.now() / 1e9),
    "time_ns": _clock("time_ns", lambda program: program.time.now()),
    "monotonic": _clock("monotonic", lambda program: program.time.steady() / 1e9),
    "monotonic_ns": _clock("monotonic_ns", lambda program: program.time.steady()),
    "perf_counter": _clock("perf_counter", lambda program: program.time.steady() / 1e9),
    "perf_counter_ns": _clock("perf_counter_ns", lambda program: program.time.steady()),
}


def _steady() -> float:
    """Seconds for those of Python's own waits that have an end."""
    program: Program | None = get_defaults().program
    if program is None or runner_of(program) is None:
        return float(_real["monotonic"]())
    return program.time.steady() / 1e9


def _is_no_end(record: logging.LogRecord) -> bool:
    """Whether this is no more than the end of a program, which a thread of one of its pools has met."""
    return record.exc_info is None or not isinstance(record.exc_info[1], Killed)


def _handle(number: int, handler: Any) -> Any:
    """Have a program handle a signal: as Ctrl-C it gets SIGINT; no other comes."""
    program: Program | None = get_defaults().program
    if program is None:
        return _real_handle(number, handler)
    before = program.handlers.get(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    program.handlers[number] = handler
    return before


def _start(thread: threading.Thread) -> None:
    program: Program | None = get_defaults().program
    if program is None:
        return _real_start(thread)
    caller = sys._getframe(1)
    if is_users(caller.f_code.co_filename):
        _note(program, "threading.Thread", caller)
    pace = program.host.pace
    if isinstance(pace, RealPace):
        pace.threads.add(thread)
        return go_along(thread, program, _real_start)
    runner = runner_of(program)
    if runner is None:
        return _real_start(thread)
    runner.is_real = True  # Python waits until the thread runs
    try:
        if isinstance(thread, Worker):
            return _real_start(thread)
        if getattr(getattr(thread, "_target", None), "__module__", "") == pools.__name__:
            locks.work_in_turns(thread)
        return take_part(thread, program, _real_start)
    finally:
        runner.is_real = False


def _popen(process: Any, *args: Any, **options: Any) -> None:
    program: Program | None = get_defaults().program
    caller: types.FrameType | None = sys._getframe(1)
    while caller is not None and caller.f_code.co_filename == subprocess.__file__:  # within subprocess.run, say
        caller = caller.f_back
    if program is not None and caller is not None and is_users(caller.f_code.co_filename):
        _note(program, "subprocess.Popen", caller)
    _real_popen(process, *args, **options)


def _join(thread: threading.Thread, timeout: float | None = None) -> None:
    program: Program | None = get_defaults().program
    joined = getattr(thread, "_robolink_runner", None)
    if program is None or joined is None or runner_of(program) is None:
        return _real_join(thread, timeout)
    wait_until(program.time, lambda: joined.is_done, timeout)
    return _real_join(thread) if joined.is_done else None


def _wait(condition: Any, timeout: float | None = None) -> bool:
    program: Program | None = get_defaults().program
    if program is None or runner_of(program) is None:
        return _real_wait(condition, timeout)
    if timeout is not None and timeout <= 0 and sys._getframe(2).f_code.co_filename == pools.__file__:
        return False  # whether a thread of a pool is idle: the pool's own lock is held meanwhile
    if not condition._is_owned():
        raise RuntimeError("cannot wait on un-acquired lock")
    told = _thread.allocate_lock()
    told.acquire()
    condition._waiters.append(told)
    saved = condition._release_save()
    try:
        wait_until(program.time, lambda: not told.locked(), timeout)
    finally:
        condition._acquire_restore(saved)
        if told.locked() and told in condition._waiters:
            condition._waiters.remove(told)
    return not told.locked()
