"""Programs with open sessions, run in a Python of their own: how they end, and what they print."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap

PATIENCE = 30.0

SESSIONS = """
import signal, sys, threading, time
from robolink.transport import lifetime

class Session:
    def __init__(self, name, during=lambda: None):
        self.name, self.during = name, during
        lifetime.watch_over(self)

    def close(self):
        lifetime.forget(self)
        self.during()
        print("closed", self.name, flush=True)

"""


def run(*arguments: str, environ: dict[str, str] | None = None) -> tuple[int, list[str], str]:
    """Run Python: the exit code, the lines that it printed, sorted, and what it complained of."""
    environ = {**os.environ, **(environ or {})}
    done = subprocess.run(
        [sys.executable, *arguments], env=environ, capture_output=True, text=True, timeout=PATIENCE, check=False
    )
    return done.returncode, sorted(done.stdout.split("\n")[:-1]), done.stderr


def program(text: str) -> tuple[int, list[str], str]:
    return run("-c", SESSIONS + textwrap.dedent(text))
