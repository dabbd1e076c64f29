"""Unbuffered writer: writes all bytes to an output, or raises."""

from __future__ import annotations

import time
from typing import TextIO

_AGAIN = 0.01
"""Retry interval of a full non-blocking output, in seconds."""


class Writer:
    """Writes bytes unchanged where that is possible, else as text; buffers nothing.

    After a line that was written in part only, the next one begins on a line of its own.
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
