"""Wait of an executor for work, the threads that spin it, and the warning of a deadlock."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Sized
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Protocol

from robolink.running.entity import Entity
from robolink.running.execution import ConditionReachedException, TimeoutException, TimeoutObject, logger_of
from robolink.running.ready_queue import ReadyQueue, earlier
from robolink.system.waits import wait_for

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike, SpunNode

POLL_NS = 1_000_000
"""Polling period, in nanoseconds, of a coroutine that awaits something foreign, which wakes no executor."""

GATHER_NS = 500_000
"""Largest time, in nanoseconds, in which the messages of a flood gather; if too few come, it is over."""

Taken = tuple[Entity, Any]
"""An entity, and what it gave to be executed."""


class Ending(Protocol):
    """Executor as seen by its wait: it may end meanwhile."""

    _is_shutdown: bool
    """True once it has been shut down."""

    def check_end(self) -> None:
        """Raise if the executor or its context has ended."""


class Waiting:
    """Waits at a ready queue for an entity to take; an executor with threads puts its own ways of both in place."""

    def __init__(self, queue: ReadyQueue[Entity], context: ContextLike) -> None:
        self._queue, self._inbox = queue, queue.inbox
        self._context, self._time = context, context.time
        self.failures: Sized = ()
        """Exceptions that callbacks in other threads have raised, for `check_end` to raise."""
        self.take: Callable[..., Taken | None] = queue.take
        """Takes what is ready; None if there is nothing that may run now."""
        self.take_at_once: Callable[..., Taken | None] = queue.take_at_once
        """Takes what has just arrived, if nothing else waits; else None."""
        queue.is_gathered = True
        self.pause = context.time.wait
        """Waits for an arrival, until a moment of steady time at most."""

    def deadline(self, timeout_sec: float | TimeoutObject | None) -> int | None:
        """Return the end of a wait that begins now, in nanoseconds of steady time; None is never."""
        seconds = timeout_sec.timeout if isinstance(timeout_sec, TimeoutObject) else timeout_sec
        if seconds is None or seconds < 0:
            return None
        if seconds == 0:
            self._time.pass_on()
        return self._time.steady() + int(seconds * 1e9)

    def wait(
        self,
        executor: Ending,
        deadline: int | None,
        stop: Callable[[], bool] | None = None,
        accepts: Callable[[Entity], bool] | None = None,
    ) -> Taken:
        """Wait until something is ready and take it.

        Raises TimeoutException at the deadline, ConditionReachedException once `stop()`, and what `check_end` raises.
        """
        queue, inbox = self._queue, self._inbox
        while True:
            if not inbox.empty():
                inbox.sweep()
            if queue.pollables:
                queue.poll()
            next_timer = queue.collect_due() if queue.timers else None
            if queue.ready or queue.turns or queue.blocked:
                taken = self.take(accepts)
                if taken is not None:
                    return taken
            if stop is not None or self.failures or executor._is_shutdown or not self._context._ok:  # else a call less
                _check(executor, stop)
            usual = deadline is None and not queue.postponed and not queue.flooded  # then a call less
            arrival = self.pause(inbox, next_timer) if usual else self._wait_for_arrival(deadline, next_timer)
            if arrival is not None:
                taken = self.take_at_once(arrival, accepts)
                if taken is not None:
                    return taken
            if queue.postponed:
                queue.make_postponed_ready()

    def _wait_for_arrival(self, deadline: int | None, next_timer: int | None) -> Any:
        """Wait, unless there is a reason not to, until something arrives, a timer is due or there is news."""
        queue = self._queue
        if queue.flooded and queue.gather():
            return None
        if deadline is not None and self._time.steady() >= deadline:
            if not queue.postponed:
                raise TimeoutException
            return None  # also whoever spins without waiting gets them done
        wake_at = earlier(deadline, next_timer)
        if queue.postponed:
            wake_at = earlier(wake_at, self._time.steady() + POLL_NS)
        if not queue.flooded:
            return self.pause(self._inbox, wake_at)
        arrival = self.pause(self._inbox, earlier(wake_at, self._time.steady() + GATHER_NS))
        if arrival is None:
            queue.calm()
        return arrival


def _check(executor: Ending, stop: Callable[[], bool] | None) -> None:
    if stop is not None and stop():
        raise ConditionReachedException
    executor.check_end()


class Spinners:
    """Idents of the threads that spin; one that spins within its own callback is in it twice."""

    def __init__(self, lock: threading.RLock) -> None:
        self.threads: list[int] = []
        self._left = threading.Condition(lock)

    def tell(self) -> None:
        """Wake whoever waits in `wait_for_others`."""
        with self._left:
            self._left.notify_all()

    def wait_for_others(self, timeout_sec: float | None) -> bool:
        """Wait until no other thread spins; False if some still do after `timeout_sec` seconds."""
        return wait_for(self._left, lambda: {*self.threads} <= {threading.get_ident()}, limit(timeout_sec))

    @contextmanager
    def counting_this(self, inside: bool) -> Iterator[None]:
        """Count the calling thread as one that spins, if it is inside a callback of another executor."""
        thread = threading.get_ident()
        if inside:
            self.threads.append(thread)
        try:
            yield
        finally:
            if inside:
                self.threads.remove(thread)


def limit(timeout_sec: float | None) -> float | None:
    """Return the limit of a wait as rclpy spells it: a negative one is none."""
    return None if timeout_sec is None or timeout_sec < 0 else timeout_sec


_HELD = (
    "a callback spins and waits without a timeout_sec: {} is ready, but cannot run before that callback has returned, "
    "since their callback group runs one at a time. Return instead of spinning, give the spin a timeout_sec, or give "
    "one of the two a callback group of its own"
)


class DeadlockWarning:
    """Logs once what is ready in a queue and held back by the callback that spins in the calling thread."""

    def __init__(self, queue: ReadyQueue[Entity], nodes: Iterable[SpunNode]) -> None:
        self._queue, self._nodes = queue, nodes
        self._has_warned = False

    def watching(self, stop: Callable[[], bool] | None, is_held_here: Callable[[Entity], bool]) -> Callable[[], bool]:
        """Return `stop`, or never, for a callback that spins without an end: it warns as well.

        Who spins until a future is done is told only of a service that is asked from here: that future may hang on it.
        """

        def look() -> bool:
            with self._queue.lock:
                held_back = () if self._has_warned else (*self._queue.blocked, *self._queue.ready)
                waiting = [each for each in held_back if is_held_here(each)]
            held = next((each for each in waiting if stop is None or self._is_called_here(each.origin)), None)
            if held is not None:
                self._has_warned = True
                logger_of(held).warning(_HELD.format(_named(held.origin)))
            return False

        return look if stop is None else lambda: stop() or look()

    def _is_called_here(self, entity: Entity) -> bool:
        """Return whether it is a service whose answer a client of one of the nodes waits for."""
        name = getattr(entity, "service_name", None)
        return any(each.service_name == name and each.is_waiting for node in self._nodes for each in node.clients)


def _named(entity: Entity) -> str:
    kind = type(entity).__name__.lower()
    name = getattr(entity, "topic_name", None) or getattr(entity, "service_name", None)
    return f"the {kind} of {name}" if name else f"a {kind}"
