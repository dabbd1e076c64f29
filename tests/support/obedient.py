"""Processes that obey their standard input, line by line, and answer on standard output."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path

ROOT = Path(__file__).parents[2]


def start(stack: ExitStack, command: Sequence[str], environ: Mapping[str, str]) -> subprocess.Popen[str]:
    """Start one in the repository's folder; it is killed when the stack is left."""
    process = subprocess.Popen(command, cwd=ROOT, env=environ, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    stack.enter_context(process)
    stack.callback(process.kill)
    return process


def line(process: subprocess.Popen[str]) -> str:
    """Return the next line that it prints."""
    assert process.stdout is not None
    return process.stdout.readline().strip()


def tell(process: subprocess.Popen[str], text: str) -> None:
    """Send it a line to obey."""
    assert process.stdin is not None
    process.stdin.write(f"{text}\n")
    process.stdin.flush()
