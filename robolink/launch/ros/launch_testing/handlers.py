"""Output and ends of a test's processes, and assertions about them (`launch_testing.asserts`, `.io_handler` ...)."""

from __future__ import annotations

import re
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import PurePath
from typing import Any, Protocol

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.bases import Action
from robolink.launch.ros.launch.events import ProcessExited, ProcessIO, RunningProcessEvent
from robolink.system import waits

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "EXIT_FORCED",
    "EXIT_OK",
    "EXIT_SIGINT",
    "EXIT_SIGKILL",
    "EXIT_SIGQUIT",
    "EXIT_SIGSEGV",
    "IoHandler",
    "KeepAliveProc",
    "NO_CMD_ARGS",
    "NoMatchingProcessException",
    "ProcInfoHandler",
    "SequentialTextChecker",
    "assertExitCodes",
    "assertInStderr",
    "assertInStdout",
    "assertSequentialStdout",
    "resolveProcesses",
]


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


class IoHandler:
    """Lines of several processes, in their order."""

    def __init__(self) -> None:
        self._events: list[ProcessIO] = []

    def append(self, process_io: ProcessIO) -> None:
        """Add a line, the event `process_io`."""
        self._events.append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        """Iterate over all lines."""
        return iter(list(self._events))

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions whose processes have written anything."""
        found = {id(each.action): each.action for each in self}
        return [each for each in found.values() if isinstance(each, ExecuteLocal)]

    def process_names(self) -> list[str]:
        """Return the names of these processes."""
        return list(dict.fromkeys(each.process_name for each in self))

    def __getitem__(self, key: ExecuteLocal | str) -> list[ProcessIO]:
        """Return the lines of a process, by its action or its name. Raises KeyError if it has written none."""
        found = [each for each in self if key in (each.action, each.process_name)]
        if not found:
            raise KeyError(key)
        return found


class ActiveIoHandler(IoHandler):
    """Lines of processes that run; tests wait for them."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = threading.Condition(threading.RLock())

    def append(self, process_io: ProcessIO) -> None:
        """Add a line, the event `process_io`, and wake who waits; on any thread."""
        with self._changed:
            super().append(process_io)
            self._changed.notify_all()

    def wait_until(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait until a condition holds; return whether it does.

        Args:
            condition: The condition; it is checked again whenever something was written.
            timeout: Longest wait in seconds; None has no limit.
        """
        return waits.wait_for(self._changed, condition, timeout)

    def assertWaitFor(self, expected_output: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N802 - ROS 2's name
        """Raise AssertionError unless an output comes in time.

        Args:
            expected_output: What is expected.
            *args: Those of `waitFor`.
            **kwargs: Those of `waitFor`.
        """
        __tracebackhide__ = True
        if not self.waitFor(expected_output, *args, **kwargs):
            raise AssertionError(f"waited in vain for the output {expected_output!r:.200}")

    def waitFor(  # noqa: N802 - ROS 2's name
        self,
        expected_output: Any,
        process: Process = None,
        cmd_args: Any = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str | None = None,
    ) -> bool:
        """Wait for an output; return whether it came in time.

        Args:
            expected_output: What is expected, as for `asserts.matching`.
            process: The process, as for `resolveProcesses`.
            cmd_args: Its arguments, as there.
            strict_proc_matching: True refuses a name that several have.
            output_filter: Function of the whole output, which returns what is searched.
            timeout: Longest wait in seconds.
            strip_ansi_escape_sequences: True leaves colours out.
            stream: Of no effect: standard output and errors are one stream here.

        Raises:
            NoMatchingProcessException: if no process that is meant has written anything until then.
        """

        def is_there() -> bool:
            try:
                assertInStdout(
                    self,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                )
            except (NoMatchingProcessException, AssertionError):
                return False
            return True

        found = self.wait_until(is_there, timeout)
        if not found:
            resolveProcesses(self, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return found


class ProcInfoHandler:
    """Last event of each of several processes: ProcessStarted, or ProcessExited with its `returncode`."""

    def __init__(self) -> None:
        self._events: dict[ExecuteLocal, RunningProcessEvent] = {}

    def append(self, process_info: RunningProcessEvent) -> None:
        """Note an event, `process_info`."""
        if isinstance(process_info.action, ExecuteLocal):
            self._events[process_info.action] = process_info

    def __iter__(self) -> Iterator[RunningProcessEvent]:
        """Iterate over the events."""
        return iter(list(self._events.values()))

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions that have started processes."""
        return list(self._events)

    def process_names(self) -> list[str]:
        """Return the names of these processes."""
        return [name_of(each) for each in self.processes()]

    def __getitem__(self, key: ExecuteLocal | str) -> RunningProcessEvent:
        """Return the event of a process, by its action or a part of its name. Raises KeyError for an unknown one."""
        if not isinstance(key, str):
            return self._events[key]
        found = next((each for each in self.processes() if key in name_of(each)), None)
        if found is None:
            raise KeyError(key)
        return self._events[found]


class ActiveProcInfoHandler(ProcInfoHandler):
    """Events of processes that run; tests wait for them."""

    def __init__(self) -> None:
        super().__init__()
        self._changed = threading.Condition(threading.RLock())

    def append(self, process_info: RunningProcessEvent) -> None:
        """Note an event, `process_info`, and wake who waits; on any thread."""
        with self._changed:
            super().append(process_info)
            self._changed.notify_all()

    def wait_until(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait until a condition holds; return whether it does.

        Args:
            condition: The condition; it is checked again whenever a process has started or ended.
            timeout: Longest wait in seconds; None has no limit.
        """
        return waits.wait_for(self._changed, condition, timeout)

    def assertWaitForStartup(  # noqa: N802 - ROS 2's name
        self, process: ExecuteLocal | str | None, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Raise AssertionError unless a process starts in time.

        Args:
            process: The process, as for `resolveProcesses`.
            cmd_args: Its arguments, as there.
            timeout: Longest wait in seconds.
        """
        __tracebackhide__ = True
        self._wait(process, cmd_args, timeout, lambda event: True, "start")

    def assertWaitForShutdown(  # noqa: N802 - ROS 2's name
        self, process: ExecuteLocal | str | None, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Raise AssertionError unless a process ends in time.

        Args:
            process: The process, as for `resolveProcesses`.
            cmd_args: Its arguments, as there.
            timeout: Longest wait in seconds.
        """
        __tracebackhide__ = True
        self._wait(process, cmd_args, timeout, lambda event: isinstance(event, ProcessExited), "end")

    def _wait(
        self,
        process: ExecuteLocal | str | None,
        cmd_args: Any,
        timeout: float,
        is_it: Callable[[RunningProcessEvent], bool],
        what: str,
    ) -> None:
        __tracebackhide__ = True

        def is_there() -> bool:
            try:
                return is_it(self[resolveProcesses(self, process=process, cmd_args=cmd_args)[0]])
            except NoMatchingProcessException:
                return False

        if self.wait_until(is_there, timeout):
            return
        who = name_of(process) if isinstance(process, ExecuteLocal) else process
        raise AssertionError(f"waited in vain for {who} to {what}")
