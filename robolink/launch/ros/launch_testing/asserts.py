"""Assertions about the output and the ends of a test's processes (`launch_testing.asserts`)."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.process_events import ProcessIO, RunningProcessEvent
from robolink.launch.ros.launch_testing.text import build_text_match, text_of, without_escapes
from robolink.launch.ros.launch_testing.util import (
    NO_CMD_ARGS,
    NoMatchingProcessException,
    name_of,
    resolveProcesses,
)

__all__ = [
    "EXIT_FORCED",
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "NO_CMD_ARGS",
    "NoMatchingProcessException",
    "SequentialTextChecker",
    "assertDefaultStream",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertInStream",
    "assertSequentialStdout",
]


EXIT_OK = 0
"""Exit code of a program that ended well."""
EXIT_FORCED = 1
"""Exit code of a program that Windows has ended."""
EXIT_SIGINT, EXIT_SIGQUIT, EXIT_SIGKILL, EXIT_SIGSEGV = 130, 131, 137, 139
"""Exit codes of a program that a shell reports as ended by a signal."""
DEFAULT_STREAM = "stderr"
"""Stream that is looked at if a test names none, as in ROS 2: that of the logs."""
AROUND = 2
"""Lines before and behind the last one found that an error shows."""
Process = ExecuteLocal | str | None


class HasEvents(Protocol):
    """Record of the last event of each of several processes."""

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions that started them."""

    def __getitem__(self, key: Any) -> RunningProcessEvent:
        """Return the event of a process."""


class HasOutput(Protocol):
    """Record of the output of several processes."""

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions that started them."""

    def __getitem__(self, key: Any) -> list[ProcessIO]:
        """Return the output of a process."""


def assertExitCodes(
    proc_info: HasEvents,
    allowable_exit_codes: Iterable[int] = (EXIT_OK, EXIT_FORCED) if sys.platform == "win32" else (EXIT_OK,),
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
    for each in allowed:
        assert isinstance(each, int), f"an exit code is a whole number, got {each!r:.60}"
    meant = resolveProcesses(proc_info, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    for event in [proc_info[each] for each in meant]:
        code = getattr(event, "returncode", None)
        assert code is not None, f"{event.process_name} has not ended"
        assert code in allowed, f"{event.process_name} ended with {_shown(code)}, and {allowed} was expected"


def _shown(code: int) -> str:
    if -code in {int(each) for each in signal.Signals}:
        return f"{code} ({signal.Signals(-code).name})"
    return str(code)


def assertDefaultStream() -> str:
    """Return the stream that is looked at if a test names none."""
    return DEFAULT_STREAM


def assertInStream(
    proc_output: HasOutput,
    expected_output: Any,
    process: Process,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = DEFAULT_STREAM,
) -> None:
    """Raise AssertionError unless one of the processes has written something to a stream.

    Args:
        proc_output: Record of the output, as tests get it.
        expected_output: What is expected, as for `tools.text.build_text_match`.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        output_filter: Function of the whole output, which returns what is searched.
        strict_proc_matching: True refuses a name that several have.
        strip_ansi_escape_sequences: True leaves colours out.
        stream: stdout or stderr; raises ValueError for another one.
    """
    if stream not in ("stdout", "stderr"):
        raise ValueError(f"a stream is stdout or stderr, got {stream!r:.60}")
    if output_filter is not None and not callable(output_filter):
        raise ValueError(f"output_filter is a function, got {type(output_filter).__name__}")
    meant = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    match = build_text_match(expected_output)
    for each in meant:
        text = text_of(each for each in proc_output[each] if getattr(each, f"from_{stream}"))
        text = without_escapes(text) if strip_ansi_escape_sequences else text
        if match(text if output_filter is None else output_filter(text)) is not None:
            return
    names = ", ".join(sorted(map(name_of, meant)))
    raise AssertionError(f"Did not find {expected_output!r:.200} in the {stream} of {names}")


def assertInStdout(
    proc_output: HasOutput, expected_output: Any, process: Process, cmd_args: Any = None, **kwargs: Any
) -> None:
    """Raise AssertionError unless one of the processes has written something to its standard output.

    Args:
        proc_output: Record of the output, as tests get it.
        expected_output: What is expected, as for `tools.text.build_text_match`.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        **kwargs: Those of `assertInStream`.
    """
    assertInStream(proc_output, expected_output, process, cmd_args, stream="stdout", **kwargs)


def assertInStderr(
    proc_output: HasOutput, expected_output: Any, process: Process, cmd_args: Any = None, **kwargs: Any
) -> None:
    """Raise AssertionError unless one of the processes has written something to its standard error.

    Args:
        proc_output: Record of the output, as tests get it.
        expected_output: What is expected, as for `tools.text.build_text_match`.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        **kwargs: Those of `assertInStream`.
    """
    assertInStream(proc_output, expected_output, process, cmd_args, stream="stderr", **kwargs)


class SequentialTextChecker:
    """Texts that must follow each other in an output.

    Args:
        output: The output, piece by piece; a text that is looked for is within one of them.
    """

    def __init__(self, output: Iterable[str]) -> None:
        self._pieces = list(output)
        self._piece = self._at = 0
        """Index of the piece found last, and the end of the text in it."""

    def assertInText(self, msg: str) -> None:
        """Raise AssertionError unless `msg` is in the output, behind the one before."""
        self.assertInStdout(msg)

    def assertInStdout(self, msg: str) -> None:
        """Raise AssertionError unless `msg` is in the output, behind the one before."""
        at = self._at
        for number in range(self._piece, len(self._pieces)):
            found = self._pieces[number].find(msg, at)
            if found >= 0:
                self._piece, self._at = number, found + len(msg)
                return
            at = 0
        raise AssertionError(f"'{msg}' not found behind the last match, which is here:\n{self.get_nearby_lines()}")

    def get_nearby_lines(self) -> str:
        """Return the line found last, and those around it."""
        text = "".join(self._pieces)
        at = sum(map(len, self._pieces[: self._piece])) + self._at
        line = text.count("\n", 0, at + 1)  # behind a line that was found as a whole the next one counts
        return "\n".join(text.splitlines()[max(0, line - AROUND) : line + AROUND + 1])


@contextmanager
def assertSequentialStdout(
    proc_output: HasOutput, process: Process, cmd_args: Any = None, *, strict_proc_matching: bool = True
) -> Iterator[SequentialTextChecker]:
    """Yield a checker of texts that must follow each other in the output of a process.

    Args:
        proc_output: Record of the output, as tests get it.
        process: The process, as for `resolveProcesses`.
        cmd_args: Its arguments, as there.
        strict_proc_matching: True refuses a name that several have.
    """
    meant = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    yield SequentialTextChecker([without_escapes(text_of(proc_output[each])) for each in meant])
