"""Thread pool of a MultiThreadedExecutor: it runs callbacks, and detects deadlocks of those that wait for each other.

An entity is taken only when there is a thread for it, so that what waits does so in the mailboxes, in order. A callback
that waits for an answer keeps its thread; when no other is free, that thread is brought what serves.
"""

from __future__ import annotations

import os
import queue
import threading
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from itertools import chain
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.running.entity import Entity
from robolink.running.inbox import Inbox
from robolink.system.clocks import steady
from robolink.system.waits import A_WHILE
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.running.ports import ThreadedLoop

A_MOMENT = 0.001
"""Real time, in seconds, that each step of virtual time takes while a callback waits for something unknown."""

_STUCK_AFTER = 2
"""Number of waits of `A_WHILE` in which a callback may work; then it is taken for one that waits."""


class WaitingCallback:
    """Callback that waits for a future, and is given services and clients to run meanwhile."""

    def __init__(self, future: Future[Any], deadline: int | None, serves: bool) -> None:
        self.future, self.deadline, self.serves = future, deadline, serves
        self.jobs: queue.SimpleQueue[tuple[Entity, Any] | None] = queue.SimpleQueue()
        self.idle = True

    def is_late(self, now: int) -> bool:
        """Return whether steady time `now` is past its deadline."""
        return self.deadline is not None and now >= self.deadline


