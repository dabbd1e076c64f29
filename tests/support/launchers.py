"""Fake launchers without processes, in a runtime folder of their own, for tests of the control socket."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from robolink.supervisor.control import client
from robolink.supervisor.events import Status

PATIENCE = 30.0
RUNTIME_VARIABLE = "LOCALAPPDATA" if sys.platform == "win32" else "XDG_RUNTIME_DIR"

posix_only = pytest.mark.skipif(sys.platform == "win32", reason="modes, owners and SIGSTOP are POSIX's")


def new_runtime_folder() -> tempfile.TemporaryDirectory[str]:
    """Make a folder in which launchers leave word; pytest's own are too long for a socket's path."""
    place = None if sys.platform == "win32" else "/tmp"
    return tempfile.TemporaryDirectory(prefix="rl", dir=place, ignore_cleanup_errors=True)


@contextmanager
def own_runtime_folder(monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder in which only this test's launchers leave word."""
    with new_runtime_folder() as folder:
        monkeypatch.setenv(RUNTIME_VARIABLE, folder)
        yield Path(folder)


class FakeSupervisor:
    """What is asked of it is noted; its processes are as they are told to be."""

    def __init__(self, *names: str) -> None:
        now = time.time()
        self.nodes = [Status(name, None, "running", 0, None, now - 90.0) for name in names]
        self.restarted: list[str] = []
        self.stopped_ones: list[str] = []
        self.why_not = ""
        self.said: list[str] = []
        self.leavings: list[Path] = []
        self.stopped = threading.Event()

    def status(self) -> list[Status]:
        return self.nodes

    def restart(self, name: str) -> None:
        self.restarted.append(name)

    def why_not_restarted(self, name: str) -> str:
        return self.why_not

    def stop_one(self, name: str) -> None:
        """Note it, and have the process be stopped at once."""
        self.stopped_ones.append(name)
        self.nodes = [self._stopped(each) if each.name == name else each for each in self.nodes]

    def _stopped(self, each: Status) -> Status:
        return Status(each.name, None, "stopped", each.restarts, -2, time.time())

    def why_not_stopped(self, name: str) -> str:
        return self.why_not

    def stop(self) -> None:
        self.stopped.set()

    def say(self, text: str) -> None:
        self.said.append(text)

    def runs(self, **changes: Any) -> None:
        """Have the first process be otherwise."""
        first = {field: getattr(self.nodes[0], field) for field in Status.__struct_fields__}
        self.nodes[0] = Status(**{**first, **changes})


LAUNCHER = """
import sys, time
from robolink.supervisor.control.server import Control
from tests.support.launchers import FakeSupervisor
supervisor = FakeSupervisor("talker")
supervisor.stop = lambda: print("stop", flush=True)
with Control(supervisor, name="elsewhere"):
    print("listening", flush=True)
    sys.stdin.read()
"""
"""A program that can be asked until its standard input ends, or it is killed."""


def the_only() -> client.Launcher:
    """The launcher that runs."""
    (launcher,) = client.running()
    return launcher


def files_in(folder: Path) -> list[str]:
    """What is left in a runtime folder."""
    return sorted(each.name for each in folder.rglob("*") if not each.is_dir())


@contextmanager
def launcher_elsewhere(folder: Path) -> Iterator[subprocess.Popen[bytes]]:
    """A launcher in another process, which listens; it is killed in the end."""
    environ = {**os.environ, RUNTIME_VARIABLE: str(folder), "PYTHONPATH": str(Path(__file__).parents[2])}
    command = [sys.executable, "-c", LAUNCHER]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environ) as process:
        assert process.stdout is not None
        assert process.stdout.readline().strip() == b"listening"
        yield process
        if process.poll() is None:
            process.kill()
