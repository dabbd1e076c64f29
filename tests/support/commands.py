"""Runs robolink commands as processes: their lines with time stamps, and no process left behind."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
import time
import uuid
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType, TracebackType
from typing import IO, NamedTuple

PATIENCE = 30.0
MARK = "ROBOLINK_TEST_COMMAND"

if sys.platform == "win32":
    APART, CONTROL_C = subprocess.CREATE_NEW_PROCESS_GROUP, signal.CTRL_BREAK_EVENT
else:
    APART, CONTROL_C = 0, signal.SIGINT

ROBOLINK = (sys.executable, "-m", "robolink")

PATIENT = """
import sys
from robolink import type_lookup
from robolink.cli.main import main
from robolink.cli.action import verbs as action
from robolink.cli.service import verbs as service
from robolink.cli.shared import graph
from robolink.transport import joining, zenoh_handles

type_lookup.ANSWER_WITHIN = service.PATIENCE = graph.PATIENCE = action.PATIENCE = action.CANCELED_WITHIN = 20.0
zenoh_handles.PATIENCE, zenoh_handles.LONGEST, joining.LINK_WITHIN = 5.0, 30.0, 30.0
sys.exit(main())
"""
"""The command, told that the machine is busy: no answer comes too late, and a wait of a second needs no explanation."""

BUSY_ROBOLINK = (sys.executable, "-c", PATIENT)

TERMINAL = "import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))"
"""Runs a command on a terminal of its own, on which it presses the keys that it reads. Not on Windows."""


class Line(NamedTuple):
    """What was printed, and how many seconds after the start."""

    seconds: float
    text: str


class Command:
    """A running command; with `merged`, its errors are among its lines, as on a terminal."""

    def __init__(
        self,
        domain: int,
        *args: str,
        program: tuple[str, ...] = ROBOLINK,
        has_input: bool = False,
        merged: bool = False,
        folder: Path | None = None,
        environ: Mapping[str, str] = MappingProxyType({}),
    ) -> None:
        self.mark = uuid.uuid4().hex
        own = {"ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1", "NO_COLOR": "1", MARK: self.mark}
        self.started = time.monotonic()
        self.process = subprocess.Popen(
            [*program, *args],
            env={**os.environ, **environ, **own},
            stdin=subprocess.PIPE if has_input else subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT if merged else subprocess.PIPE,
            cwd=folder,
            creationflags=APART,
        )
        self.lines: list[Line] = []
        self.errors: list[Line] = []
        self._new: queue.SimpleQueue[Line | None] = queue.SimpleQueue()
        followed = ((self.process.stdout, self.lines), (self.process.stderr, self.errors))
        self._threads = [threading.Thread(target=self._follow, args=each, daemon=True) for each in followed if each[0]]
        for thread in self._threads:
            thread.start()

    def _follow(self, stream: IO[bytes], lines: list[Line]) -> None:
        for raw in stream:
            line = Line(time.monotonic() - self.started, raw.decode(errors="replace").rstrip("\r\n"))
            lines.append(line)
            if lines is self.lines:
                self._new.put(line)
        if lines is self.lines:
            self._new.put(None)

    def wait_for(self, text: str) -> Line:
        """Wait for a line that has this in it."""
        while True:
            try:
                line = self._new.get(timeout=PATIENCE)
            except queue.Empty:
                line = None
            if line is None:
                raise AssertionError(f"no '{text}' in {self.lines}, {self.errors}")
            if text in line.text:
                return line

    def age(self) -> float:
        """Seconds since its start."""
        return time.monotonic() - self.started

    def press(self, keys: str) -> None:
        """Press these keys."""
        assert self.process.stdin is not None
        self.process.stdin.write(keys.encode())
        self.process.stdin.flush()

    def interrupt(self) -> None:
        """Press Ctrl-C."""
        self.process.send_signal(CONTROL_C)

    def kill(self) -> None:
        """Kill it as hard as it goes."""
        self.process.kill()
        self.process.wait(PATIENCE)

    def end(self, patience: float = PATIENCE) -> int:
        """Wait for its end and its last words; its exit code."""
        code = self.process.wait(patience)
        for thread in self._threads:
            thread.join(PATIENCE)
        return code

    def left(self) -> list[int]:
        """The processes that it started, and those that these did, which still run; known only where /proc is."""
        wanted = f"{MARK}={self.mark}".encode()
        return [int(each.parent.name) for each in Path("/proc").glob("[0-9]*/environ") if wanted in _read(each)]

    def __enter__(self) -> Command:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.end()
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            if stream is not None:
                stream.close()


def _read(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:
        return b""
