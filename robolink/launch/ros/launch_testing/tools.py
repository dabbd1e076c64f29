"""Output that is expected of a process, and processes for one test (`launch_testing.tools`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.events import IncludeLaunchDescription, ProcessExited, ProcessStarted, ShutdownProcess
from robolink.launch.ros.launch.sources import LaunchDescription
from robolink.launch.ros.launch_testing.handlers import ActiveIoHandler, ActiveProcInfoHandler

__all__ = [
    "ProcessProxy",
    "basic_output_filter",
    "expected_output_from_file",
    "get_default_filtered_patterns",
    "get_default_filtered_prefixes",
    "launch_process",
]


def get_default_filtered_prefixes() -> list[str]:
    """Return beginnings of lines that no test compares."""
    return ["pid", "rc"]


def get_default_filtered_patterns() -> list[str]:
    """Return patterns of lines that no test compares: none."""
    return []


def basic_output_filter(
    filtered_prefixes: Iterable[str] | None = None, filtered_patterns: Iterable[str] | None = None
) -> Callable[[str], str]:
    """Return a function that leaves lines out of an output.

    Args:
        filtered_prefixes: Beginnings of these lines; None is those of `get_default_filtered_prefixes`.
        filtered_patterns: Regular expressions that match their beginnings.
    """
    prefixes = tuple(get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = [re.compile(each) for each in filtered_patterns or ()]

    def filtered(output: str) -> str:
        lines = output.splitlines(keepends=True)
        return "".join(
            each for each in lines if not each.startswith(prefixes) and not any(one.match(each) for one in patterns)
        )

    return filtered


def expected_output_from_file(path: str) -> list[str] | list[re.Pattern[str]]:
    """Return the lines of a file `path`.txt, or the patterns in `path`.regex, one a line.

    Raises FileNotFoundError if there is neither.
    """
    for suffix in (".txt", ".regex"):
        if Path(path + suffix).is_file():
            lines = Path(path + suffix).read_text(encoding="utf-8").splitlines()
            return lines if suffix == ".txt" else [re.compile(each) for each in lines]
    raise FileNotFoundError(f"there is neither {path}.txt nor {path}.regex with the expected output")


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
