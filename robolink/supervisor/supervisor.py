"""Event loop of the supervisor: waits for events and carries out the policy's actions."""

from __future__ import annotations

import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, ExitStack, closing, contextmanager
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TextIO, TypeAlias

from robolink.exceptions import NotFoundError
from robolink.supervisor.director import Add, Director, Request, Signal, Stop, Tell
from robolink.supervisor.events import Status
from robolink.supervisor.policy import Action, Ask, Policy, Say, Severity, Start, Step
from robolink.supervisor.processes.affinity import set_affinity
from robolink.supervisor.processes.guardian import Guardian
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child, Process, ProcessStartError
from robolink.supervisor.reporting.dispatcher import EventDispatcher, OnEvent
from robolink.supervisor.reporting.logs import RunLogs
from robolink.system import clocks
from robolink.system.waits import get_within

_LEFT_BEHIND = 1.0
"""Time between SIGTERM and SIGKILL for processes that still run when the supervisor has to leave, in seconds."""


_LOOK_UP = 0.25
"""Longest single wait of the loop, in seconds. On Windows Ctrl-C does not end one, and elsewhere a signal may come
between the last look for signals and the wait, and be seen only after it."""

_NOT_STARTED = 127
"""Exit code, as in a shell, of a process that cannot be started (again) while the system runs."""

_Event: TypeAlias = Callable[[float], list[Action]]
"""Event of the loop, as a function of the time at which the loop takes it."""


