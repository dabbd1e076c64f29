"""Patches of asyncio: a program's event loops are in virtual time; a loop made in other ways is noted as it waits."""

from __future__ import annotations

import asyncio
import os
import selectors
import sys
from collections.abc import Iterator
from typing import Any
from weakref import WeakKeyDictionary

from robolink.host.call_sites import note_use
from robolink.host.event_loop import HostedLoop
from robolink.host.participants import ProgramLike, Runner, runner_of
from robolink.running.defaults import Defaults, get_defaults

_LOOP = f"asyncio{os.sep}base_events.py"
"""End of the path of the file from which a loop waits; on Windows it waits in other ways, which are not seen."""

_MAKES_NONE = (3, 14)
"""Version of Python from which `get_event_loop` makes no loop."""

_real_select = selectors.DefaultSelector.select
_real_new, _real_set, _real_get = asyncio.new_event_loop, asyncio.set_event_loop, asyncio.get_event_loop

_of_main_threads: WeakKeyDictionary[Defaults, Any] = WeakKeyDictionary()
"""The loop set in a program's main thread, which is a worker of the host, and another one each time."""


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    functions = {"new_event_loop": _new, "set_event_loop": _set, "get_event_loop": _get}
    return {
        **{f"{owner}.{name}": each for name, each in functions.items() for owner in ("asyncio", "asyncio.events")},
        "selectors.DefaultSelector.select": _select,
    }


def imported() -> Iterator[tuple[Any, Any]]:
    """Yield each function of asyncio with its replacement, for modules that imported it earlier."""
    yield from ((_real_new, _new), (_real_set, _set), (_real_get, _get))


def _new() -> Any:
    program: ProgramLike | None = get_defaults().program
    return _real_new() if program is None or runner_of(program) is None else HostedLoop(program)


def _main_runner() -> Runner | None:
    """Return the calling thread, if it is the main one of a program."""
    runner = runner_of(get_defaults().program)
    return runner if runner is not None and runner.is_host else None


def _set(loop: Any) -> None:
    if _main_runner() is None:
        _real_set(loop)
    else:
        _of_main_threads[get_defaults()] = loop


def _get() -> Any:
    """Return the loop that runs, or that of the thread; make one in a main thread, as Python does before 3.14."""
    running, defaults = asyncio._get_running_loop(), get_defaults()
    if running is not None or _main_runner() is None:
        return running or _real_get()
    if defaults not in _of_main_threads and sys.version_info < _MAKES_NONE:
        _set(_new())
    loop = _of_main_threads.get(defaults)
    if loop is None:
        raise RuntimeError("There is no current event loop in thread 'MainThread'.")
    return loop


def _select(selector: Any, timeout: float | None = None) -> Any:
    program: ProgramLike | None = get_defaults().program
    if program is not None and (timeout is None or timeout > 0):
        caller = sys._getframe(1)
        if caller.f_code.co_filename.endswith(_LOOP):
            note_use(program, "asyncio", caller)
    return _real_select(selector, timeout)
