"""Run processes as one system: one loop that waits for events and does what the policy says."""

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
from robolink.queues import get_within
from robolink.supervisor.events import Status
from robolink.supervisor.policy import Action, Ask, Policy, Say, Start
from robolink.supervisor.processes.affinity import set_affinity
from robolink.supervisor.processes.guardian import Guardian
from robolink.supervisor.processes.lifeline import Lifeline
from robolink.supervisor.processes.process import Child, Process, ProcessStartError
from robolink.supervisor.rules import Step
from robolink.supervisor.telling.logs import RunLogs
from robolink.supervisor.telling.notifier import OnEvent
from robolink.supervisor.telling.teller import Teller

_LEFT_BEHIND = 1.0
"""Seconds between SIGTERM and SIGKILL for processes that still run when we have to leave."""


_LOOK_UP = 0.25
"""Seconds after which a wait ends by itself. On Windows Ctrl-C does not end one, and elsewhere a signal may come
between the last look for signals and the wait, and be seen only after it."""

_NOT_STARTED = 127
"""The exit code, as in a shell, of what cannot be started (again) while the system runs."""

_Event: TypeAlias = Callable[[float], list[Action]]
"""What happened, as a function of the time at which the loop learns of it."""


class Supervisor:
    """Runs processes as one system, until one ends whose end is not to be ignored, or the user wants an end.

    `logs` keeps what is printed, `on_event` is called with each `Event`, on a thread of its own. All methods but
    `run` may be called from any thread, before and while it runs.

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
        clock: Callable[[], float] = time.monotonic,
        start: Callable[[Process, Lifeline], Child] = Child,
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
        self._lock = threading.Lock()  # held whenever the policy is asked
        self._has_begun = False
        self.leavings: list[Path] = []
        """Files to remove if we should be killed: to be filled before `run`, or on the way into what is beside it."""

    def run(self, duration: float | None = None, beside: Iterable[AbstractContextManager[object]] = ()) -> int:
        """Run the system, for at most `duration` seconds; give its exit code. It runs inside all that is `beside` it.

        That is the code of the process whose end was the system's (128 + N when signal N killed it): the first that
        ends, but for those whose rules start them again or ignore their end; or the last of all. It is 0 when all
        ended in order because the user (SIGINT, SIGTERM, SIGHUP) or the duration wanted it. Stopping goes by
        SIGINT, SIGTERM and SIGKILL to each process group, with `patience` seconds between; a second SIGINT
        goes straight to the next step. Raises `ProcessStartError`, after stopping what had been started.
        """
        with ExitStack() as stack:
            stack.enter_context(_signals(self._interrupted, self._paused, self._events.put))
            for each in beside:
                stack.enter_context(each)
            self._teller = stack.enter_context(closing(self._make_teller()))
            self._lifeline = stack.enter_context(closing(Lifeline()))
            self._guardian = stack.enter_context(closing(Guardian(self._lifeline.mark, leavings=self.leavings)))
            stack.callback(self._clear_away)
            self._do(self._begin(duration))
            self._has_begun = True
            while not self._policy.is_over:
                event = self._next_event()
                with self._lock:
                    actions = event(self._clock())
                self._do(actions)
            self._teller.ended(self._policy.code, self._policy.alive)
        return self._policy.code

    def stop(self) -> None:
        """Ask for an end of the whole system."""
        self._events.put(self._interrupted)

    def restart(self, name: str) -> None:
        """Stop one process in order and start it again; if it does not run, start it. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.restart(name, now))

    def why_not_restarted(self, name: str) -> str:
        """Say why `restart` would do nothing now; '' if it would."""
        with self._lock:
            return self._policy.why_not_restarted(name)

    def stop_one(self, name: str) -> None:
        """Stop one process in order; the others go on, if there are any. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.stop_one(name, now))

    def why_not_stopped(self, name: str) -> str:
        """Say why `stop_one` would do nothing now; '' if it would."""
        with self._lock:
            return self._policy.why_not_stopped(name)

    def release(self, name: str) -> None:
        """Start a held process: what it waits for is there. Raises NotFoundError."""
        self._put_about(name, lambda now: self._policy.released(name, now))

    def say(self, text: str) -> None:
        """Tell the user, as the launcher does; nothing is told after the end."""
        self._events.put(lambda now: [Say(text)])

    def status(self) -> list[Status]:
        """Say how each process stands."""
        with self._lock:
            begin = time.time() - self._clock()
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

    def _make_teller(self) -> Teller:
        return Teller(
            list(self._processes), self._output, logs=self._logs, on_event=self._on_event, on_broken=self._unread
        )

    def _unread(self, reason: str) -> None:
        """Nobody reads the output any more: that ends a system, as it ends any program in a pipe."""
        self.say(f"nobody reads the output any more: {reason}")
        self.stop()

    def _begin(self, duration: float | None) -> list[Action]:
        now = self._clock()
        with self._lock:
            self._policy.ends = None if duration is None else now + duration
            return self._policy.begin(now)

    def _next_event(self) -> _Event:
        """Wait for something to happen, if only for the time to pass at which the policy wants to be woken."""
        deadline = self._policy.deadline
        timeout = _LOOK_UP if deadline is None else min(_LOOK_UP, max(0.0, deadline - self._clock()))
        try:
            return get_within(self._events, timeout)
        except queue.Empty:
            return self._policy.woken

    def _do(self, actions: list[Action]) -> None:
        asked = [each for each in actions if isinstance(each, Ask)]
        for action in actions:
            if isinstance(action, Start):
                self._start(self._processes[action.name])
            elif isinstance(action, Say):
                self._teller.say(action.text)
            elif action.name in self._children:
                self._children[action.name].ask(action.step)
        if asked:
            self._teller.stopping(asked)

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
            self._teller.say(f"{name}: {why_not}")
        self._teller.started(name, child.group, self._policy.processes[name].restarts)
        child.watch(self._teller.line, lambda name, code: self._events.put(partial(self._exited, name, code)))

    def _exited(self, name: str, returncode: int, now: float, cause: str = "") -> list[Action]:
        child = self._children.pop(name, None)
        if child is not None:
            self._guardian.release(child.group)
        each = self._policy.processes[name]
        cause = self._teller.exited(each, 0 if child is None else child.group, returncode, cause)
        actions = self._policy.exited(name, returncode, now, cause)
        if each.state == "waiting" and each.due is not None:
            self._teller.restarting(name, each.due - now)
        return actions

    def _interrupted(self, now: float, *, in_hurry: bool = False) -> list[Action]:
        """The user, or whoever started us, wants an end."""
        return self._policy.interrupted(now, in_hurry=in_hurry)

    def _paused(self, now: float) -> list[Action]:
        """Pause with all processes, as a shell's Ctrl-Z does with a program; go on when we are let go on."""
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
        """Kill what still runs: after an orderly end nothing does."""
        for child in self._children.values():
            child.ask(Step.TERMINATE)
        deadline = time.monotonic() + _LEFT_BEHIND
        while any(child.is_left() for child in self._children.values()) and time.monotonic() < deadline:
            time.sleep(0.02)
        for child in self._children.values():
            child.ask(Step.KILL)
            self._guardian.release(child.group)


@contextmanager
def _signals(interrupted: Callable[..., list[Action]], paused: _Event, put: Callable[[_Event], None]) -> Iterator[None]:
    """Turn signals into events while this lasts; only a main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def handle(number: int, frame: FrameType | None) -> None:
        put(paused if number in _PAUSING else partial(interrupted, in_hurry=number in _HURRYING))

    wanted = [*_HURRYING, *(each for each in (*_ENDING, *_PAUSING) if signal.getsignal(each) != signal.SIG_IGN)]
    previous = {number: signal.signal(number, handle) for number in wanted}
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
