"""Names the places where a program waits in an event loop of asyncio: that takes real time, as ours is not its own."""

from __future__ import annotations

import os
import selectors
import sys
from typing import Any

from robolink.defaults import get_defaults
from robolink.oneprocess.places import place_of
from robolink.oneprocess.program import Program

_LOOP = f"asyncio{os.sep}base_events.py"
"""How the file ends from which a loop waits; on Windows it has other ways, which are not seen."""

_real_select = selectors.DefaultSelector.select


def _select(selector: Any, timeout: float | None = None) -> Any:
    program: Program | None = get_defaults().program
    if program is not None and (timeout is None or timeout > 0):
        caller = sys._getframe(1)
        if caller.f_code.co_filename.endswith(_LOOP) and (place := place_of(caller)):
            program.host.note_real_time(program, "asyncio", place)
    return _real_select(selector, timeout)


def replacements() -> list[tuple[Any, str, Any]]:
    """Give what is to be replaced, while there is a host: owner, name and the function in its place."""
    return [(selectors.DefaultSelector, "select", _select)]
