"""Assertions about the output and the exit codes of processes (`launch_testing.asserts`).

The launcher reads standard output and errors of a process as one stream, so that each kind of assertion looks at both.
"""

from __future__ import annotations

import re
import signal
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from robolink.companions.launch.actions.processes import ExecuteLocal
from robolink.companions.launch_testing.util import NO_CMD_ARGS, name_of, resolveProcesses

if TYPE_CHECKING:
    from robolink.companions.launch_testing.io_handler import IoHandler
    from robolink.companions.launch_testing.proc_info_handler import ProcInfoHandler

__all__ = [
    "EXIT_FORCED",
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "NO_CMD_ARGS",
    "SequentialTextChecker",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertSequentialStdout",
]

EXIT_OK = 0
"""Exit code of a program that ended well."""
EXIT_FORCED = 1
"""Exit code of a program that Windows has ended."""
EXIT_SIGINT, EXIT_SIGQUIT, EXIT_SIGKILL, EXIT_SIGSEGV = 130, 131, 137, 139
"""Exit codes of a program that a shell reports as ended by a signal."""

_COLOURS = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]")
Process = ExecuteLocal | str | None


def assertExitCodes(  # noqa: N802 - ROS 2's name
    proc_info: ProcInfoHandler,
    allowable_exit_codes: Iterable[int] = (EXIT_OK,),
    process: Process = None,
    cmd_args: Any = None,
    *,
    strict_proc_matching: bool = True,
) -> None:
    """Raise AssertionError unless processes have ended with one of these exit codes.

    Args:
        proc_info: Record of the processes, as tests get it.
        allowable_exit_codes: The exit codes; the end by signal N is -N.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        strict_proc_matching: True refuses a name that several have.
    """
    allowed = list(allowable_exit_codes)
    meant = resolveProcesses(proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    for each in meant:
        code = getattr(proc_info[each], "returncode", None)
        assert code is not None, f"{name_of(each)} has not ended"
        assert code in allowed, f"{name_of(each)} ended with {_shown(code)}, and {allowed} was expected"


def _shown(code: int) -> str:
    if -code in {int(each) for each in signal.Signals}:
        return f"{code} ({signal.Signals(-code).name})"
    return str(code)


def matching(expected: Any) -> Callable[[str], bool]:
    """Return a function that is true for an output in which all that is expected is found, one behind the other.

    Args:
        expected: Text that is within the output, pattern that is searched, or a list of either: texts of a list are
            whole lines.

    Raises:
        ValueError: for anything else.
    """
    if isinstance(expected, str):
        return lambda output: expected in output
    if hasattr(expected, "search"):
        return lambda output: expected.search(output) is not None
    some = list(expected) if isinstance(expected, (list, tuple)) else []
    if some and all(isinstance(each, str) for each in some):
        return lambda output: _are_lines(some, output)
    if some and all(hasattr(each, "search") for each in some):
        return lambda output: _follow(some, output)
    raise ValueError(f"the expected output is a text, a pattern or a list of either, got {expected!r:.60}")


def _are_lines(expected: Sequence[str], output: str) -> bool:
    left = iter(output.splitlines())
    return all(each in left for each in expected)  # each `in` goes on behind the one before


def _follow(expected: Sequence[re.Pattern[str]], output: str) -> bool:
    at = 0
    for each in expected:
        found = each.search(output, at)
        if found is None:
            return False
        at = found.end()
    return True


def assertInStdout(  # noqa: N802 - ROS 2's name
    proc_output: IoHandler,
    expected_output: Any,
    process: Process,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
) -> None:
    """Raise AssertionError unless one of the processes has written something.

    Args:
        proc_output: Record of the output, as tests get it.
        expected_output: What is expected, as for `matching`.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        strict_proc_matching: True refuses a name that several have.
        output_filter: Function of the whole output, which returns what is searched.
        strip_ansi_escape_sequences: True leaves colours out.
    """
    is_there = matching(expected_output)
    meant = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    for each in meant:
        if is_there(_output(proc_output, each, output_filter, strip_ansi_escape_sequences)):
            return
    names = ", ".join(sorted(map(name_of, meant)))
    raise AssertionError(f"{expected_output!r:.200} is not in the output of {names}")


assertInStderr = assertInStdout  # noqa: N816 - ROS 2's name


def _output(
    proc_output: IoHandler, process: ExecuteLocal, output_filter: Callable[[str], str] | None, strip: bool
) -> str:
    lines = (each.text.decode(errors="replace").rstrip("\r\n") + "\n" for each in proc_output[process])
    text = "".join(lines)
    text = _COLOURS.sub("", text) if strip else text
    return text if output_filter is None else output_filter(text)


class SequentialTextChecker:
    """Texts that must follow each other in an output.

    Args:
        output: The output, piece by piece.
    """

    def __init__(self, output: Iterable[str]) -> None:
        self._text, self._at = "".join(output), 0

    def assertInStdout(self, msg: str) -> None:  # noqa: N802 - ROS 2's name
        """Raise AssertionError unless `msg` is in the output, behind the one before."""
        found = self._text.find(msg, self._at)
        assert found >= 0, f"{msg!r} is not in what is left of the output: {self._text[self._at :]!r:.200}"
        self._at = found + len(msg)


@contextmanager
def assertSequentialStdout(  # noqa: N802 - ROS 2's name
    proc_output: IoHandler, process: Process, cmd_args: Any = None, *, strict_proc_matching: bool = True
) -> Iterator[SequentialTextChecker]:
    """Yield a checker of texts that must follow each other in the output of a process.

    Args:
        proc_output: Record of the output, as tests get it.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        strict_proc_matching: True refuses a name that several have.
    """
    meant = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    yield SequentialTextChecker([_output(proc_output, each, None, True) for each in meant])