class CallbackThreads:
    """Thread pool that runs the callbacks of one executor."""

    def __init__(self, size: int, executor: ThreadedLoop) -> None:
        self.pool = executor.context.make_pool(size)
        self.free = size
        """Number of callbacks that can still be begun; below zero while some queue up."""
        self.failures: deque[BaseException] = deque()
        """Exceptions that callbacks raised, for the thread that spins to raise."""
        self._size, self._executor = size, executor
        self._queue = executor._queue_
        self._lock = self._queue.lock
        self._time = executor.context.time
        self.ended = threading.Condition(self._lock)
        """Notified whenever a callback has ended."""
        self._running: dict[int, list[Entity]] = {}
        self._needs: dict[int, list[list[CallbackGroup]]] = {}
        """Callback groups that the calls of each thread wait for, one call within the other."""
        self._waiting: list[WaitingCallback] = []
        self._working = 0  # callbacks that run and do not wait
        self._stuck = 0  # those among them that seem to wait for something else

    # Taking

    def take(self, accepts: Callable[[Entity], bool] | None = None) -> tuple[Entity, Any] | None:
        """Take from the ready queue what there is a thread for. Raises what a callback has raised meanwhile."""
        if self.failures:
            raise self.failures.popleft()  # before more is begun
        if self.free > 0:
            return self._queue.take(accepts)
        serves = self.can_serve()

        def may(entity: Entity) -> bool:
            return (entity.quick or (serves and entity.serves)) and (accepts is None or accepts(entity))

        return self._queue.take(may)

    def take_at_once(self, arrival: Any, accepts: Callable[[Entity], bool] | None = None) -> tuple[Entity, Any] | None:
        """Take what arrived if a thread is free; else deliver it."""
        if self.free > 0:
            return self._queue.take_at_once(arrival, accepts)
        self._queue.inbox.deliver(arrival)
        return None

    # Running

    def submit(self, entity: Entity, taken: Any) -> None:
        """Hand it to a thread: a free one, or one that waits. Raises RuntimeError after `close`."""
        with self._lock:
            self._working += 1
            callback = next((callback for callback in self._waiting if callback.idle and callback.serves), None)
            if self.free <= 0 and callback is not None:
                callback.idle = False
                callback.jobs.put((entity, taken))
                return
            self.free -= 1
        try:
            self.pool.submit(self._run_in_pool, entity, taken)
        except RuntimeError:
            self._end(1)
            raise

    def _run_in_pool(self, entity: Entity, taken: Any) -> None:
        self._run(entity, taken)
        self._end(1)

    def _run(self, entity: Entity, taken: Any) -> None:
        running = self._running.setdefault(threading.get_ident(), [])
        running.append(entity)
        try:
            self._executor.run(entity, taken)
        except BaseException as error:  # noqa: BLE001 - whoever spins raises it
            self.failures.append(error)
        finally:
            running.pop()
            if not running:
                del self._running[threading.get_ident()]

    def _end(self, freed: int) -> None:
        """Count one callback less; wake whoever spins if there is more to do now."""
        with self._lock:
            were_all_busy = self.free <= 0
            self.free += freed
            self._working -= 1
            self._stuck = min(self._stuck, self._working)
            self.ended.notify_all()
        queue = self._queue
        if were_all_busy or self.failures or queue.pollables or self._time.ends_are_news() or queue.has_blocked():
            queue.wake()

    def runs_here(self) -> bool:
        """Return whether the calling thread is in a callback of this executor."""
        return threading.get_ident() in self._running

    def holds(self, group: CallbackGroup) -> bool:
        """Return whether a callback in the calling thread keeps a group busy."""
        return threading.get_ident() in self._holding(group)

    def is_last_awake(self) -> bool:
        """Return whether all threads but one wait for something that they do not run themselves."""
        with self._lock:
            return sum(not callback.serves for callback in self._waiting) >= self._size - 1

    def can_serve(self) -> bool:
        """Return whether a callback waits and may run services meanwhile."""
        return any(callback.idle and callback.serves for callback in self._waiting)

    def settle(self, task: Future[Any]) -> None:
        """Wait until the thread in which a task has just ended has noted what it raised."""

        def is_noted() -> bool:
            return not any(getattr(each, "task", None) is task for each in chain(*list(self._running.values())))

        with self.ended:
            self.ended.wait_for(is_noted, A_WHILE)

    # Waiting within a callback

    def wait(self, future: Future[Any], deadline: int | None, serving: bool) -> None:
        """In a callback: wait until the future is over or steady time is `deadline`; if serving, run what serves."""
        callback = WaitingCallback(future, deadline, serving)
        with self._lock:
            self._waiting.append(callback)
            self._working -= 1
        future.when_done(lambda: self._wake_up(callback))
        self._queue.wake()
        try:
            while not future.over() and not callback.is_late(self._time.steady()):
                self._wait_for_job(callback)
        finally:
            self._leave(callback)

    def _wake_up(self, callback: WaitingCallback) -> None:
        """Let a callback look whether it may go on; from now on it counts as working."""
        with self._lock:
            if callback.idle:
                callback.idle = False
                self._working += 1
        callback.jobs.put(None)

    def _wait_for_job(self, callback: WaitingCallback) -> None:
        try:
            job = self._time.take_soon(callback.jobs, callback.deadline)
        except queue.Empty:
            job = None
        if job is not None:
            self._work_in(callback, job)
        self._executor.check_end()

    def _work_in(self, callback: WaitingCallback, job: tuple[Entity, Any]) -> None:
        self._run(*job)
        with self._lock:
            callback.idle = callback in self._waiting and not callback.future.over()
            self._working += not callback.idle  # the callback goes on now
        self._end(0)

    def _leave(self, callback: WaitingCallback) -> None:
        with self._lock:
            self._waiting.remove(callback)
            self._working += callback.idle
            callback.idle = False
        while not callback.jobs.empty():
            job = callback.jobs.get()
            if job is not None:  # brought just when the wait was over
                self._work_in(callback, job)

    @contextmanager
    def waiting_for(self, groups: Iterable[CallbackGroup]) -> Iterator[bool]:
        """In a callback that is about to wait for one of these groups: whether all of them wait for it in the end."""
        thread, needs = threading.get_ident(), list(groups)
        with self._lock:  # of two that come to wait for each other, the second finds it out
            hopeless = bool(needs) and self._are_hopeless(needs, frozenset([thread]))
            waits = self._needs.setdefault(thread, [])
            waits.append(needs)
        try:
            yield hopeless
        finally:
            with self._lock:
                waits.pop()
                if not waits:
                    del self._needs[thread]

    def _are_hopeless(self, groups: list[CallbackGroup], waiting: frozenset[int]) -> bool:
        return all(any(self._waits_for(thread, waiting) for thread in self._holding(group)) for group in groups)

    def _holding(self, group: CallbackGroup) -> list[int]:
        def holds(entities: list[Entity]) -> bool:
            return any(each.origin.gate is group for each in list(entities))

        return [thread for thread, entities in list(self._running.items()) if holds(entities)]

    def _waits_for(self, thread: int, waiting: frozenset[int]) -> bool:
        if thread in waiting:
            return True
        needs = self._needs.get(thread, [[]])[-1]
        return bool(needs) and self._are_hopeless(needs, waiting | {thread})

    # Time

    def pause(self, inbox: Inbox, until: int | None) -> Any:
        """Wait as the time base does. Virtual time stands still while a callback works.

        For half a second of real time, that is: a callback that takes longer seems to wait for another one, and time
        goes on, slowly enough for it to see what it waits for.
        """
        if not self._time.stands_still_for_threads():
            return self._time.wait(inbox, until)
        if self._working > self._stuck:
            return self._let_work(inbox)
        if self._stuck:
            begin = steady()
            arrival = inbox.wait(A_MOMENT)
            if arrival is not None or steady() - begin < A_MOMENT * 1e9:
                return arrival
        with self._lock:
            moments = [each.deadline for each in self._waiting if each.idle and each.deadline is not None]
        moments += [] if until is None else [until]
        arrival = self._time.wait(inbox, min(moments, default=None))
        for callback in list(self._waiting):
            if callback.is_late(self._time.steady()):
                self._wake_up(callback)
        return arrival

    def _let_work(self, inbox: Inbox) -> Any:
        for _ in range(_STUCK_AFTER):
            begin = steady()
            arrival = inbox.wait(None)
            if arrival is not None or steady() - begin < A_WHILE * 1e9:
                return arrival
        with self._lock:
            self._stuck = self._working
        return None

    # The end

    def have_ended(self) -> bool:
        """Return whether no callback runs, but for the one that asks this."""
        return self.free + self.runs_here() == self._size

    def close(self, *, wait: bool) -> None:
        """Begin no more callbacks, and wait for the threads to end; a thread does not wait for itself."""
        for callback in list(self._waiting):
            callback.jobs.put(None)
        self.pool.shutdown(wait=wait and not self.runs_here())


def count_cores() -> int:
    """Return the number of cores that this process may use; 2 if the system does not tell."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 2