class Supervisor:
    """Runs processes as one system, until one ends whose end counts, or the user asks for the end.

    All methods but `run` may be called from any thread, before and while it runs.

    Args:
        processes: The processes, with unique names.
        output: Terminal or file for their lines; None is `sys.stdout`.
        patience: Time between the steps of stopping a process, in seconds.
        logs: Log files of the run; None writes none.
        on_event: Called with each `Event`, on a background thread.
        clock: Source of monotonic time, in seconds.
        start: Starts a process; tests pass a fake.
        director: Maker of what adds and ends processes while the system runs; None has none.

    >>> Supervisor([Process("hello", [sys.executable, "-c", "print('hi')"])]).run()
    [hello] hi
    [launch] hello has ended
    0
    """

    def __init__(
        self,
        processes: Sequence[Process],
        *,
        output: TextIO | None = None,
        patience: float = 5.0,
        logs: RunLogs | None = None,
        on_event: OnEvent | None = None,
        clock: Callable[[], float] = clocks.monotonic,
        start: Callable[[Process, Lifeline], Child] = Child,
        director: Callable[[Supervisor], Director[Process]] | None = None,
    ) -> None:
        self._processes = {each.name: each for each in processes}
        self._output = output or sys.stdout
        self._logs = logs
        self._on_event = on_event
        self._clock = clock
        self._start_child = start
        self._children: dict[str, Child] = {}
        self._events: queue.SimpleQueue[_Event] = queue.SimpleQueue()
        self._policy = Policy({each.name: each.rules for each in processes}, patience=patience)
        self._lock = threading.Lock()  # held whenever the policy is called
        self._director = None if director is None else director(self)
        self._has_begun = self._is_end_reported = self._is_running = False
        self._said_before: list[Say] = []
        self.leavings: list[Path] = []
        """Files that the guardian removes if this process is killed; fill it before or while entering `beside`."""
        self.is_end_requested = False
        """True from the first signal or `stop` on, even while the loop is busy and has not taken it yet."""

    def run(self, duration: float | None = None, beside: Iterable[AbstractContextManager[object]] = ()) -> int:
        """Run the system, for at most `duration` seconds, and return its exit code.

        `beside` are context managers that are entered before the first process starts and left at the end.

        The code is that of the process whose end was the system's (128 + N when signal N killed it): the first that
        ends, but for those whose rules start them again or ignore their end; or the last of all. It is 0 when all
        ended in order because the user (SIGINT, SIGTERM, SIGHUP) or the duration requested it. Stopping goes by
        SIGINT, SIGTERM and SIGKILL to each process group, with `patience` seconds between; a second SIGINT
        goes straight to the next step. Raises `ProcessStartError`, after stopping what had been started.
        """
        with ExitStack() as stack:
            stack.enter_context(_signals(self._interrupt, lambda: self._events.put(self._paused)))
            for each in beside:
                stack.enter_context(each)
            self._dispatcher = stack.enter_context(closing(self._make_dispatcher()))
            self._lifeline = stack.enter_context(closing(Lifeline()))
            self._guardian = stack.enter_context(closing(Guardian(self._lifeline.mark, leavings=self.leavings)))
            stack.callback(self._clear_away)
            self._tell_first()
            self._do(self._begin(duration))
            self._has_begun = True
            while not self._policy.is_over:
                event = self._next_event()
                with self._lock:
                    actions = event(self._clock())
                self._do(actions)
                self._tell_end()
            self._dispatcher.ended(self._policy.code, self._policy.alive)
        return self._policy.code

    def stop(self, *, in_hurry: bool = False) -> None:
        """Stop the whole system; returns at once. If it is stopping already, `in_hurry` goes on to the next step."""
        self._interrupt(in_hurry=in_hurry)

    def restart(self, name: str) -> None:
        """Stop the process `name` in order and start it again; if it does not run, start it. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.restart(name, now))

    def why_not_restarted(self, name: str) -> str:
        """Return why `restart` of the process `name` would do nothing now; '' if it would do something."""
        with self._lock:
            return self._policy.why_not_restarted(name)

    def stop_one(self, name: str) -> None:
        """Stop the process `name` in order; the others go on, if there are any. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.stop_one(name, now))

    def why_not_stopped(self, name: str) -> str:
        """Return why `stop_one` of the process `name` would do nothing now; '' if it would do something."""
        with self._lock:
            return self._policy.why_not_stopped(name)

    def release(self, name: str) -> None:
        """Start the held process `name`, since its conditions are met. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.released(name, now))

    def direct(self, act: Callable[[float], Sequence[Request[Process]]]) -> None:
        """Call `act` with the time in the loop, where the director is called, and carry out what it returns."""
        self._events.put(lambda now: self._directed(act(now), now))

    def say(self, text: str, severity: Severity = "INFO") -> None:
        """Print `text` to the user as a line of the launcher's own, in the colour of its `severity`.

        After the end it is lost.
        """
        if self._is_running:
            self._events.put(lambda now: [Say(text, severity)])
        else:
            self._said_before.append(Say(text, severity))

    def status(self) -> list[Status]:
        """Return the current state of each process."""
        with self._lock:
            begin = clocks.time_of_day() - self._clock()
            return [
                Status(name, self._pid(name), each.state, each.restarts, each.returncode, begin + each.since)
                for name, each in self._policy.processes.items()
            ]

    def _pid(self, name: str) -> int | None:
        child = self._children.get(name)
        return None if child is None else child.group

    def _put_about(self, name: str, event: _Event) -> None:
        if name not in self._processes:
            raise NotFoundError("process", name, self._processes)
        self._events.put(event)

    def _make_dispatcher(self) -> EventDispatcher:
        return EventDispatcher(
            list(self._processes), self._output, logs=self._logs, on_event=self._on_event, on_broken=self._unread
        )

    def _unread(self, reason: str) -> None:
        """Handle a broken output pipe: it ends the system, as it ends any program in a pipe."""
        self.say(f"nobody reads the output any more: {reason}", "WARN")
        self.stop()

    def _tell_first(self) -> None:
        """Print the lines that were said before `run`, above all that follows from the begin."""
        for each in self._said_before:
            self._dispatcher.say(each.text, each.severity)
        self._is_running = True

    def _begin(self, duration: float | None) -> list[Action]:
        now = self._clock()
        with self._lock:
            self._policy.ends = None if duration is None else now + duration
            more = [] if self._director is None else self._directed(self._director.begin(now), now)
            return [*self._policy.begin(now), *more]

    def _next_event(self) -> _Event:
        """Wait for the next event, which is a wake-up when the policy's deadline comes first."""
        deadline = self._deadline()
        timeout = _LOOK_UP if deadline is None else min(_LOOK_UP, max(0.0, deadline - self._clock()))
        try:
            return get_within(self._events, timeout)
        except queue.Empty:
            return self._woken

    def _deadline(self) -> float | None:
        deadlines = [self._policy.deadline, None if self._director is None else self._director.deadline]
        return min((each for each in deadlines if each is not None), default=None)

    def _woken(self, now: float) -> list[Action]:
        due = None if self._director is None else self._director.deadline
        more = [] if due is None or now < due else self._ask(lambda director: director.woken(now), now)
        return [*self._policy.woken(now), *more]

    # What the director decides

    def _ask(self, ask: Callable[[Director[Process]], Sequence[Request[Process]]], now: float) -> list[Action]:
        """Ask the director, if there is one; return the actions that follow."""
        return [] if self._director is None else self._directed(ask(self._director), now)

    def _directed(self, requests: Sequence[Request[Process]], now: float) -> list[Action]:
        """Return the actions that carry out a director's requests."""
        assert self._director is not None
        actions: list[Action] = []
        self._policy.expects_more = self._director.deadline is not None
        for each in requests:
            if isinstance(each, Add):
                self._processes[each.process.name] = each.process
                self._dispatcher.add(each.process.name)
                actions += self._policy.add(each.process.name, each.process.rules, now)
            elif isinstance(each, Stop):
                actions += self._policy.stop_one(each.name, now, is_interrupted=each.is_interrupted)
            elif isinstance(each, Signal):
                if each.name in self._children:
                    self._children[each.name].signal(each.number)
            elif isinstance(each, Tell):
                actions.append(Say(each.text, each.severity))
            else:
                actions += self._policy.end(each.reason, each.code, now)
        return actions

    def _tell_end(self) -> None:
        """Inform the director once that the system is ending."""
        is_ending = self._policy.step is not None or self._policy.is_over
        if self._director is not None and is_ending and not self._is_end_reported:
            self._is_end_reported = True
            with self._lock:
                now = self._clock()
                actions = self._ask(lambda director: director.stopping(now), now)
            self._policy.expects_more = False
            self._do(actions)

    def _do(self, actions: list[Action]) -> None:
        requests = [each for each in actions if isinstance(each, Ask)]
        for action in actions:
            if isinstance(action, Start):
                self._start(self._processes[action.name])
            elif isinstance(action, Say):
                self._dispatcher.say(action.text, action.severity)
            elif action.name in self._children:
                self._children[action.name].ask(action.step)
        if requests:
            self._dispatcher.stopping(requests)

    def _start(self, process: Process) -> None:
        name = process.name
        try:
            child = self._start_child(process, self._lifeline)
        except ProcessStartError as error:
            if not self._has_begun:
                raise
            self._events.put(partial(self._exited, name, _NOT_STARTED, cause=str(error)))
            return
        self._guardian.guard(child.group)
        self._children[name] = child
        if process.cpu and (why_not := set_affinity(child.group, process.cpu)):
            self._dispatcher.say(f"{name}: {why_not}", "WARN")
        self._dispatcher.started(name, child.group, self._policy.processes[name].restarts)
        if self._director is not None:
            pid = child.group
            self._events.put(lambda now: self._ask(lambda director: director.started(name, pid, now), now))
        # Only then: one that ends at once would end before it started.
        child.watch(self._line, lambda name, code: self._events.put(partial(self._exited, name, code)))

    def _line(self, name: str, line: bytes, fd: int | None = None) -> None:
        """Pass on a line of a process, or a piece of one of its streams; called on a thread of its own."""
        self._dispatcher.line(name, line)
        if self._director is not None and self._director.hears_lines:
            self._events.put(lambda now: self._ask(lambda director: director.line(name, line, now, fd), now))

    def _exited(self, name: str, returncode: int, now: float, cause: str = "") -> list[Action]:
        child = self._children.pop(name, None)
        if child is not None:
            self._guardian.release(child.group)
        each = self._policy.processes[name]
        cause = self._dispatcher.exited(each, 0 if child is None else child.group, returncode, cause)
        actions = self._policy.exited(name, returncode, now, cause)
        actions += self._ask(lambda director: director.exited(name, returncode, now), now)
        if each.state == "waiting" and each.due is not None:
            self._dispatcher.restarting(name, each.due - now)
        return actions

    def _interrupt(self, *, in_hurry: bool = False) -> None:
        self.is_end_requested = True
        self._events.put(partial(self._interrupted, in_hurry=in_hurry))

    def _interrupted(self, now: float, *, in_hurry: bool = False) -> list[Action]:
        """Handle an interrupt from the user, or from the parent process."""
        return self._policy.interrupted(now, in_hurry=in_hurry)

    def _paused(self, now: float) -> list[Action]:
        """Handle Ctrl-Z: pause all processes and this one; resume them when this one is resumed."""
        if sys.platform != "win32":
            for child in self._children.values():
                child.pause()
            handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
            signal.raise_signal(signal.SIGTSTP)
            signal.signal(signal.SIGTSTP, handler)
            for child in self._children.values():
                child.resume()
        return []

    def _clear_away(self) -> None:
        """Kill the processes that still run; after an orderly end there are none."""
        for child in self._children.values():
            child.ask(Step.TERMINATE)
        deadline = clocks.monotonic() + _LEFT_BEHIND
        while any(child.is_left() for child in self._children.values()) and clocks.monotonic() < deadline:
            time.sleep(0.02)
        for child in self._children.values():
            child.ask(Step.KILL)
            self._guardian.release(child.group)


@contextmanager
def _signals(interrupt: Callable[..., None], pause: Callable[[], None]) -> Iterator[None]:
    """Convert signals to events while the block runs; only a main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def handle(number: int, frame: FrameType | None) -> None:
        if number in _PAUSING:
            pause()
        else:
            interrupt(in_hurry=number in _HURRYING)

    handled = [*_HURRYING, *(each for each in (*_ENDING, *_PAUSING) if signal.getsignal(each) != signal.SIG_IGN)]
    previous = {number: signal.signal(number, handle) for number in handled}
    try:
        yield
    finally:
        for number, handler in previous.items():
            signal.signal(number, handler)


_HURRYING = [signal.SIGINT]
_ENDING = [signal.SIGTERM]
_PAUSING: list[signal.Signals] = []
if sys.platform == "win32":
    _HURRYING += [signal.SIGBREAK]
else:
    _ENDING += [signal.SIGHUP]  # unless nohup wants it ignored
    _PAUSING += [signal.SIGTSTP]
