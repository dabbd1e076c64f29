"""Event dispatcher: passes what happens in a system to the terminal, the log files, and programs (`on_event`)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import TextIO

from robolink.supervisor.events import Ended, Event, Exited, Output, Restarting, Said, Started, Stopping
from robolink.supervisor.policy import Ask, Tracked
from robolink.supervisor.reporting.background_queue import Troubles
from robolink.supervisor.reporting.causes import Cause
from robolink.supervisor.reporting.logs import RunLogs
from robolink.supervisor.reporting.notifier import Notifier, OnEvent
from robolink.supervisor.reporting.printer import Printer, complain
from robolink.supervisor.reporting.summary import Summary
from robolink.supervisor.rules import described, is_orderly
from robolink.system import clocks


class EventDispatcher:
    """Dispatcher of all events and lines; `on_broken` is called with the reason when the output cannot be written.

    `line` is called from a thread for each process, all else from one.
    """

    def __init__(
        self,
        names: Sequence[str],
        output: TextIO,
        *,
        logs: RunLogs | None,
        on_event: OnEvent | None,
        on_broken: Callable[[str], object],
    ) -> None:
        troubles = Troubles(on_broken, self._lost)
        self._logs = logs
        self._printer = Printer(output, names, troubles)
        self._notifier = None if on_event is None else Notifier(on_event, troubles)
        self._causes: dict[str, Cause] = {}
        self._summary = Summary()
        self._last_said = ""
        if logs is not None:
            logs.open(list(names), self.say)

    def add(self, name: str) -> None:
        """Note a process that is added while the system runs; call this before its first line."""
        self._printer.add(name)
        if self._logs is not None:
            self._logs.add(name)

    def started(self, name: str, pid: int, restarts: int) -> None:
        """Report that a process was started; call this before its first line."""
        self._causes[name] = Cause()
        self._note(f"{name} started, pid {pid}")
        self._happened(lambda now: Started(name, pid, restarts, now))

    def line(self, name: str, line: bytes) -> None:
        """Report a line of a process; blocks while a slow terminal has too much waiting (backpressure)."""
        self._last_said = ""
        self._causes[name].line(line)
        if self._logs is not None:
            self._logs.line(name, line)
        self._printer.line(name, line)
        self._happened(lambda now: Output(name, line.decode(errors="replace").rstrip("\r\n"), now))

    def exited(self, each: Tracked, pid: int, returncode: int, cause: str = "") -> str:
        """Report the end of a process before the policy learns of it; return the cause, or ''."""
        found = self._causes.get(each.name)
        if returncode and not cause and found is not None:
            cause = found.text
        how = described(returncode)
        told = f"{each.name} {how}" + (f": {cause}" if cause else "")
        if returncode if each.step is None else not is_orderly(returncode, each.step, cause):
            self._summary.failed(each.name, told, restarts=each.restarts, was_asked=each.step is not None)
        self._note(f"{each.name}, pid {pid}, {how}")
        self._happened(lambda now: Exited(each.name, pid, returncode, how, cause, now))
        return cause

    def restarting(self, name: str, delay: float) -> None:
        """Report that a process will be restarted after `delay` seconds."""
        self._happened(lambda now: Restarting(name, round(delay, 6), now))

    def stopping(self, asked: Sequence[Ask]) -> None:
        """Report that processes were asked to stop, all by the same step."""
        names = [each.name for each in asked]
        self._note(f"{asked[0].step.name.lower()} {', '.join(names)}")
        self._happened(lambda now: Stopping(names, asked[0].step.name.lower(), now))

    def say(self, text: str) -> None:
        """Print a line to the user; never blocks."""
        self._last_said = text
        self._printer.say(text)
        self._note(text)
        self._happened(lambda now: Said(text, now))

    def ended(self, code: int, still_running: Collection[str]) -> None:
        """Report the end of the system: after failures with a summary and the folder of the logs."""
        folder = None if self._logs is None else self._logs.folder
        lines = self._summary.lines(still_running)
        if len(lines) > 1:
            lines = ["summary:", *(f"  {each}" for each in lines)]
        elif lines != [self._last_said]:
            lines = [f"summary: {each}" for each in lines]
        else:
            lines = []
        if folder is not None and (code or lines):
            lines.append(f"logs: {folder}")
        for each in lines:
            self.say(each)
        self._note(f"exit code {code}")
        self._happened(lambda now: Ended(code, "" if folder is None else str(folder), now))

    def close(self) -> None:
        """Flush the queues and close the log files."""
        self._printer.close()
        if self._notifier is not None:
            self._notifier.close()
        if self._logs is not None:
            self._logs.close()

    def _lost(self, reason: str) -> None:
        """Report lost output, as on a full disk, where it may still be seen, and go on."""
        text = f"lines of the output are lost: {reason}"
        complain(text)
        self._note(text)

    def _note(self, text: str) -> None:
        if self._logs is not None:
            self._logs.say(text)

    def _happened(self, event: Callable[[float], Event]) -> None:
        if self._notifier is not None:
            self._notifier.put(event(clocks.time_of_day()))
