"""Join process, printer and policy: one loop that waits for events and does what the policy says."""

from __future__ import annotations

import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from types import FrameType
from typing import TextIO, TypeAlias

from robolink.queues import get_within
from robolink.supervisor.guardian import Guardian
from robolink.supervisor.lifeline import Lifeline
from robolink.supervisor.policy import Action, Ask, Policy, Step
from robolink.supervisor.printer import Printer
from robolink.supervisor.process import Child, Process

_LEFT_BEHIND = 1.0
"""Seconds that processes have which outlive the one that started them, between SIGTERM and SIGKILL."""


_LOOK_UP = 0.25
"""Seconds after which a wait ends by itself. On Windows Ctrl-C does not end one, and elsewhere a signal may come
between the last look for signals and the wait, and be seen only after it."""


@dataclass(frozen=True)
class _Exited:
    name: str
    returncode: int


@dataclass(frozen=True)
class _Interrupted:
    """The user, or whoever started us, wants an end."""

    in_hurry: bool = False


class _Paused:
    """The user pressed Ctrl-Z."""


_Event: TypeAlias = "_Exited | _Interrupted | _Paused"


class Supervisor:
    """Runs processes as one system, until the first of them ends or the user wants an end.

    >>> Supervisor([Process("hello", [sys.executable, "-c", "print('hi')"])]).run()
    0
    """

    def __init__(
        self,
        processes: Sequence[Process],
        *,
        output: TextIO | None = None,
        patience: float = 5.0,
        clock: Callable[[], float] = time.monotonic,
        start: Callable[[Process, Lifeline], Child] = Child,
    ) -> None:
        self._processes = processes
        self._output = output or sys.stdout
        self._patience = patience
        self._clock = clock
        self._start_child = start
        self._children: dict[str, Child] = {}
        self._events: queue.SimpleQueue[_Event] = queue.SimpleQueue()

    def run(self, duration: float | None = None) -> int:
        """Run the system, for at most `duration` seconds; give its exit code.

        That is the code of the first process to end (128 + N when signal N killed it), or 0 when all of them
        ended in order because the user (SIGINT, SIGTERM, SIGHUP) or the duration wanted it. Stopping goes by
        SIGINT, SIGTERM and SIGKILL to each process group, with `patience` seconds between; a second SIGINT
        goes straight to the next step. Raises `ProcessStartError`, after stopping what had been started.
        """
        ends = None if duration is None else self._clock() + duration
        policy = Policy([each.name for each in self._processes], ends=ends, patience=self._patience)
        with ExitStack() as stack:
            stack.enter_context(_signals(self._events.put))
            printer = stack.enter_context(closing(self._make_printer(policy)))
            lifeline = stack.enter_context(closing(Lifeline()))
            guardian = stack.enter_context(closing(Guardian()))
            stack.callback(self._clear_away, guardian)
            for process in self._processes:
                self._start(process, lifeline, guardian, printer)
            while not policy.is_over:
                self._do(self._decide(policy), printer)
        return policy.code

    def stop(self) -> None:
        """Ask for an end, from any thread."""
        self._events.put(_Interrupted())

    def _make_printer(self, policy: Policy) -> Printer:
        return Printer(self._output, policy.alive, on_broken=self.stop)

    def _start(self, process: Process, lifeline: Lifeline, guardian: Guardian, printer: Printer) -> None:
        child = self._start_child(process, lifeline)
        guardian.guard(child.group)
        self._children[process.name] = child
        child.watch(printer.line, lambda name, returncode: self._events.put(_Exited(name, returncode)))

    def _decide(self, policy: Policy) -> list[Action]:
        """Wait for something to happen and ask the policy what to do about it."""
        event = self._next_event(policy.deadline)
        now = self._clock()
        if isinstance(event, _Exited):
            return policy.exited(event.name, event.returncode, now)
        if isinstance(event, _Interrupted):
            return policy.interrupted(now, in_hurry=event.in_hurry)
        if isinstance(event, _Paused):
            self._pause()
        return policy.woken(now)

    def _next_event(self, deadline: float | None) -> _Event | None:
        timeout = _LOOK_UP if deadline is None else min(_LOOK_UP, max(0.0, deadline - self._clock()))
        try:
            return get_within(self._events, timeout)
        except queue.Empty:
            return None

    def _do(self, actions: list[Action], printer: Printer) -> None:
        for action in actions:
            if isinstance(action, Ask):
                self._children[action.name].ask(action.step)
            else:
                printer.say(action.text)

    def _pause(self) -> None:
        """Pause with all processes, as a shell's Ctrl-Z does with a program; go on when we are let go on."""
        if sys.platform != "win32":
            for child in self._children.values():
                child.pause()
            handler = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
            signal.raise_signal(signal.SIGTSTP)
            signal.signal(signal.SIGTSTP, handler)
            for child in self._children.values():
                child.resume()

    def _clear_away(self, guardian: Guardian) -> None:
        """Kill what is left of the process groups: after an orderly end nothing is."""
        for child in self._children.values():
            child.ask(Step.TERMINATE)
        deadline = time.monotonic() + _LEFT_BEHIND
        while any(child.is_left() for child in self._children.values()) and time.monotonic() < deadline:
            time.sleep(0.02)
        for child in self._children.values():
            child.ask(Step.KILL)
            guardian.release(child.group)


@contextmanager
def _signals(put: Callable[[_Event], None]) -> Iterator[None]:
    """Turn signals into events while this lasts; only a main thread can."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def handle(number: int, frame: FrameType | None) -> None:
        put(_Paused() if number in _PAUSING else _Interrupted(in_hurry=number in _HURRYING))

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
