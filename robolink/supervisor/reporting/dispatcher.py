"""Event dispatcher: passes events to the terminal, log files, and programs (`on_event`); causes and summary of ends."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import TextIO

from robolink.supervisor.events import Ended, Event, Exited, Output, Restarting, Said, Started, Stopping
from robolink.supervisor.policy import Ask, Severity, Tracked, described, is_orderly
from robolink.supervisor.reporting.background_queue import BackgroundQueue, Troubles
from robolink.supervisor.reporting.logs import RunLogs
from robolink.supervisor.reporting.printer import Printer, complain
from robolink.system import clocks
from robolink.system.terminal import shown


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
        failure = f"{each.name} {how}" + (f": {cause}" if cause else "")
        if returncode if each.step is None else not is_orderly(returncode, each.step, cause):
            self._summary.failed(each.name, failure, restarts=each.restarts, was_requested=each.step is not None)
        self._note(f"{each.name}, pid {pid}, {how}")
        self._happened(lambda now: Exited(each.name, pid, returncode, how, cause, now))
        return cause

    def restarting(self, name: str, delay: float) -> None:
        """Report that a process will be restarted after `delay` seconds."""
        self._happened(lambda now: Restarting(name, round(delay, 6), now))

    def stopping(self, requests: Sequence[Ask]) -> None:
        """Report that processes were requested to stop, all by the same step."""
        names = [each.name for each in requests]
        self._note(f"{requests[0].step.name.lower()} {', '.join(names)}")
        self._happened(lambda now: Stopping(names, requests[0].step.name.lower(), now))

    def say(self, text: str, severity: Severity = "INFO") -> None:
        """Print a line to the user; never blocks."""
        self._last_said = text
        self._printer.say(text, severity)
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
        for each in lines:
            self.say(each, "ERROR")
        if folder is not None and (code or lines):
            self.say(f"logs: {folder}")
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


OnEvent = Callable[[Event], object]
_SIZE = 200
"""Approximate size of an event, in bytes, without its line of output."""


class Notifier:
    """Calls `on_event`, which may raise OSError and ValueError when it cannot write."""

    def __init__(self, on_event: OnEvent, troubles: Troubles) -> None:
        self._queue: BackgroundQueue[Event] = BackgroundQueue(
            lambda one: on_event(*one), troubles, name="events", at_once=1
        )

    def put(self, event: Event) -> None:
        """Enqueue an event; only one with output ever blocks. All others are few."""
        if isinstance(event, Output):
            self._queue.put(event, _SIZE + len(event.line))
        else:
            self._queue.put_own(event, _SIZE)

    def close(self, timeout: float = 1.0) -> None:
        """Deliver what waits, for at most `timeout` seconds."""
        self._queue.close(timeout)


@dataclass
class Failures:
    """Last failure of a process in words, and the number of its failures."""

    last: str
    times: int = 0
    restarts: int = 0


class Summary:
    """Collects failures; `lines` describes them."""

    def __init__(self) -> None:
        self._failures: dict[str, Failures] = {}

    def failed(self, name: str, how: str, *, restarts: int, was_requested: bool) -> None:
        """Note a failure: `world was killed by SIGSEGV`, also of a process that had been requested to stop."""
        failures = self._failures.setdefault(name, Failures(how))
        failures.last = f"{how} (when asked to stop)" if was_requested else how
        failures.times += 1
        failures.restarts = restarts

    def lines(self, still_running: Iterable[str] = ()) -> list[str]:
        """Return a line for each process that failed, in the order of their first failures."""
        lines = [_line(each) for each in self._failures.values()]
        return lines + [f"{name} still runs: it could not be killed" for name in still_running]


def _line(failures: Failures) -> str:
    if failures.times == 1 and failures.restarts == 0:
        return failures.last
    failed = f"failed {failures.times} times, " if failures.times > 1 else ""
    times = "once" if failures.restarts == 1 else f"{failures.restarts} times"
    return f"{failures.last} ({failed}started again {times})"


_STALE = 25
"""Age in lines at which a possible cause is dropped: a program does not end because of older output."""
_LONGEST = 200
_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
_GROUP = re.compile(r"^\s*[+|][ -]")
"""Prefix of the lines of an exception group."""
_FRAME = re.compile(r'^\s+File ".*", line \d+(, in .*)?$')
_HEADER = "Traceback (most recent call last):"
_CHAINS = (
    "The above exception was the direct cause of the following exception:",
    "During handling of the above exception, another exception occurred:",
)
_INTERRUPTED = "KeyboardInterrupt"
_FATAL = ("Fatal Python error: ", "terminate called ")
"""Beginnings of a fatal error of Python and of an uncaught exception of C++."""
_NOT_BEGUN = "Fatal Python error: init_"
"""Beginning of an error in Python's own start, before its program; a Ctrl-C at that time shows as any error."""
_OWN = "robolink: "
"""Prefix of an error by which a command of robolink ends."""


class Cause:
    """Line-by-line parser of a program's output; `text` is then the cause of its end, or empty.

    An error that follows from a Ctrl-C has that as its cause: in the middle of an import it may show as any error.
    """

    def __init__(self) -> None:
        self._found = ""
        self._age = 0
        self._is_in_traceback = self._is_led_to = False

    @property
    def text(self) -> str:
        """Cause on one line, for example `ZeroDivisionError: division by zero`."""
        return self._found if self._age <= _STALE else ""

    def line(self, line: bytes) -> None:
        """Parse a line."""
        self._age += 1
        text = line[: 4 * _LONGEST].decode(errors="replace").rstrip()
        if "\x1b" in text:
            text = _COLOURS.sub("", text)
        if self._is_in_traceback:
            self._traceback(text)
        elif text.endswith(_HEADER) or _FRAME.match(text):
            self._is_in_traceback = True
        elif text in _CHAINS:
            self._is_led_to = self._found == _INTERRUPTED
        elif text.startswith(_OWN):
            self._note(text.removeprefix(_OWN))
        elif text.startswith(_FATAL) or text == _INTERRUPTED:  # without a traceback, as early as that
            self._note(text)
        elif text.startswith("  what():"):
            self._note(text.partition(":")[2].strip())

    def _traceback(self, text: str) -> None:
        """Wait for the line that is not indented: the exception."""
        plain = _GROUP.sub("", text)
        if plain and not plain[0].isspace() and not plain.endswith(_HEADER):
            self._is_in_traceback = False
            self._note(plain)

    def _note(self, text: str) -> None:
        if self.text.startswith(_NOT_BEGUN) and text != _INTERRUPTED:
            return
        self._found, self._age = _INTERRUPTED if self._is_led_to else shown(text, _LONGEST), 0
        self._is_led_to = False
