"""Paths as one types them into a shell in the working directory."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path


def shown(path: Path) -> str:
    """Return a path relative to the working directory if it is within."""
    here = Path.cwd()
    return os.path.relpath(path, here) if path.is_relative_to(here) else str(path)


def typed(path: Path) -> str:
    """Return a path as one types it into a shell here: in quotes if need be, and never like an option."""
    short = shown(path)
    short = f"./{short}" if short.startswith("-") else short
    return subprocess.list2cmdline([short]) if sys.platform == "win32" else shlex.quote(short)
