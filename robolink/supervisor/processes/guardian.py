"""Watchdog process (guardian): kills the process groups of a supervisor that was itself killed.

A lifeline only helps with programs that watch it. So, where there are process groups, the supervisor also
starts this file as a small program and names the groups to it through a pipe. When the pipe ends with
groups left, it waits a moment for an orderly end and kills them. A process that was just being started when the
supervisor was killed is known by the mark of its lifeline, where the system shows environments (Linux).

As that program this file runs by its path, in a Python that finds neither our package nor any other that is installed
(`-I -S`: it begins in a third of the time). So all that it does then, `signal_group` and `is_alive` too, stands here
and needs nothing but the standard library.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Iterable
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen

PATIENCE = 2.5
"""Time for an orderly end, in seconds: longer than a lifeline's, so that programs that watch theirs can end."""
MOST_STARTS = 20
"""Most watchdogs of one supervisor: somebody may kill each."""
_BEGINNING = 0.2
"""Time in seconds in which a process that was just being started appears with its own group."""
_IN_ORDER = b".\n"
"""Last message of a supervisor that was not killed."""


class Guardian:
    """Supervisor's side of the watchdog; does nothing where there are no process groups (Windows).

    A watchdog that somebody kills is started anew, and is told of all groups again.

    Args:
        mark: Mark of the supervisor's lifeline.
        patience: Time for an orderly end, in seconds.
        leavings: Files that it removes when the supervisor has been killed.
    """

    def __init__(self, mark: str = "", patience: float = PATIENCE, leavings: Iterable[Path] = ()) -> None:
        self._words = [str(patience), mark]
        self._leavings = leavings
        self._groups: set[int] = set()
        self._lock = threading.Lock()
        self._starts = 0
        self._is_closed = False
        self._watcher: threading.Thread | None = None
        self._process: Popen[bytes] | None = None
        if sys.platform != "win32":
            self._process = self._start()

    def guard(self, group: int) -> None:
        """Add a group to those that are killed if the supervisor is gone."""
        with self._lock:
            self._groups.add(group)
            self._tell(b"+%d\n" % group)

    def release(self, group: int) -> None:
        """Remove a group that has ended."""
        with self._lock:
            self._groups.discard(group)
            self._tell(b"-%d\n" % group)

    def close(self) -> None:
        """End the guardian; it kills the groups that it still guards."""
        with self._lock:
            self._is_closed = True
            process = self._process
        if process is not None and process.stdin is not None:
            self._tell(_IN_ORDER)
            process.stdin.close()
            if sys.platform != "win32":
                process.send_signal(signal.SIGCONT)  # somebody may have paused it
            process.wait()
        if self._watcher is not None:
            self._watcher.join()

    def _start(self) -> Popen[bytes]:
        from robolink.supervisor.processes.lifeline import VARIABLE  # the guardian itself can import none of ours

        # a launcher that was launched by another has that one's mark, and its guardian must outlive it
        environ = {name: value for name, value in os.environ.items() if name != VARIABLE}
        command = [sys.executable, "-I", "-S", __file__, *self._words, *map(str, self._leavings)]
        process = Popen(
            command, bufsize=0, stdin=PIPE, stdout=DEVNULL, stderr=DEVNULL, start_new_session=True, env=environ
        )
        self._starts += 1
        self._watcher = threading.Thread(target=self._watch, args=(process,), name="guardian", daemon=True)
        self._watcher.start()
        return process

    def _watch(self, process: Popen[bytes]) -> None:
        """Start a watchdog in the place of one that has been killed."""
        process.wait()
        with self._lock:
            if self._is_closed or self._starts > MOST_STARTS:
                return
            if process.stdin is not None:
                process.stdin.close()
            with contextlib.suppress(OSError):
                self._process = self._start()
                for group in self._groups:
                    self._tell(b"+%d\n" % group)

    def _tell(self, line: bytes) -> None:
        if self._process is None or self._process.stdin is None:
            return
        try:
            self._process.stdin.write(line)
        except (BrokenPipeError, ValueError):  # somebody killed it: the next one is told of all
            return


def remaining(lines: Iterable[bytes]) -> set[int]:
    """Return the groups that are guarded after `+group` and `-group` lines; a line cut short does not count."""
    groups: set[int] = set()
    for line in lines:
        if line.endswith(b"\n") and line != _IN_ORDER:
            group = int(line[1:])
            (groups.add if line.startswith(b"+") else groups.discard)(group)
    return groups


def remove(leavings: Iterable[str]) -> None:
    """Remove files, as far as they exist."""
    for each in leavings:
        with contextlib.suppress(OSError):
            Path(each).unlink()


def kill_after(groups: Iterable[int], patience: float, mark: str = "") -> None:
    """Kill the groups that still have a process `patience` seconds from now, and those with the mark."""
    if sys.platform != "win32":
        deadline = time.monotonic() + patience
        left = set(groups)
        if mark:
            time.sleep(_BEGINNING)
            left |= marked(mark)
        while left and time.monotonic() < deadline:
            time.sleep(0.05)
            left = {group for group in left if is_alive(group)}
        for group in left | marked(mark):
            signal_group(group, signal.SIGKILL)


def marked(mark: str) -> set[int]:
    """Return the groups of the processes whose lifeline has this mark, as far as the system shows it."""
    groups: set[int] = set()
    for path in Path("/proc").glob("[0-9]*/environ") if mark else ():
        try:
            found = f":{mark}\0".encode() in path.read_bytes()
        except OSError:  # another user's, or gone
            continue
        fields = _stat(path.with_name("stat")) if found else []
        groups.update(int(each) for each in fields[2:3])
    return groups


def signal_group(group: int, number: int) -> bool:
    """Send a signal (0: none) to a process group; return False if it does not exist."""
    if sys.platform != "win32":
        try:
            os.killpg(group, number)
        except (ProcessLookupError, PermissionError):  # macOS says the latter of a group of zombies
            return False
    return sys.platform != "win32"


def is_alive(group: int) -> bool:
    """True if a process group has a process that is not a zombie (nobody may ever collect those)."""
    if not signal_group(group, 0):
        return False
    stats = [_stat(each) for each in Path("/proc").glob("[0-9]*/stat")]
    return not stats or any(fields[2] == str(group) and fields[0] not in "ZX" for fields in stats if fields)


def _stat(path: Path) -> list[str]:
    """Return the fields of a /proc/PID/stat behind the command: state, parent, group ...; none if it has gone."""
    try:
        return path.read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
    except OSError:
        return []


if __name__ == "__main__":
    lines = list(sys.stdin.buffer)
    was_killed = lines[-1:] != [_IN_ORDER]
    if was_killed:
        remove(sys.argv[3:])
    kill_after(remaining(lines), float(sys.argv[1]), sys.argv[2] if was_killed else "")
