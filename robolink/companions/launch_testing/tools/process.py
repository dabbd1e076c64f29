"""Processes that a test itself starts (`launch_testing.tools.process`)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from robolink.companions.launch.actions.processes import ExecuteLocal
from robolink.companions.launch.events import IncludeLaunchDescription
from robolink.companions.launch.events.process import ProcessExited, ProcessStarted, ShutdownProcess
from robolink.companions.launch.launch_description import LaunchDescription
from robolink.companions.launch_testing.io_handler import ActiveIoHandler
from robolink.companions.launch_testing.proc_info_handler import ActiveProcInfoHandler

__all__ = ["ProcessProxy", "launch_process"]


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
        self.target_process_action = process_action
        self._info, self._lines, self._filter = proc_info, proc_output, output_filter

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
        """All that it has written; standard output and errors are one stream here."""
        action = self.target_process_action
        lines = self._lines[action] if action in self._lines.processes() else []
        text = "".join(each.text.decode(errors="replace").rstrip("\r\n") + "\n" for each in lines)
        return text if self._filter is None else self._filter(text)

    stdout = stderr = output

    def wait_for_shutdown(self, timeout: float | None = None) -> bool:
        """Wait for its end; return whether it came.

        Args:
            timeout: Longest wait in seconds; None has no limit.
        """
        return self._info.wait_until(lambda: self.terminated, timeout)

    def wait_for_output(self, condition: Callable[[str], object] | None = None, timeout: float | None = None) -> bool:
        """Wait for an output; return whether it came.

        Args:
            condition: Function that decides whether an output is what is waited for; None takes any.
            timeout: Longest wait in seconds; None has no limit.
        """
        return self._lines.wait_until(lambda: bool(self.output and (condition or bool)(self.output)), timeout)


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
    launch_service.emit_event(IncludeLaunchDescription(LaunchDescription([process_action])))
    process = ProcessProxy(process_action, proc_info, proc_output, **kwargs)
    try:
        yield process
    finally:
        if not process.terminated:
            launch_service.emit_event(ShutdownProcess(process_matcher=lambda action: action is process_action))
