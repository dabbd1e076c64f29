"""Records of what processes write (`launch_testing.io_handler`)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.process_events import ProcessIO
from robolink.launch.ros.launch_testing.asserts import DEFAULT_STREAM, assertInStream
from robolink.launch.ros.launch_testing.util import NoMatchingProcessException, name_of, resolveProcesses
from robolink.system import waits

__all__ = ["ActiveIoHandler", "IoHandler"]


class IoHandler:
    """Output of several processes, in its order."""

    def __init__(self) -> None:
        self._events: list[ProcessIO] = []
        self._by_name: dict[str, list[ProcessIO]] = {}

    def track(self, process_name: str) -> None:
        """Note that there is a process called `process_name`, which has written nothing yet."""
        self._by_name.setdefault(process_name, [])

    def append(self, process_io: ProcessIO) -> None:
        """Add a piece of output, the event `process_io`."""
        self._events.append(process_io)
        self._by_name.setdefault(process_io.process_name, []).append(process_io)

    def __iter__(self) -> Iterator[ProcessIO]:
        """Iterate over all pieces."""
        return iter(list(self._events))

    def processes(self) -> list[ExecuteLocal]:
        """Return the actions whose processes have written anything."""
        found: dict[int, Any] = {id(each.action): each.action for each in self}
        return list(found.values())

    def process_names(self) -> list[str]:
        """Return the names of the processes."""
        return list(self._by_name)

    def __getitem__(self, key: ExecuteLocal | str) -> list[ProcessIO]:
        """Return the pieces of a process, by its action or its name. Raises KeyError for an unknown one."""
        if not isinstance(key, str):
            found = [each for each in self if each.action is key]
            return found or list(self._by_name[name_of(key)])
        return list(self._by_name[key])


class ActiveIoHandler(IoHandler):
    """Output of processes that run; tests wait for it."""

    def __init__(self) -> None:
        super().__init__()
        self.io_event = threading.Condition(threading.RLock())
        """Condition that is notified of each piece of output."""

    def track(self, process_name: str) -> None:
        """Note that there is a process called `process_name`; on any thread."""
        with self.io_event:
            super().track(process_name)
            self.io_event.notify_all()

    def append(self, process_io: ProcessIO) -> None:
        """Add a piece of output, the event `process_io`, and wake who waits; on any thread."""
        with self.io_event:
            super().append(process_io)
            self.io_event.notify_all()

    def wait_until(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait until a condition holds; return whether it does.

        Args:
            condition: The condition; it is checked again whenever something was written.
            timeout: Longest wait in seconds; None has no limit.
        """
        return waits.wait_for(self.io_event, condition, timeout)

    def assertWaitFor(self, expected_output: Any, *args: Any, **kwargs: Any) -> None:
        """Raise AssertionError unless an output comes in time.

        Args:
            expected_output: What is expected.
            *args: Those of `waitFor`.
            **kwargs: Those of `waitFor`.
        """
        __tracebackhide__ = True
        if not self.waitFor(expected_output, *args, **kwargs):
            stream = kwargs.get("stream", DEFAULT_STREAM)
            raise AssertionError(f"Waiting for output timed out: {expected_output!r:.200} was not written to {stream}")

    def waitFor(
        self,
        expected_output: Any,
        process: ExecuteLocal | str | None = None,
        cmd_args: Any = None,
        *,
        strict_proc_matching: bool = True,
        output_filter: Callable[[str], str] | None = None,
        timeout: float = 10,
        strip_ansi_escape_sequences: bool = True,
        stream: str = DEFAULT_STREAM,
    ) -> bool:
        """Wait for an output; return whether it came in time.

        Args:
            expected_output: What is expected, as for `tools.text.build_text_match`.
            process: The process, as for `resolveProcesses`.
            cmd_args: Its arguments, as there.
            strict_proc_matching: True refuses a name that several have.
            output_filter: Function of the whole output, which returns what is searched.
            timeout: Longest wait in seconds.
            strip_ansi_escape_sequences: True leaves colours out.
            stream: Stream that is looked at, stdout or stderr.

        Raises:
            NoMatchingProcessException: if there is no such process at the end.
        """

        def is_there() -> bool:
            try:
                assertInStream(
                    self,
                    expected_output,
                    process,
                    cmd_args,
                    output_filter=output_filter,
                    strict_proc_matching=strict_proc_matching,
                    strip_ansi_escape_sequences=strip_ansi_escape_sequences,
                    stream=stream,
                )
            except (NoMatchingProcessException, AssertionError):
                return False
            return True

        found = self.wait_until(is_there, timeout)
        if not found:
            resolveProcesses(self, process=process, cmd_args=cmd_args, strict_proc_matching=False)
        return found
