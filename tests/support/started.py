"""Commands of robolink that run in a workspace of a test's own, and what they come to."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals to send")

Write = Callable[[str, str], Path]

PATIENCE = 30.0

TALKER = """
from robolink import Node

class Talker(Node):
    '''Says what it is.'''
    def __init__(self):
        super().__init__("talker")
        word = self.declare_parameter("word", "hi").value
        print("up", self.get_fully_qualified_name(), word, flush=True)
"""


@contextmanager
def started(*args: str, domain: int = 0) -> Iterator[subprocess.Popen[str]]:
    """Run a command in a process of its own."""
    transport = {"ROS_DOMAIN_ID": str(domain)} if domain else {"ROBOLINK_TRANSPORT": "memory"}
    with subprocess.Popen(
        [sys.executable, "-m", "robolink", *args],
        env={**os.environ, **transport, "PYTHONUNBUFFERED": "1"},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def outcome(*args: str, domain: int = 0) -> tuple[int, str, str]:
    with started(*args, domain=domain) as process:
        out, err = process.communicate(timeout=PATIENCE)
        return process.returncode, out, err


def wait_for(process: subprocess.Popen[str], text: str) -> str:
    assert process.stdout is not None
    for line in process.stdout:
        if text in line:
            return line.strip()
    raise AssertionError(f"the process ended without '{text}': {process.communicate()[1]}")
