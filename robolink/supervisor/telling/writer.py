"""Write bytes to an output past its buffers: all of them, or an error says why not."""

from __future__ import annotations

import time
from typing import TextIO

_AGAIN = 0.01
"""Seconds after which an output is tried again that is full and was set not to wait."""


class Writer:
    """Writes bytes through unchanged where that is possible, else as text; nothing is left to write at the end.

    When the writing of a line broke off, what comes next begins on a line of its own.
    """

    def __init__(self, output: TextIO) -> None:
        self._output = output
        binary = getattr(output, "buffer", None)
        self._raw = getattr(binary, "raw", binary)  # with PYTHONUNBUFFERED there is no buffer in between
        self._is_cut = False

    def write(self, lines: bytes) -> None:
        """Write lines. Raises OSError, and ValueError when the output is closed."""
        self._output.flush()
        if self._raw is None:
            self._output.write(lines.decode(errors="replace"))
            self._output.flush()
            return
        rest = memoryview(b"\n" + lines if self._is_cut else lines)
        while rest:
            count = self._raw.write(rest)
            if count:
                self._is_cut = rest[count - 1] != ord("\n")
                rest = rest[count:]
            else:
                time.sleep(_AGAIN)
