"""Prefix of a node's command line, as `ros2 run --prefix` has it: a debugger, a profiler, `nice`, a terminal."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Sequence

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.system.processes import own_command, split_words


class PrefixError(RobolinkError, ValueError):
    """A prefix that is not a command line."""


def command_line(prefix: str, words: Sequence[str]) -> list[str]:
    """Return the command line of robolink with `words` behind a prefix.

    A prefix that runs Python, such as ``python3 -m pdb``, runs this Python, and gets a module to run.

    Args:
        prefix: Command with its arguments, as one types it in a shell.
        words: Arguments of robolink.

    Raises:
        PrefixError: (a ValueError) if the prefix is empty, or a quote is not closed.
        NotFoundError: if there is no such program.
    """
    try:
        first, *others = split_words(prefix)
    except ValueError as error:
        raise PrefixError(f"--prefix: expected a command, got '{prefix[:100]}' ({error})") from None
    if first in ("python", "python3"):
        return [sys.executable, *others, "-m", "robolink", *words]
    program = shutil.which(first)
    if program is None:
        raise NotFoundError("program", first, (), "the PATH, for --prefix")
    return [program, *others, *own_command(), *words]


def run(prefix: str, words: Sequence[str]) -> int:
    """Run robolink with `words` behind a prefix, in this process's place where the system can do that.

    Raises what `command_line` raises.
    """
    line = command_line(prefix, words)
    if sys.platform != "win32":
        _become(line)
    return subprocess.run(line, check=False).returncode


def _become(line: list[str]) -> None:
    for stream in (sys.stdout, sys.stderr):
        stream.flush()
    os.execv(line[0], line)
