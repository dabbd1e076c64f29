"""Records of what the processes of a launch test write (`launch_testing.io_handler`)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

from robolink.companions.launch.actions.processes import ExecuteLocal
from robolink.companions.launch.events.process import ProcessIO
from robolink.companions.launch_testing.asserts import Process, assertInStdout
from robolink.companions.launch_testing.util import NoMatchingProcessException, resolveProcesses
from robolink.system import waits

__all__ = ["ActiveIoHandler", "IoHandler"]


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
            condition: The condition; it is asked again whenever something was written.
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
