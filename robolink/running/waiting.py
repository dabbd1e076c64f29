"""Wait of an executor for work: it blocks until an entity can be taken from the ready queue, or it is to end."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from robolink.running.entity import Entity
from robolink.running.execution import ConditionReachedException, TimeoutException, TimeoutObject
from robolink.running.ready_queue import ReadyQueue, earlier
from robolink.running.timebase import TimeBase

POLL_NS = 1_000_000
"""Polling period, in nanoseconds, of a coroutine that awaits something foreign, which wakes no executor."""

Taken = tuple[Entity, Any]
"""An entity, and what it gave to be executed."""


class Ending(Protocol):
    """Executor as seen by its wait: it may end meanwhile."""

    def check_end(self) -> None:
        """Raise if the executor or its context has ended."""


class Waiting:
    """Waits at a ready queue, and takes from it; an executor with threads puts its own ways of both in place."""

    def __init__(self, queue: ReadyQueue[Entity], time: TimeBase) -> None:
        self._queue, self._inbox, self._time = queue, queue.inbox, time
        self.take: Callable[..., Taken | None] = queue.take
        """Takes what is ready; None if there is nothing that may run now."""
        self.take_at_once: Callable[..., Taken | None] = queue.take_at_once
        """Takes what has just arrived, if nothing else waits; else None."""
        self.pause = time.wait
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
        wanted: Callable[[Entity], bool] | None = None,
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
                taken = self.take(wanted)
                if taken is not None:
                    return taken
            if stop is not None and stop():
                raise ConditionReachedException
            executor.check_end()
            usual = deadline is None and not queue.postponed  # then a call less
            arrival = self.pause(inbox, next_timer) if usual else self._wait_for_arrival(deadline, next_timer)
            if arrival is not None:
                taken = self.take_at_once(arrival, wanted)
                if taken is not None:
                    return taken
            if queue.postponed:
                queue.make_postponed_ready()

    def _wait_for_arrival(self, deadline: int | None, next_timer: int | None) -> Any:
        """Wait, unless there is a reason not to, until something arrives, a timer is due or there is news."""
        postponed = self._queue.postponed
        if deadline is not None and self._time.steady() >= deadline:
            if not postponed:
                raise TimeoutException
            return None  # also whoever spins without waiting gets them done
        wake_at = earlier(deadline, next_timer)
        return self.pause(self._inbox, earlier(wake_at, self._time.steady() + POLL_NS) if postponed else wake_at)
