"""Kill process groups when the supervisor that runs them is itself killed.

A lifeline only helps with programs that watch it. So, where there are process groups, the supervisor also
starts this file as a small program, tells it through a pipe which groups there are, and when the pipe ends with
groups left, this waits a moment for an orderly end and kills them.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterable
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen

PATIENCE = 2.5
"""Seconds; longer than a lifeline's, so that programs that watch theirs can end in order."""


class Guardian:
    """The supervisor's side; does nothing where there are no process groups (Windows)."""

    def __init__(self, patience: float = PATIENCE) -> None:
        self._process: Popen[bytes] | None = None
        if sys.platform != "win32":
            command = [sys.executable, "-I", "-S", __file__, str(patience)]
            self._process = Popen(
                command, bufsize=0, stdin=PIPE, stdout=DEVNULL, stderr=DEVNULL, start_new_session=True
            )

    def guard(self, group: int) -> None:
        """From now on, kill this group should we be gone."""
        self._tell(b"+%d\n" % group)

    def release(self, group: int) -> None:
        """Forget a group that is no more."""
        self._tell(b"-%d\n" % group)

    def close(self) -> None:
        """End the guardian; it kills the groups that it still guards."""
        if self._process is not None and self._process.stdin is not None:
            self._process.stdin.close()
            self._process.wait()

    def _tell(self, line: bytes) -> None:
        if self._process is None or self._process.stdin is None:
            return
        try:
            self._process.stdin.write(line)
        except BrokenPipeError:  # somebody killed it; lifelines still hold
            return


def remaining(lines: Iterable[bytes]) -> set[int]:
    """Give the groups that are guarded after `+group` and `-group` lines; a line cut short does not count."""
    groups: set[int] = set()
    for line in lines:
        if line.endswith(b"\n"):
            group = int(line[1:])
            (groups.add if line.startswith(b"+") else groups.discard)(group)
    return groups


def kill_after(groups: Iterable[int], patience: float) -> None:
    """Kill the groups that still have a process `patience` seconds from now."""
    if sys.platform != "win32":
        deadline = time.monotonic() + patience
        left = list(groups)
        while left and time.monotonic() < deadline:
            time.sleep(0.05)
            left = [group for group in left if is_alive(group)]
        for group in left:
            signal_group(group, signal.SIGKILL)


def signal_group(group: int, number: int) -> bool:
    """Send a signal (0: none) to a process group; say whether there is one."""
    if sys.platform != "win32":
        try:
            os.killpg(group, number)
        except (ProcessLookupError, PermissionError):  # macOS says the latter of a group of zombies
            return False
    return sys.platform != "win32"


def is_alive(group: int) -> bool:
    """Whether a process group has a process that is more than a zombie, which nobody may ever collect."""
    if not signal_group(group, 0):
        return False
    stats = [_stat(each) for each in Path("/proc").glob("[0-9]*/stat")]
    return not stats or any(fields[2] == str(group) and fields[0] not in "ZX" for fields in stats if fields)


def _stat(path: Path) -> list[str]:
    """Give the fields of a /proc/PID/stat behind the command: state, parent, group ...; none if it has gone."""
    try:
        return path.read_text(errors="replace").rpartition(")")[2].split()
    except OSError:
        return []


if __name__ == "__main__":
    kill_after(remaining(sys.stdin.buffer), float(sys.argv[1]))
