"""Print the lines of many processes, whole, prefixed with their names and coloured."""

from __future__ import annotations

import os
import queue
import sys
import threading
from collections.abc import Callable, Iterable
from typing import TextIO

_COLOURS = ("36", "33", "32", "35", "34", "96", "93", "92", "95", "94")
OWN_NAME = "launch"
_QUEUED = 1000
"""Lines that may wait for a slow terminal; then the process that prints waits."""


class Printer:
    """Writes from a thread of its own, so that a terminal that stands still holds up no decision.

    `on_broken` is called, once and on that thread, when nobody reads the output any more.
    """

    def __init__(self, output: TextIO, names: Iterable[str], *, on_broken: Callable[[], object] = lambda: None) -> None:
        self._output = output
        self._on_broken = on_broken
        self._prefixes = prefixes([*names, OWN_NAME], wants_colour(output))
        self._lines: queue.Queue[bytes | None] = queue.Queue(_QUEUED)
        self._thread = threading.Thread(target=self._work, name="printer", daemon=True)
        self._thread.start()

    def line(self, name: str, line: bytes) -> None:
        """Print one line of a process, as it is; waits while too many wait."""
        self._lines.put(self._prefixes[name] + line.rstrip(b"\r\n") + b"\n")

    def say(self, text: str) -> None:
        """Print a line of our own; never waits: rather the line is lost."""
        try:
            self._lines.put_nowait(self._prefixes[OWN_NAME] + text.encode() + b"\n")
        except queue.Full:
            return

    def close(self, timeout: float = 1.0) -> None:
        """Print what waits, for at most `timeout` seconds."""
        try:
            self._lines.put(None, timeout=timeout)
        except queue.Full:
            return
        self._thread.join(timeout)

    def _work(self) -> None:
        write = _writer(self._output)
        while (line := self._lines.get()) is not None:
            try:
                write(line)
                if self._lines.empty():
                    self._output.flush()
            except (OSError, ValueError):  # a closed pipe or a closed file: go on, so that nobody waits for us
                write = _swallow
                self._on_broken()
                self._on_broken = lambda: None


def wants_colour(output: TextIO) -> bool:
    """Whether colours make sense there: a terminal, and NO_COLOR is not set."""
    knows_colours = sys.platform != "win32" or "WT_SESSION" in os.environ or "TERM" in os.environ
    return output.isatty() and knows_colours and not os.environ.get("NO_COLOR")


def prefixes(names: Iterable[str], has_colour: bool) -> dict[str, bytes]:
    """Give each name its prefix: `[name] `, in a colour of its own as far as they go."""
    plain = {name: f"[{name}]" for name in names}
    if not has_colour:
        return {name: f"{prefix} ".encode() for name, prefix in plain.items()}
    coloured = {}
    for index, (name, prefix) in enumerate(plain.items()):
        coloured[name] = f"\x1b[{_COLOURS[index % len(_COLOURS)]}m{prefix}\x1b[0m ".encode()
    return coloured


def _writer(output: TextIO) -> Callable[[bytes], object]:
    """Write bytes through unchanged where that is possible, else as text."""
    binary = getattr(output, "buffer", None)
    if binary is not None:
        output.flush()
        return binary.write  # type: ignore[no-any-return]
    return lambda line: output.write(line.decode(errors="replace"))


def _swallow(line: bytes) -> None:
    """Take the place of a writer that nobody reads."""
