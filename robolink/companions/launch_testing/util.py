"""Lookup of processes by action or name, for the assertions of launch tests (`launch_testing.util`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePath
from typing import Any, Protocol

from robolink.companions.launch.actions.processes import ExecuteLocal
from robolink.companions.launch.bases import Action

__all__ = ["NO_CMD_ARGS", "KeepAliveProc", "NoMatchingProcessException", "resolveProcesses"]

NO_CMD_ARGS = object()
"""Value of `cmd_args` for a process without arguments."""


class NoMatchingProcessException(Exception):  # noqa: N818 - ROS 2's name
    """No process that has started, or has written anything, is meant."""


class KeepAliveProc(Action):
    """Process that only keeps a launch going until its tests are done: nothing is run.

    Args:
        **kwargs: `condition`.
    """


class HasProcesses(Protocol):
    """Record of several processes."""

    def processes(self) -> Iterable[ExecuteLocal]:
        """Return the actions that started them."""


def resolveProcesses(  # noqa: N802 - ROS 2's name
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
        found = known
    elif isinstance(process, ExecuteLocal):
        found = [each for each in known if each is process]
    elif isinstance(process, str):
        found = [each for each in known if _is_called(each, process) and _has(each, cmd_args)]
        if strict_proc_matching and len(found) > 1:
            raise ValueError(f"several processes are called '{process}': {_names(found)}")
    else:
        raise TypeError(f"a process is an action or a name, got {type(process).__name__}")
    if not found:
        who = "any process" if process is None else f"'{process if isinstance(process, str) else name_of(process)}'"
        raise NoMatchingProcessException(f"nothing is known of {who}, only of: {_names(known) or 'none'}")
    return found


def name_of(process: ExecuteLocal) -> str:
    """Return the name of the process that an action, `process`, has started; that of its class if it has not."""
    return str((process.process_details or {}).get("name") or type(process).__name__)


def _is_called(process: ExecuteLocal, name: str) -> bool:
    """True for a part of the launcher's name of a process, which is its node's, or of ROS 2's, its program's."""
    program = PurePath((process.process_details or {}).get("cmd", [""])[0]).name
    return name in name_of(process) or name in program


def _names(processes: Iterable[ExecuteLocal]) -> str:
    return ", ".join(sorted(map(name_of, processes)))


def _has(process: ExecuteLocal, cmd_args: Any) -> bool:
    if cmd_args is None:
        return True
    given: Sequence[str] = (process.process_details or {}).get("cmd", [""])[1:]
    if cmd_args is NO_CMD_ARGS:
        return not given
    return all(each in given for each in ([cmd_args] if isinstance(cmd_args, str) else cmd_args))
