"""Process title: the command line under which `ps` and `pgrep -f` show a forked process, on Linux.

A forked process shows the command line of the one that it was forked from. The kernel reads it from the process's own
memory, so writing there changes it (as setproctitle does), within the room that the first command line took.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

_BEGIN, _END = 48, 49
"""Fields of /proc/self/stat, counted from 1: the addresses of the command line's first byte and behind its last."""
_LEAST = 2
"""Smallest room that is written to, in bytes: one for the end of the text, and the last one."""


class ProcessTitle:
    """Room of this process's command line; `write` does nothing where the system does not say where that is."""

    def __init__(self) -> None:
        try:
            fields = Path("/proc/self/stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
            first, end = (int(fields[number - 3]) for number in (_BEGIN, _END))  # the first behind ")" is number 3
        except (OSError, ValueError, IndexError):
            first = end = 0
        self._address, self._room = first, max(0, end - first)

    def write(self, words: Sequence[str]) -> None:
        """Show these words from now on; they are cut where the room ends."""
        if self._address == 0 or self._room < _LEAST:
            return
        import ctypes

        text = " ".join(words).encode(errors="surrogateescape").replace(b"\0", b" ")[: self._room - _LEAST]
        # A last byte that is not zero tells the kernel that this is one text, which ends at the first zero.
        ctypes.memmove(self._address, text.ljust(self._room - 1, b"\0") + b" ", self._room)
