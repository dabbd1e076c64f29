"""Executors: they wait, take what is ready in the order in which it became ready, and run the callbacks."""

from __future__ import annotations

import heapq
import inspect
import itertools
import threading
import traceback
from collections import deque
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.entity import NOTHING, Entity
from robolink.exceptions import ExternalShutdownException, InterruptedByUser, RobolinkError
from robolink.inbox import Inbox
from robolink.logging import get_logger
from robolink.task import Future, Task
from robolink.task_runner import TaskRunner
from robolink.utilities import get_default_context

if TYPE_CHECKING:
    from robolink.clock import ROSClock
    from robolink.context import Context
    from robolink.node import Node
    from robolink.timer import Timer

ExecutorT = TypeVar("ExecutorT", bound="Executor")

POLL_NS = 1_000_000
"""How often a coroutine is asked that awaits something of nobody's: neither our futures nor a plain function."""


class TimeoutException(RobolinkError):  # noqa: N818 - rclpy's name
    """Nothing became ready in time."""


class ShutdownException(RobolinkError):  # noqa: N818 - rclpy's name
    """The executor was shut down."""


class ConditionReachedException(RobolinkError):  # noqa: N818 - rclpy's name
    """What was waited for has come."""


class Executor:
    """The base of executors: what is ready, when timers are due, and waiting for both."""

    def __init__(self, *, context: Context | None = None) -> None:
        self._context = context if context is not None else get_default_context()
        self.inbox = Inbox()
        self.ready: deque[Entity] = deque()
        self._blocked: deque[Entity] = deque()
        self._polled: list[Entity] = []
        self._timers: list[tuple[int, int, int, Timer]] = []
        self._serial = itertools.count()
        self._nodes: list[Node] = []
        self._lock = self.inbox.lock
        self._is_shutdown = False
        self._spinners: list[int] = []
        self._context.on_shutdown(self.wake)

    @property
    def context(self) -> Context:
        """The context whose end ends the spinning."""
        return self._context

    @property
    def spinning(self) -> bool:
        """Whether any thread spins."""
        return bool(self._spinners)

    @property
    def spins_here(self) -> bool:
        """Whether the calling thread is the one, or one of those, that spin: it is inside a callback then."""
        return threading.get_ident() in self._spinners

    # What the executor has

    def add_node(self, node: Node) -> bool:
        """Run this node's callbacks, and take it from another executor; False when it is here already."""
        before = node.executor
        if before is not None and before is not self:
            before.remove_node(node)
        with self._lock:
            if node in self._nodes:
                return False
            self._nodes.append(node)
            node.belong_to(self)
            self._context.look_after(self.inbox)
            queued, node.queued = node.queued, []
            self.ready.extend(queued)
            for entity in node.entities():
                entity.attach(self, queued.count(entity))
        self.wake()
        return True

    def remove_node(self, node: Node) -> None:
        """Run its callbacks no more. What is ready keeps its turn until the node is added again."""
        with self._lock:
            if node not in self._nodes:
                return
            self._nodes.remove(node)
            entities = node.entities()
            for entity in entities:
                entity.detach()
            node.queued = self._withdraw(set(entities))
            node.belong_to(None)
        self.wake()

    def _withdraw(self, entities: set[Entity]) -> list[Entity]:
        self._unblock()
        withdrawn: list[Entity] = []
        for _ in range(len(self.ready)):  # in place, since other threads may append
            entity = self.ready.popleft()
            (withdrawn if entity in entities else self.ready).append(entity)
        return withdrawn

    def get_nodes(self) -> list[Node]:
        """All nodes that were added."""
        return list(self._nodes)

    def attach(self, entity: Entity) -> None:
        """Run this entity's callback from now on."""
        with self._lock:
            entity.attach(self)
        self.wake()

    def wake(self) -> None:
        """Let whoever waits look around."""
        self.inbox.wake()

    def post(self, entity: Entity) -> None:
        """Make an entity ready, from any thread."""
        self.ready.append(entity)
        self.wake()

    def poll(self, entity: Entity) -> None:
        """Make an entity ready again in a moment."""
        self._polled.append(entity)

    def create_task(self, callback: Any, *args: Any, **kwargs: Any) -> Task[Any]:
        """Run a function or coroutine in this executor; its result comes through the task."""
        task: Task[Any] = Task(callback, args, kwargs, executor=self)
        runner = TaskRunner(task)
        runner.executor = self
        self.post(runner)
        return task

    def create_future(self) -> Future[Any]:
        """Make a future whose done callbacks run in this executor."""
        return Future(executor=self)

    def shutdown(self, timeout_sec: float | None = None) -> bool:
        """Stop spinning and let go of all nodes; whether no callback runs any more."""
        if not self._is_shutdown:
            self._is_shutdown = True
            for node in self.get_nodes():
                self.remove_node(node)
            self.wake()
            self._context.let_go(self.inbox)
        return True

    # Timers

    def schedule(self, timer: Timer) -> None:
        """Have a timer made ready when it is due; one that follows /clock when /clock says so."""
        if timer.executor is not self or timer.is_canceled():
            return
        left = timer.clock.wait_ns(timer.next_call_ns)
        if left is not None:
            due = self._context.time.steady() + left
            with self._lock:
                heapq.heappush(self._timers, (due, next(self._serial), timer.version, timer))

    def on_clock(self, clock: ROSClock) -> None:
        """Look at the timers again that follow this clock, since it moved."""
        for node in self.get_nodes():
            for timer in node.timers:
                if timer.clock is clock:
                    timer.reschedule()
        self.wake()

    def _collect_due(self) -> int | None:
        """Make timers ready that are due; give when the next one is."""
        timers = self._timers
        with self._lock:
            while timers:
                due, _, version, timer = timers[0]
                if timer.version != version or timer.executor is not self:
                    heapq.heappop(timers)
                elif due <= self._context.time.steady():
                    heapq.heappop(timers)
                    self.ready.append(timer)
                else:
                    return due
        return None

    # Waiting, taking, running

    def _wait(self, deadline: int | None, stop: Callable[[], bool] | None = None) -> tuple[Entity, Any]:
        """Wait until something is ready and take it.

        Raises TimeoutException, ShutdownException, ExternalShutdownException or ConditionReachedException.
        """
        time = self._context.time
        while True:
            if not self.inbox.empty():
                self.inbox.sweep()
            next_timer = self._collect_due() if self._timers else None
            taken = self._take()
            if taken is not None:
                return taken
            self._check(stop)
            if deadline is not None and time.steady() >= deadline:
                if not self._polled:
                    raise TimeoutException
                self._ask_again()  # also whoever spins without waiting gets them done
                continue
            wake_at = _earlier(deadline, next_timer)
            if self._polled:
                wake_at = _earlier(wake_at, time.steady() + POLL_NS)
            arrival = time.wait(self.inbox, wake_at)
            if arrival is not None:
                taken = self._take_at_once(arrival)
                if taken is not None:
                    return taken
            self._ask_again()

    def _ask_again(self) -> None:
        self.ready.extend(self._polled)
        self._polled.clear()

    def _take_at_once(self, arrival: Any) -> tuple[Entity, Any] | None:
        """Take what arrived for an entity for which nothing waits; else deliver it, and it waits its turn."""
        target = arrival.target
        if target.straight:
            with self.inbox.lock:
                group = target.callback_group
                is_next = target.executor is self and not (self.ready or len(target.mailbox))
                if is_next and group.can_execute(target) and group.beginning_execution(target):
                    return target, arrival.content
        self.inbox.deliver(arrival)
        return None

    def _check(self, stop: Callable[[], bool] | None) -> None:
        if stop is not None and stop():
            raise ConditionReachedException
        self._check_interrupt()
        if self._is_shutdown:
            raise ShutdownException
        if not self._context.ok():
            raise ExternalShutdownException

    def _check_interrupt(self) -> None:
        if self._context.interrupted:
            raise InterruptedByUser

    def _take(self, wanted: Callable[[Entity], bool] | None = None) -> tuple[Entity, Any] | None:
        if not self.ready and not self._blocked:
            return None
        with self.inbox.lock:
            if self._blocked:
                self._unblock()
            while self.ready:
                entity = self.ready.popleft()
                group = entity.callback_group
                if (wanted is not None and not wanted(entity)) or not (
                    group.can_execute(entity) and group.beginning_execution(entity)
                ):
                    self._blocked.append(entity)
                    continue
                taken = entity.take()
                if taken is not NOTHING:
                    return entity, taken
                group.ending_execution(entity)
        return None

    def _unblock(self) -> None:
        self.ready.extendleft(reversed(self._blocked))
        self._blocked.clear()

    def _run(self, entity: Entity, taken: Any) -> None:
        """Run what was taken. Raises what the user's callback raises."""
        coroutine = None
        try:
            outcome = entity.execute(taken)
            if outcome is not None and inspect.iscoroutine(outcome):
                coroutine = outcome
        except ExternalShutdownException:  # Ctrl-C in a callback is no fault of it
            raise
        except Exception as error:
            self._log(entity, error)
            raise
        finally:
            if coroutine is None:
                entity.callback_group.ending_execution(entity)
        if coroutine is not None:
            self._run_on(entity, coroutine)

    def _log(self, entity: Entity, error: Exception) -> None:
        """Log a callback's exception, with its traceback, in the name of its node; once, however often it passes."""
        if getattr(error, "__robolink_logged__", False):
            return
        error.__robolink_logged__ = True  # type: ignore[attr-defined]
        owner = next((node for node in self.get_nodes() if entity in node.entities()), None)
        name = "robolink" if owner is None else owner.get_logger().name
        text = "".join(traceback.format_exception(type(error), error, _of_the_user(error.__traceback__)))
        get_logger(name).error(f"an exception in a callback ends the spinning:\n{text.rstrip()}")

    def _run_on(self, entity: Entity, coroutine: Any) -> None:
        """Run a callback that is a coroutine; its group is busy until it ends."""
        runner = TaskRunner(
            Task(coroutine, executor=self), on_end=lambda: entity.callback_group.ending_execution(entity)
        )
        runner.executor, runner.serves = self, entity.serves
        runner.execute(runner.task)

    # Spinning

    def spin(self) -> None:
        """Run callbacks until the context is shut down, or this executor. Raises InterruptedByUser after a signal."""
        if self._context.ok() and not self._is_shutdown:
            self._spin()
        self._check_interrupt()

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Run one callback; wait for it at most `timeout_sec` seconds, for ever when None or negative."""
        self._spin(self._deadline(timeout_sec), once=True)

    def spin_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run callbacks until the future is done, or `timeout_sec` seconds have passed."""
        future.when_done(self.wake)
        if not future.over() and self._context.ok() and not self._is_shutdown:
            self._spin(self._deadline(timeout_sec), future.over)
        if not future.over():
            self._check_interrupt()

    def spin_once_until_future_complete(self, future: Future[Any], timeout_sec: float | None = None) -> None:
        """Run one callback, or none when the future is done first."""
        future.when_done(self.wake)
        self._spin(self._deadline(timeout_sec), future.over, once=True)

    def _deadline(self, timeout_sec: float | None) -> int | None:
        if timeout_sec is None or timeout_sec < 0:
            return None
        return self._context.time.steady() + int(timeout_sec * 1e9)

    def _spin(self, deadline: int | None = None, stop: Callable[[], bool] | None = None, *, once: bool = False) -> None:
        """Run callbacks until `stop()`, the deadline, or the end of the context or of this executor."""
        time, thread = self._context.time, threading.get_ident()
        self._spinners.append(thread)
        try:
            while True:
                self._run(*self._wait(deadline, stop))
                if once or self._is_shutdown or not self._context.ok() or (stop is not None and stop()):
                    return
                if deadline is not None and time.steady() >= deadline:
                    return
        except (TimeoutException, ShutdownException, ConditionReachedException):
            pass
        finally:
            self._spinners.remove(thread)

    def serve_until(self, done: Callable[[], bool], deadline: int | None) -> None:
        """Inside a callback that waits for an answer: run only what serves, so that the answer can come.

        Services whose callback group is busy (the waiting callback's own, say) are left alone.
        """
        while not done():
            self.inbox.sweep()
            taken = self._take(lambda entity: entity.serves)
            if taken is not None:
                self._run(*taken)
            elif deadline is not None and self._context.time.steady() >= deadline:
                return
            elif not self._context.ok():
                self._check_interrupt()
                raise ExternalShutdownException
            elif not done():
                arrival = self._context.time.wait(self.inbox, deadline)
                if arrival is not None:
                    self.inbox.deliver(arrival)

    def __enter__(self: ExecutorT) -> ExecutorT:
        return self

    def __exit__(self, *_: object) -> None:
        self.shutdown()


class SingleThreadedExecutor(Executor):
    """Runs callbacks in the thread that spins."""


def _of_the_user(trace: TracebackType | None) -> TracebackType | None:
    """Leave out robolink's own frames at the top of a traceback."""
    first = trace
    while first is not None and first.tb_frame.f_globals.get("__name__", "").startswith("robolink."):
        first = first.tb_next
    return first or trace


def _earlier(one: int | None, other: int | None) -> int | None:
    """The earlier of two moments; None is never."""
    if one is None or other is None:
        return other if one is None else one
    return min(one, other)
