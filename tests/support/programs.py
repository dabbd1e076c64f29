"""Child processes for tests: their output can be awaited, and they can be stopped."""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import textwrap
import threading
from pathlib import Path
from types import TracebackType
from typing import IO

PATIENCE = 30.0

if sys.platform == "win32":
    _APART, _CONTROL_C = subprocess.CREATE_NEW_PROCESS_GROUP, signal.CTRL_BREAK_EVENT
else:
    _APART, _CONTROL_C = 0, signal.SIGINT


class Program:
    """A Python program on a domain of its own, which prints line by line."""

    def __init__(self, folder: Path, text: str, domain: int, *arguments: str) -> None:
        path = folder / f"program_{len(list(folder.iterdir()))}.py"
        path.write_text(textwrap.dedent(text))
        self._popen = subprocess.Popen(
            [sys.executable, "-u", str(path), *arguments],
            env=os.environ | {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            creationflags=_APART,
        )
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self.errors: list[str] = []
        self._threads = [self._follow(self._popen.stdout, self._lines.put)]
        self._threads.append(self._follow(self._popen.stderr, self.errors.append))

    def _follow(self, stream: IO[str] | None, put: object) -> threading.Thread:
        assert stream is not None
        assert callable(put)
        thread = threading.Thread(target=lambda: [put(line.rstrip()) for line in stream], daemon=True)
        thread.start()
        return thread

    def line(self) -> str:
        """The next line that it prints."""
        try:
            return self._lines.get(timeout=PATIENCE)
        except queue.Empty:
            raise AssertionError(f"nothing was printed; stderr: {self.errors}") from None

    def interrupt(self) -> None:
        """Press Ctrl-C."""
        self._popen.send_signal(_CONTROL_C)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self._popen.terminate()

    def kill(self) -> None:
        """Kill it, and wait for its end."""
        self._popen.kill()
        self._popen.wait(PATIENCE)

    def end(self) -> int:
        """Wait for its end; its exit code."""
        code = self._popen.wait(PATIENCE)
        for thread in self._threads:
            thread.join(PATIENCE)
        return code

    def __enter__(self) -> Program:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._popen.poll() is None:
            self._popen.kill()
        self.end()
        for stream in (self._popen.stdout, self._popen.stderr):
            assert stream is not None
            stream.close()
