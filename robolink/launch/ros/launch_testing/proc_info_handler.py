"""Records of the starts and ends of processes (`launch_testing.proc_info_handler`)."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from typing import Any

from robolink.launch.ros.launch.actions import ExecuteLocal
from robolink.launch.ros.launch.process_events import ProcessExited, RunningProcessEvent
from robolink.launch.ros.launch_testing.util import NoMatchingProcessException, name_of, resolveProcesses
from robolink.system import waits

__all__ = ["ActiveProcInfoHandler", "ProcInfoHandler"]


class ProcInfoHandler:
    """Last event of each of several processes: ProcessStarted, or ProcessExited with its `returncode`."""

    def __init__(self) -> None:
        self._events: dict[Any, RunningProcessEvent] = {}

    def append(self, process_info: RunningProcessEvent) -> None:
        """Note an event, `process_info`."""
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
        self.proc_event = threading.Condition(threading.RLock())
        """Condition that is notified of each event."""

    def append(self, process_info: RunningProcessEvent) -> None:
        """Note an event, `process_info`, and wake who waits; on any thread."""
        with self.proc_event:
            super().append(process_info)
            self.proc_event.notify_all()

    def wait_until(self, condition: Callable[[], bool], timeout: float | None) -> bool:
        """Wait until a condition holds; return whether it does.

        Args:
            condition: The condition; it is checked again whenever a process has started or ended.
            timeout: Longest wait in seconds; None has no limit.
        """
        return waits.wait_for(self.proc_event, condition, timeout)

    def assertWaitForStartup(
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

    def assertWaitForShutdown(
        self, process: ExecuteLocal | str | None, cmd_args: Any = None, *, timeout: float = 10
    ) -> None:
        """Raise AssertionError unless a process ends in time.

        Args:
            process: The process, as for `resolveProcesses`.
            cmd_args: Its arguments, as there.
            timeout: Longest wait in seconds.
        """
        __tracebackhide__ = True
        self._wait(process, cmd_args, timeout, lambda event: isinstance(event, ProcessExited), "finish")

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
        raise AssertionError(f"Timed out waiting for process '{who}' to {what}")
