"""Processes for one test, and views of them (`launch_testing.tools.process`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.bases import LaunchArgumentError
from robolink.launch.ros.launch.events import IncludeLaunchDescription, matches_action
from robolink.launch.ros.launch.process_events import ProcessExited, ProcessIO, ProcessStarted, ShutdownProcess
from robolink.launch.ros.launch.sources import LaunchDescription
from robolink.launch.ros.launch_testing.io_handler import ActiveIoHandler
from robolink.launch.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler
from robolink.launch.ros.launch_testing.text import text_of

__all__ = ["ProcessProxy", "launch_process"]


class Found:
    """Result of a wait for an output, which shows that output where an assertion fails.

    Args:
        is_found: True if it came.
        output: The output at the end.
    """

    def __init__(self, is_found: bool, output: str) -> None:
        self._is_found, self._output = is_found, output

    def __bool__(self) -> bool:
        return self._is_found

    def __repr__(self) -> str:
        return f"{self._is_found} for the output {self._output!r:.2000}"


class ProcessProxy:
    """View of one process.

    Args:
        process_action: The action that starts it.
        proc_info: Record of the processes.
        proc_output: Record of their output.
        output_filter: Function of the whole output, which returns what is looked at.
    """

    def __init__(
        self,
        process_action: ExecuteLocal,
        proc_info: ActiveProcInfoHandler,
        proc_output: ActiveIoHandler,
        *,
        output_filter: Callable[[str], str] | None = None,
    ) -> None:
        _check(process_action, ExecuteLocal, "process_action")
        _check(proc_info, ActiveProcInfoHandler, "proc_info")
        _check(proc_output, ActiveIoHandler, "proc_output")
        if output_filter is not None and not callable(output_filter):
            raise LaunchArgumentError(f"output_filter is a function, got {type(output_filter).__name__}")
        self.target_process_action = process_action
        self._info, self._pieces, self._filter = proc_info, proc_output, output_filter

    @property
    def _event(self) -> Any:
        action = self.target_process_action
        return self._info[action] if action in self._info.processes() else None

    @property
    def running(self) -> bool:
        """True while it runs."""
        return isinstance(self._event, ProcessStarted)

    @property
    def terminated(self) -> bool:
        """True once it has ended."""
        return isinstance(self._event, ProcessExited)

    @property
    def exit_code(self) -> int:
        """Its exit code, -N for signal N; raises AttributeError while it runs."""
        code: int = self._event.returncode
        return code

    @property
    def output(self) -> str:
        """All that it has written."""
        return self._text(lambda piece: True)

    @property
    def stdout(self) -> str:
        """All that it has written to its standard output."""
        return self._text(lambda piece: piece.from_stdout)

    @property
    def stderr(self) -> str:
        """All that it has written to its standard error."""
        return self._text(lambda piece: piece.from_stderr)

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait for its end; return whether it came.

        Args:
            timeout: Longest wait in seconds; None has no limit.
        """
        return self._info.wait_until(lambda: self.terminated, timeout)

    def wait_for_output(self, condition: Callable[[str], object] | None = None, timeout: float | None = None) -> Found:
        """Wait for an output; return whether it came.

        Args:
            condition: Function that decides whether an output is what is waited for; None takes any.
            timeout: Longest wait in seconds; None has no limit.
        """
        if condition is not None and not callable(condition):
            raise LaunchArgumentError(f"a condition is a function of the output, got {type(condition).__name__}")
        is_found = self._pieces.wait_until(lambda: bool(self.output and (condition or bool)(self.output)), timeout)
        return Found(is_found, self.output)

    def _text(self, is_meant: Callable[[ProcessIO], bool]) -> str:
        action = self.target_process_action
        pieces = self._pieces[action] if action in self._pieces.processes() else []
        text = text_of(each for each in pieces if is_meant(each))
        return text if self._filter is None else self._filter(text)


def _check(value: object, kind: type, name: str) -> None:
    if not isinstance(value, kind):
        raise LaunchArgumentError(f"{name} is an object of {kind.__name__}, got {type(value).__name__}")


@contextmanager
def launch_process(
    launch_service: Any,
    process_action: ExecuteLocal,
    proc_info: ActiveProcInfoHandler,
    proc_output: ActiveIoHandler,
    **kwargs: Any,
) -> Iterator[ProcessProxy]:
    """Start a process, yield a view of it, and end it with the block.

    Args:
        launch_service: Launch of the test, as tests get it.
        process_action: The action that starts the process.
        proc_info: Record of the processes, as tests get it.
        proc_output: Record of their output, as tests get it.
        **kwargs: Those of ProcessProxy.
    """
    process = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    launch_service.emit_event(IncludeLaunchDescription(LaunchDescription([process_action])))
    try:
        yield process
    finally:
        if not process.terminated:
            launch_service.emit_event(ShutdownProcess(process_matcher=matches_action(process_action)))
