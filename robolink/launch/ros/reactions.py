"""Interpreter of a launch file that goes on: timers, event handlers and emitted events, as a director of the system.

It knows no processes and no clock: `robolink.supervisor.director` says what it hears and what it may ask for.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robolink.exceptions import DocumentError
from robolink.launch.entry import Stage
from robolink.launch.ros.launch import events, process_events
from robolink.launch.ros.launch.actions import EmitEvent, ExecuteLocal, TimerAction
from robolink.launch.ros.launch.bases import BaseEventHandler, Event, LaunchDescriptionEntity, entities_in
from robolink.launch.ros.launch.event_handlers import OnProcessIO, OnShutdown
from robolink.launch.ros.launch.utilities import is_true
from robolink.launch.ros.launch_ros.events import ChangeState, StateTransition
from robolink.launch.ros.launch_ros.lifecycle import LifecycleNode, transitions
from robolink.launch.ros.surroundings import roots_of, surroundings
from robolink.launch.ros.visit import Started, Visit
from robolink.supervisor.director import Add, End, Request, Signal, Stop, Tell

if TYPE_CHECKING:
    from robolink.interfaces.lifecycle_msgs.msg import TransitionEvent
    from robolink.launch.ros.stage import Lifecycles

MOST_EVENTS = 10_000
"""Most events that may follow from each other at one time; two handlers that emit events might go on for ever."""
T = TypeVar("T")
_BY_THE_USER = events.Shutdown(reason="the system is stopped", due_to_sigint=True)


class Reactions(Generic[T]):
    """Director of the system of one launch file.

    Args:
        visit: Visit of the file, up to the first timer or event.
        stage: Runner of the system.
        outlives: True for a LaunchService: the end of the launch is an event like others, after which it goes on until
            nothing is left.
    """

    def __init__(self, visit: Visit, stage: Stage[T], *, outlives: bool = False) -> None:
        self._visit, self._stage, self._outlives = visit, stage, outlives
        self._lifecycles: Lifecycles | None = None
        self._timers: list[tuple[float, int, TimerAction, dict[str, Any]]] = []
        self._numbers = itertools.count()
        self._actions: dict[str, ExecuteLocal] = {}
        self._requests: list[Request[T]] = []
        self._shutdown = _BY_THE_USER
        self._is_stopping = False
        self._moment = 0.0
        self._roots: list[str] | None = None
        self._alive: set[str] = set()
        """Names of the processes that run."""
        self._started = list(visit.started)
        visit.started.clear()
        for each in self._started:
            self._actions[each.process] = each.action

    @property
    def hears_lines(self) -> bool:
        """True if a handler wants the lines of the processes."""
        return any(isinstance(each, OnProcessIO) for each in self._visit.context.handlers)

    @property
    def deadline(self) -> float | None:
        """Time of the next timer."""
        while self._timers and self._timers[0][2].is_canceled:
            heapq.heappop(self._timers)
        return self._timers[0][0] if self._timers and (self._outlives or not self._is_stopping) else None

    def action_of(self, name: str) -> ExecuteLocal | None:
        """Return the action that has started, or will start, a process; None for none."""
        return self._actions.get(name)

    @property
    def shutdown_event(self) -> events.Shutdown:
        """The event of the end of the launch, the last one that came."""
        return self._shutdown

    @property
    def alive(self) -> list[str]:
        """Names of the processes that run, in the order in which they were requested."""
        return [name for name in self._actions if name in self._alive]

    def begin(self, now: float) -> list[Request[T]]:
        """Begin the timers, and handle what the file has emitted already."""
        started, self._started = self._started, []
        return self._following(now, lambda: self._live(started))

    def started(self, name: str, pid: int, now: float) -> list[Request[T]]:
        """Handle that a process runs."""
        action = self._actions.get(name)
        if action is None:
            return []
        self._alive.add(name)
        details = self._details(action, name, pid)
        action.process_details = {"action": action, **details}
        return self._following(now, lambda: self._emit(process_events.ProcessStarted(action=action, **details)))

    def exited(self, name: str, returncode: int, now: float) -> list[Request[T]]:
        """Handle that a process has ended."""
        action = self._actions.get(name)
        if action is None:
            return []
        self._alive.discard(name)
        action.return_code = returncode
        details = self._details(action, name, (action.process_details or {}).get("pid", 0))

        def emit() -> None:
            self._emit(process_events.ProcessExited(action=action, returncode=returncode, **details))
            self._visit.context.completed(action)

        return self._following(now, emit)

    def left_out(self, name: str, now: float) -> list[Request[T]]:
        """Handle that a process is not started: what waits for it goes on."""
        action = self._actions.get(name)
        return [] if action is None else self._following(now, lambda: self._go_on_without(action))

    def line(self, name: str, line: bytes, now: float, fd: int | None = None) -> list[Request[T]]:
        """Handle a line of a process; `robolink launch` reads standard output and errors as one."""
        action = self._actions.get(name)
        if action is None:
            return []
        details = self._details(action, name, (action.process_details or {}).get("pid", 0))

        def emit() -> None:
            for each in (1, 2) if fd is None else (fd,):
                kind = process_events.ProcessStdout if each == 1 else process_events.ProcessStderr
                self._emit(kind(action=action, text=line, **details))

        return self._following(now, emit)

    def stopping(self, now: float) -> list[Request[T]]:
        """Handle that the system ends: handlers of the shutdown run, and no timer does any more."""
        self._is_stopping = self._visit.context.is_shutdown = True
        if not self._alive and self._shutdown is _BY_THE_USER:
            self._shutdown = events.Shutdown(reason="idle")
        return self._following(now, lambda: self._handle(self._shutdown))

    def settle(self, now: float) -> list[Request[T]]:
        """Handle what was emitted since the last look."""
        return self._following(now, lambda: None)

    def woken(self, now: float) -> list[Request[T]]:
        """Carry out the timers whose time has come."""

        def fire() -> None:
            while (deadline := self.deadline) is not None and deadline <= now:
                _, _, timer, around = heapq.heappop(self._timers)
                try:
                    self._visit.check(timer, timer.actions)
                    self._visit.run_within(timer.actions, around)
                finally:  # whatever comes: a LaunchService waits for it
                    self._visit.context.completed(timer)
                    timer.complete()

        return self._following(now, fire)

    def emit(self, event: Event, now: float) -> list[Request[T]]:
        """Handle an event that somebody else than the launch file emits."""
        return self._following(now, lambda: self._emit(event))

    def _details(self, action: ExecuteLocal, name: str, pid: int) -> dict[str, Any]:
        """Return the details of a process in the events about it, with its name on the terminal."""
        known = {"name": name, "cmd": [], "cwd": None, "env": None, **(action.process_details or {}), "pid": pid}
        known.pop("action", None)
        return known if self._outlives else {**known, "name": name}

    # What follows from an event

    def _following(self, now: float, act: Callable[[], None]) -> list[Request[T]]:
        """Carry out `act`, and all that follows from it at once; return the requests."""
        if now != self._moment:  # what happens for ever at one moment is a mistake, and a long life is none
            self._moment, self._visit.visited = now, 0
        if self._roots is None:
            self._roots = roots_of(self._visit.maker.home)
        try:
            with surroundings(self._visit.maker.home, self._roots) as absences, self._visit.placing(None):
                absences.say = self._visit.context.said.append
                act()
                self._settle(now)
        except DocumentError as error:
            self._requests.append(End(str(error), 1))
        requests, self._requests = self._requests, []
        return requests

    def _settle(self, now: float) -> None:
        context = self._visit.context
        for _ in range(MOST_EVENTS):
            self._take_over(now)
            if not context.emitted:
                return
            event = context.emitted.get_nowait()
            with self._visit.placing(None):
                self._carry_out(event)
        raise DocumentError(f"it never ends: more than {MOST_EVENTS:,} events follow from each other")

    def _take_over(self, now: float) -> None:
        """Turn what the visit has requested since the last look into requests and timers."""
        visit = self._visit
        with visit.placing(None):
            visit.take()
        said, visit.context.said[:] = list(visit.context.said), []
        self._requests += [Tell(each, getattr(each, "severity", "INFO")) for each in said]
        while visit.timers:  # each is taken before it may fail
            self._add_timer(*visit.timers.pop(0), now)
        started, visit.started[:] = list(visit.started), []
        for each in started:
            self._actions[each.process] = each.action
        if started and not self._is_stopping:
            self._requests += map(Add, self._planned(started))
            self._live(started)
        elif started:
            for each in started:
                each.action.complete()
        finished, visit.context.finished = visit.context.finished, []
        complete = [events.ExecutionComplete(action=each) for each in finished]
        visit.context.emitted.extend(each for each in complete if visit.context.would_handle_event(each))
        absent, visit.absent[:] = list(visit.absent), []
        for action in absent:
            self._go_on_without(action)
            action.complete()

    def _add_timer(self, timer: TimerAction, around: dict[str, Any], now: float) -> None:
        try:
            with self._visit.placing(timer):
                due = now + timer.seconds(self._visit.context)
        except DocumentError:
            timer.complete()
            raise
        heapq.heappush(self._timers, (due, next(self._numbers), timer, around))

    def _planned(self, started: Sequence[Started]) -> Sequence[T]:
        try:
            return self._stage.plan([each.entry for each in started])
        except Exception:
            for each in started:  # none of them is started
                each.action.complete()
            raise

    def _go_on_without(self, action: ExecuteLocal) -> None:
        """Let what waits for a process that is left out go on, as if it had started and ended well."""
        details = self._details(action, "", 0)
        self._emit(process_events.ProcessStarted(action=action, **details))
        event = process_events.ProcessExited(action=action, returncode=0, **details)
        for handler in list(self._visit.context.handlers):
            with self._visit.placing(handler):
                is_meant = handler.matches(event)
            if is_meant and _starts_only(self._visit.following(handler)):
                self._react(handler, event)

    def _emit(self, event: Event) -> None:
        self._visit.context.emit_event_sync(event)

    def _carry_out(self, event: Event) -> None:
        """Do what an event asks for, and run its handlers."""
        if isinstance(event, events.Shutdown):
            self._shutdown = event
            self._requests.append(End(f"the launch file ends the system: {event.reason}"))
            if self._outlives:
                self._outlive(event)
            return
        if isinstance(event, process_events.SignalProcess):
            self._requests += [Signal(name, int(event.signal)) for name in self._meant(event)]
        elif isinstance(event, process_events.ShutdownProcess):
            self._requests += [Stop(name) for name in self._meant(event)]
        elif isinstance(event, ChangeState):
            self._change(event)
        self._handle(event)
        if isinstance(event, events.IncludeLaunchDescription):  # its own handlers come too late for this event
            self._visit.run([event.launch_description])

    def _outlive(self, event: events.Shutdown) -> None:
        """End the launch as a LaunchService does: no process is started any more, and few timers go on."""
        self._is_stopping = self._visit.context.is_shutdown = True
        for _, _, timer, around in self._timers:
            if self._ends_with_the_launch(timer, around):
                timer.cancel()
        self._handle(event)

    def _ends_with_the_launch(self, timer: TimerAction, around: dict[str, Any]) -> bool:
        try:
            with self._visit.placing(timer):
                return self._visit.within(around, partial(is_true, self._visit.context, timer.cancel_on_shutdown))
        except DocumentError as error:  # the others have to end all the same
            self._requests.append(End(str(error), 1))
            return True

    # Nodes with a lifecycle

    def _live(self, started: Iterable[Started]) -> None:
        """Hear of the transitions of nodes with a lifecycle, and bring those to life that want it."""
        for each in started:
            action = each.action
            if isinstance(action, LifecycleNode) and action.expanded_name is not None:
                self._own_lifecycles().watch(action.expanded_name)
                with self._visit.placing(action):
                    starts_itself = is_true(self._visit.context, action.autostart)
                if starts_itself:
                    self._visit.run(transitions([action.expanded_name], [1, 3], self._visit.context))

    def _change(self, event: ChangeState) -> None:
        nodes = [each for each in self._actions.values() if isinstance(each, LifecycleNode)]
        names = [each.expanded_name for each in nodes if event.lifecycle_node_matcher(each)]
        for name in names or [event.node_name]:
            if name:
                self._own_lifecycles().change(name, event.transition_id)

    def _own_lifecycles(self) -> Lifecycles:
        if self._lifecycles is None:
            from robolink.launch.ros.stage import Lifecycles  # late: it needs the classes of messages

            def say(text: str) -> None:
                self._stage.post(lambda now: [Tell(text)])

            self._lifecycles = Lifecycles(self._stage.with_node, self._on_transition, say)
        return self._lifecycles

    def _on_transition(self, name: str, message: TransitionEvent) -> None:
        action = next((each for each in self._actions.values() if getattr(each, "expanded_name", "") == name), None)
        if action is None:
            action = LifecycleNode(name=name, namespace="", package="unknown", executable="unknown")
            action.expanded_name = name
        event = StateTransition(action=action, msg=message)
        self._stage.post(lambda now: self._following(now, lambda: self._emit(event)))

    def _meant(self, event: process_events.ProcessTargetedEvent) -> list[str]:
        return [name for name, action in self._actions.items() if event.process_matcher(action)]

    def _handle(self, event: Event) -> None:
        for handler in list(self._visit.context.handlers):
            with self._visit.placing(handler):
                is_meant = handler.matches(event)
            is_for_all = self._outlives or not self._is_stopping or event is not self._shutdown
            if is_meant and (is_for_all or isinstance(handler, OnShutdown)):
                self._react(handler, event)

    def _react(self, handler: BaseEventHandler, event: Event) -> None:
        context = self._visit.context
        context._push_locals()
        try:
            with self._visit.placing(handler):
                entities = self._visit.within(handler.around, lambda: entities_in(handler.handle(event, context)))
            self._visit.check(handler, entities)
            self._visit.run_within(entities, handler.around)
        finally:
            context._pop_locals()


def _starts_only(found: Sequence[LaunchDescriptionEntity]) -> bool:
    """True if what follows is known, and ends nothing."""
    return bool(found) and not any(isinstance(each, EmitEvent) for each in found)
