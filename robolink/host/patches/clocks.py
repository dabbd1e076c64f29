"""Patches of Python's clocks: `time.sleep`, the clocks and calendar of `time`, and those of Python's own waits.

A call from a program's own code gets the program's virtual time; one from Python's or robolink's code the real one,
but for the waits of `threading`, `queue` and `concurrent.futures`, which go by the thread that waits.
"""

from __future__ import annotations

import math
import sys
import threading
import time
import types
from collections.abc import Callable, Iterator
from concurrent.futures import thread as pools
from typing import Any

from robolink.host.call_sites import is_users, note_use
from robolink.host.participants import ProgramLike, runner_of
from robolink.running.defaults import get_defaults

_CALENDAR = ("localtime", "gmtime", "ctime", "asctime", "strftime")
"""Functions that take the clock's time where they are given none; their last argument."""

_CALL_FOR_OTHERS = (threading.__file__, pools.__file__)
"""Python's files that call what a program passes: ``Thread(target=time.sleep)``, ``pool.submit(time.sleep, 1.0)``."""

_CLOCKS = ("time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns")
_real = {name: getattr(time, name) for name in (*_CLOCKS, *_CALENDAR, "sleep")}


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {
        **{f"time.{name}": function for name, function in _REPLACED.items()},
        "threading._time": _steady,
        "queue.time": _steady,
        "concurrent.futures._base.time": types.SimpleNamespace(monotonic=_steady),
    }


def imported() -> Iterator[tuple[Any, Any]]:
    """Yield each function of `time` with its replacement, for modules that imported it earlier."""
    return ((_real[name], function) for name, function in _REPLACED.items())


def _sleep(seconds: float, /) -> None:
    program: ProgramLike | None = get_defaults().program
    caller = sys._getframe(1)
    file = caller.f_code.co_filename
    if program is not None and (is_users(file) or file in _CALL_FOR_OTHERS):
        note_use(program, "time.sleep", caller)
        if seconds >= 0 and runner_of(program) is not None:
            if seconds:
                program.time.sleep(math.ceil(seconds * 1e9))  # the rest of a span, however short, must come to its end
            else:
                program.time.pass_on()
            return
    _real["sleep"](seconds)


def is_sleep(frame: types.FrameType) -> bool:
    """Return whether a frame is that of a time.sleep in virtual time; its caller sleeps."""
    return frame.f_code is _sleep.__code__


def _clock(name: str, show: Callable[[ProgramLike], Any]) -> Callable[[], Any]:
    real = _real[name]

    def shown() -> Any:
        program: ProgramLike | None = get_defaults().program
        if program is None or not is_users(sys._getframe(1).f_code.co_filename):
            return real()
        return show(program)

    shown.__name__ = name
    return shown


def _calendar(name: str) -> Callable[..., Any]:
    real, localtime, before = _real[name], _real["localtime"], 1 if name == "strftime" else 0

    def shown(*given: Any) -> Any:
        program: ProgramLike | None = get_defaults().program
        is_given = len(given) > before and given[-1] is not None
        if is_given or program is None or not is_users(sys._getframe(1).f_code.co_filename):
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
    """Return the seconds by which Python's own waits measure their timeouts."""
    program: ProgramLike | None = get_defaults().program
    if program is None or runner_of(program) is None:
        return float(_real["monotonic"]())
    return program.time.steady() / 1e9
