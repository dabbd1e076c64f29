"""Guards of the processes that tests start: those without the mark `processes` start none, and no file leaves a zombie.

What sees a start is an audit hook (PEP 578), which sees all of them, and cannot be taken away again.
"""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import psutil

EVENTS = frozenset(["os.exec", "os.fork", "os.forkpty", "os.posix_spawn", "os.spawn", "os.system", "subprocess.Popen"])
"""Audit events of Python that start a process."""

_started: list[str] = []


def watch() -> None:
    """Note each process that is started from now on, for `started`."""
    sys.addaudithook(_note)


def started() -> list[str]:
    """Return the audit events of the processes that were started since the last call."""
    events = list(_started)
    _started.clear()
    return events


def zombies() -> list[psutil.Process]:
    """Return this process's children that have ended and that nobody has waited for."""
    subprocess._cleanup()  # type: ignore[attr-defined]  # those whose Popen has gone
    return [each for each in psutil.Process().children() if each.status() == psutil.STATUS_ZOMBIE]


def _note(event: str, _: tuple[Any, ...]) -> None:
    if event in EVENTS:
        _started.append(event)
