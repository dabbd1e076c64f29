"""Lookup of processes among those that are recorded, and a process that keeps it going (`launch_testing.util`)."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Any, Protocol

from robolink.launch.ros.launch.actions import ExecuteLocal, ExecuteProcess
from robolink.launch.ros.launch.bases import Substitution
from robolink.launch.ros.launch.utilities import TextSubstitution

__all__ = ["KeepAliveProc", "NO_CMD_ARGS", "NoMatchingProcessException", "resolveProcesses"]


NO_CMD_ARGS = object()
"""Value of `cmd_args` for a process without arguments."""
_WAITING = """
import time
try:
    while True:
        time.sleep(1)
except KeyboardInterrupt:
    pass
"""


class NoMatchingProcessException(Exception):
    """No process that has started, or has written anything, is meant."""


def KeepAliveProc() -> ExecuteProcess:
    """Return an action whose process only keeps the launch going until its tests are done."""
    return ExecuteProcess(cmd=[sys.executable, "-c", _WAITING])


class HasProcesses(Protocol):
    """Record of several processes."""

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions that started them."""


def resolveProcesses(
    info_obj: HasProcesses,
    *,
    process: ExecuteLocal | str | None = None,
    cmd_args: Any = None,
    strict_proc_matching: bool = True,
) -> list[ExecuteLocal]:
    """Return the recorded processes that are meant, one at least.

    Args:
        info_obj: The record.
        process: The action, or a part of the name of the process or of its program; None is all of them.
        cmd_args: Words, or a word, that the command line of a process with that name must have; None for any.
        strict_proc_matching: True refuses a name that several processes have.

    Raises:
        NoMatchingProcessException: if there is none.
        ValueError: if a name means several.
        TypeError: for a `process` that is neither an action nor a text.
    """
    known = list(info_obj.processes())
    if process is None:
        if not known:
            raise NoMatchingProcessException("No data recorded for any process")
        return known
    if isinstance(process, ExecuteLocal):
        if not any(each is process for each in known):
            raise NoMatchingProcessException(f"No data recorded for proc {line_of(process)}, only for: {_lines(known)}")
        return [process]
    if not isinstance(process, str):
        raise TypeError(f"a process is an action or a name, got {type(process).__name__}")
    found = [each for each in known if _is_called(each, process) and _has(each, cmd_args)]
    which = f"'{process}'" if cmd_args is None else f"'{process}' and the arguments {_args(cmd_args)}"
    if not found:
        raise NoMatchingProcessException(f"Did not find any processes matching {which}, only: {_lines(known)}")
    if strict_proc_matching and len(found) > 1:
        raise ValueError(f"Found multiple processes matching {which}: {_lines(found)}")
    return found


def name_of(process: Any) -> str:
    """Return the name of the process that an action, `process`, has started; that of its class if it has not."""
    return str(_details(process).get("name") or type(process).__name__)


def line_of(process: ExecuteLocal) -> str:
    """Return the name of a process with its arguments; before it has started its command line as far as it is known.

    Args:
        process: The action that starts it.
    """
    details = _details(process)
    if details:
        return " ".join([name_of(process), *details.get("cmd", [""])[1:]])
    words = [_fixed(each) for each in process.process_description.cmd]
    if None in words:
        return "Unknown, which has not started yet"
    return " ".join(each for each in words if each is not None)


def _details(process: Any) -> dict[str, Any]:
    return getattr(process, "process_details", None) or {}


def _fixed(word: Any) -> str | None:
    """Return a word of a command line that is a fixed text; None for one that is known only when the launch runs."""
    if isinstance(word, TextSubstitution):
        return word.text
    if isinstance(word, Substitution):
        return None
    if isinstance(word, Iterable) and not isinstance(word, str):
        parts = [_fixed(each) for each in word]
        return None if None in parts else "".join(each for each in parts if each is not None)
    return str(word)


def _is_called(process: ExecuteLocal, name: str) -> bool:
    """True for a part of the launcher's name of a process, which is its node's, or of ROS 2's, its program's."""
    program = PurePath(_details(process).get("cmd", [""])[0]).name
    return name in name_of(process) or name in program


def _lines(processes: Iterable[ExecuteLocal]) -> str:
    return ", ".join(sorted(map(line_of, processes))) or "none"


def _args(cmd_args: Any) -> str:
    return "none" if cmd_args is NO_CMD_ARGS else str(cmd_args)


def _has(process: ExecuteLocal, cmd_args: Any) -> bool:
    if cmd_args is None:
        return True
    given: Sequence[str] = _details(process).get("cmd", [""])[1:]
    if cmd_args is NO_CMD_ARGS:
        return not given
    return all(each in given for each in ([cmd_args] if isinstance(cmd_args, str) else cmd_args))
