"""Patch of `selectors` that notes where a program waits in an event loop of asyncio, which takes real time."""

from __future__ import annotations

import os
import selectors
import sys
from typing import Any

from robolink.host.call_sites import note_use
from robolink.host.participants import ProgramLike
from robolink.running.defaults import get_defaults

_LOOP = f"asyncio{os.sep}base_events.py"
"""End of the path of the file from which a loop waits; on Windows it waits in other ways, which are not seen."""

_real_select = selectors.DefaultSelector.select


def _select(selector: Any, timeout: float | None = None) -> Any:
    program: ProgramLike | None = get_defaults().program
    if program is not None and (timeout is None or timeout > 0):
        caller = sys._getframe(1)
        if caller.f_code.co_filename.endswith(_LOOP):
            note_use(program, "asyncio", caller)
    return _real_select(selector, timeout)


def replacements() -> dict[str, Any]:
    """Return the replacements of this subject by the dotted path of Python's name."""
    return {"selectors.DefaultSelector.select": _select}
