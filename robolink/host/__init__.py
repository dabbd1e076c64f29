"""Host: runs a system of programs in one process and in virtual time, each with its own session, clock and arguments.

`Host` runs them, `Program` is one of them; in virtual time every run of the same system is the same.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from robolink.host.host import Host
    from robolink.host.participants import HostError
    from robolink.host.program import Program

__all__ = ["Host", "HostError", "Program"]

_PLACES = {"Host": "host", "HostError": "participants", "Program": "program"}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f"{__name__}.{_PLACES[name]}"), name)
