"""A system in one process: its programs as they are, each with a session, a clock and arguments of its own.

`Host` runs them, `Program` is one of them; in virtual time every run of the same system is the same.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robolink.oneprocess.host import Host
    from robolink.oneprocess.program import Program
    from robolink.oneprocess.running import run
    from robolink.oneprocess.turns import HostError

__all__ = ["Host", "HostError", "Program", "run"]

_PLACES = {"Host": "host", "HostError": "turns", "Program": "program", "run": "running"}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)
