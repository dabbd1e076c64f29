"""The threads of a MultiThreadedExecutor: who runs what, who waits within a callback, and what callbacks raised.

An entity is taken only when there is a thread for it, so that what waits does so in the mailboxes, in order. A callback
that waits for an answer keeps its thread; when no other is free, that thread is brought what serves.
"""

from __future__ import annotations

import os
import queue
import threading
import time
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.entity import Entity
from robolink.executor_queue import earlier
from robolink.inbox import Inbox
from robolink.queues import A_WHILE, get_within
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.executors import Executor

A_MOMENT = 0.001
"""Seconds of real time that each step of virtual time takes while a callback waits for something unknown."""


class Desk:
    """Where a callback waits for a future, and is brought what serves meanwhile."""

    def __init__(self, future: Future[Any], deadline: int | None, serves: bool) -> None:
        self.future, self.deadline, self.serves = future, deadline, serves
        self.jobs: queue.SimpleQueue[tuple[Entity, Any] | None] = queue.SimpleQueue()
        self.idle = True

    def is_late(self, now: int) -> bool:
        """Whether its patience is at an end."""
        return self.deadline is not None and now >= self.deadline


class CallbackThreads:
    """A pool of threads that run callbacks of one executor."""

    def __init__(self, size: int, executor: Executor) -> None:
        self.pool = executor.context.make_pool(size)
        self.free = size
        """How many more callbacks can be begun; below zero while some queue up."""
        self.failures: deque[BaseException] = deque()
        """What callbacks raised and nobody has been told yet."""
        self._size, self._executor = size, executor
        self._lock = executor.inbox.lock
        self._time = executor.context.time
        self.ended = threading.Condition(self._lock)
        """Notified whenever a callback has ended."""
        self._running: dict[int, list[Entity]] = {}
        self._needs: dict[int, list[list[CallbackGroup]]] = {}
        """What each thread's calls, one within the other, wait for."""
        self._desks: list[Desk] = []
        self._working = 0  # callbacks that run and do not wait at a desk
        self._stuck = 0  # those among them that seem to wait for something else

    # Running

    def submit(self, entity: Entity, taken: Any) -> None:
        """Have a thread run it: a free one, or one that waits. Raises RuntimeError after `close`."""
        with self._lock:
            self._working += 1
            desk = next((desk for desk in self._desks if desk.idle and desk.serves), None)
            if self.free <= 0 and desk is not None:
                desk.idle = False
                desk.jobs.put((entity, taken))
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
        executor = self._executor
        if were_all_busy or self.failures or executor.asked or self._time.virtual or executor.has_blocked():
            executor.wake()

    def runs_here(self) -> bool:
        """Whether the calling thread is in a callback of this executor."""
        return threading.get_ident() in self._running

    def holds(self, group: CallbackGroup) -> bool:
        """Return whether a callback in the calling thread keeps a group busy."""
        return threading.get_ident() in self._holding(group)

    def can_serve(self) -> bool:
        """Whether somebody waits and may serve meanwhile."""
        return any(desk.idle and desk.serves for desk in self._desks)

    # Waiting within a callback

    def wait(self, future: Future[Any], deadline: int | None, serving: bool) -> None:
        """In a callback: wait until the future is over or steady time is `deadline`; if serving, run what serves."""
        desk = Desk(future, deadline, serving)
        with self._lock:
            self._desks.append(desk)
            self._working -= 1
        future.when_done(lambda: self._call_back(desk))
        self._executor.wake()
        try:
            while not future.over() and not desk.is_late(self._time.steady()):
                self._wait_for_job(desk)
        finally:
            self._leave(desk)

    def _call_back(self, desk: Desk) -> None:
        """Let the callback at a desk look whether it may go on; from now on it counts as working."""
        with self._lock:
            if desk.idle:
                desk.idle = False
                self._working += 1
        desk.jobs.put(None)

    def _wait_for_job(self, desk: Desk) -> None:
        try:
            job = self._next_job(desk)
        except queue.Empty:
            job = None
        if job is not None:
            self._work_at(desk, job)
        self._executor.check_end()

    def _next_job(self, desk: Desk) -> tuple[Entity, Any] | None:
        steady = self._time.steady()
        if self._time.hosted:
            soon = steady + int(A_WHILE * 1e9)
            job: tuple[Entity, Any] | None = self._time.take(desk.jobs, earlier(desk.deadline, soon))
            return job
        left = A_WHILE
        if desk.deadline is not None and not self._time.virtual:
            left = min(A_WHILE, max(0.0, (desk.deadline - steady) / 1e9))
        return get_within(desk.jobs, left)

    def _work_at(self, desk: Desk, job: tuple[Entity, Any]) -> None:
        self._run(*job)
        with self._lock:
            desk.idle = desk in self._desks and not desk.future.over()
            self._working += not desk.idle  # the callback goes on now
        self._end(0)

    def _leave(self, desk: Desk) -> None:
        with self._lock:
            self._desks.remove(desk)
            self._working += desk.idle
            desk.idle = False
        while not desk.jobs.empty():
            job = desk.jobs.get()
            if job is not None:  # brought just when the wait was over
                self._work_at(desk, job)

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
        if self._time.hosted or not self._time.virtual:
            return self._time.wait(inbox, until)
        if self._working > self._stuck:
            return self._let_work(inbox)
        if self._stuck:
            begin = time.monotonic()
            arrival = inbox.wait(A_MOMENT)
            if arrival is not None or time.monotonic() - begin < A_MOMENT:
                return arrival
        with self._lock:
            moments = [desk.deadline for desk in self._desks if desk.idle and desk.deadline is not None]
        moments += [] if until is None else [until]
        arrival = self._time.wait(inbox, min(moments, default=None))
        for desk in list(self._desks):
            if desk.is_late(self._time.steady()):
                self._call_back(desk)
        return arrival

    def _let_work(self, inbox: Inbox) -> Any:
        begin = time.monotonic()
        arrival = inbox.wait(None)
        if arrival is None and time.monotonic() - begin >= A_WHILE:
            with self._lock:
                self._stuck = self._working
        return arrival

    # The end

    def have_ended(self) -> bool:
        """Whether no callback runs, but for one that asks this."""
        return self.free + self.runs_here() == self._size

    def close(self, *, wait: bool) -> None:
        """Begin no more callbacks, and wait for the threads to end; a thread does not wait for itself."""
        for desk in list(self._desks):
            desk.jobs.put(None)
        self.pool.shutdown(wait=wait and not self.runs_here())


def count_cores() -> int:
    """How many cores this process may use; 2 when the system does not tell."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 2
