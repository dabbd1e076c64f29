"""Patches of `signal.signal` and `subprocess.Popen`: a program has handlers of its own; its processes are noted."""

from __future__ import annotations

import signal
import subprocess
import sys
import types
from typing import Any

from robolink.host.call_sites import is_users, note_use
from robolink.host.participants import ProgramLike
from robolink.running.defaults import get_defaults

_real_handle, _real_popen = signal.signal, subprocess.Popen.__init__


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {"signal.signal": _handle, "subprocess.Popen.__init__": _popen}


def _handle(number: int, handler: Any) -> Any:
    """Keep a program's handler of a signal: as Ctrl-C it gets SIGINT; no other comes."""
    program: ProgramLike | None = get_defaults().program
    if program is None:
        return _real_handle(number, handler)
    before = program.handlers.get(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    program.handlers[number] = handler
    return before


def _popen(process: Any, *args: Any, **options: Any) -> None:
    """Start a process, which goes by real time, and note that."""
    program: ProgramLike | None = get_defaults().program
    caller: types.FrameType | None = sys._getframe(1)
    while caller is not None and caller.f_code.co_filename == subprocess.__file__:  # within subprocess.run, say
        caller = caller.f_back
    if program is not None and caller is not None and is_users(caller.f_code.co_filename):
        note_use(program, "subprocess.Popen", caller)
    _real_popen(process, *args, **options)
