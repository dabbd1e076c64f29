"""Output of a process of a LaunchService: its pieces become lines of launch's log, on the terminal and in files."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING

from robolink.launch.ros.launch import logging as launch_logging
from robolink.launch.ros.launch.bases import LaunchContext
from robolink.launch.ros.launch.utilities import perform_substitutions

if TYPE_CHECKING:
    from robolink.launch.ros.launch.processes import ExecuteLocal


class Output:
    """Output of one process.

    Args:
        action: The action that starts it, which says where its lines go, and in which format.
        context: The context with whose values that is performed.
    """

    def __init__(self, action: ExecuteLocal, context: LaunchContext) -> None:
        self._action = action
        where = action.output if isinstance(action.output, dict) else perform_substitutions(context, action.output)
        name = str((action.process_details or {}).get("name"))
        self._loggers = dict(zip((1, 2), launch_logging.get_output_loggers(name, where), strict=True))
        self._decoders = {fd: codecs.getincrementaldecoder("utf-8")(errors="replace") for fd in (1, 2)}
        self._begun: dict[int, list[str]] = {1: [], 2: []}
        """Pieces of the line that has no end yet: joined at its end, since it may be long."""

    def write(self, piece: bytes, fd: int) -> None:
        """Take a piece of its output (1) or of its errors (2): whole lines are logged."""
        text = self._decoders[fd].decode(piece)
        if self._action.cached_output:
            self._action.written[fd].write(text)
        first, *others = text.split("\n")
        self._begun[fd].append(first)
        for each in others:
            self._log("".join(self._begun[fd]).removesuffix("\r"), fd)
            self._begun[fd] = [each]

    def flush(self) -> None:
        """Log what has no end of a line, since the process has ended."""
        for fd, pieces in self._begun.items():
            if begun := "".join(pieces):
                self._log(begun, fd)
            self._begun[fd] = []

    def _log(self, line: str, fd: int) -> None:
        self._loggers[fd].info(self._action.output_format.format(line=line, this=self._action))
