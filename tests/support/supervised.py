"""Programs for tests of the supervisor, and whether they are there."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from robolink.supervisor import Process
from robolink.supervisor.policy import Step

PATIENCE = 30.0

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="signals and process groups are POSIX's")

INTERRUPT, TERMINATE, KILL = Step.INTERRUPT, Step.TERMINATE, Step.KILL

SAY_READY = "import signal, sys, time, os, subprocess\nsay = lambda *a: print(*a, flush=True)\n"

DOZE = "while True: time.sleep(0.02)\n"
"""Sleeps for ever. A signal that comes just before a long sleep begins would be noticed only at its end."""

FOR_EVER = "say('ready')\n" + DOZE

IGNORES = "signal.signal(signal.SIGINT, signal.SIG_IGN)\n"


def python(name: str, code: str, *, interactive: bool = False) -> Process:
    return Process(name, [sys.executable, "-c", SAY_READY + textwrap.dedent(code)], interactive=interactive)


def there(path: Path) -> str:
    """The code that ends such a wait."""
    return f"open({str(path)!r}, 'w').close()\n"


def state(pid: int) -> str:
    """Return the letter of a process's state, '' when there is none; a zombie ('Z') still has a number."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except FileNotFoundError:
        if Path("/proc/self").exists():
            return ""
    shown = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False)
    return shown.stdout.strip()[:1]


def is_gone(pid: int) -> bool:
    return state(pid) in ("", "Z", "X")
