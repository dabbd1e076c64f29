"""Ready queue of an executor: the entities that are ready, in order, and the timers by their deadlines.

An executor has one, takes from it and runs what it took; entities put themselves in, from any thread.
"""

from __future__ import annotations

import heapq
import itertools
from collections import deque
from collections.abc import Callable, Collection
from typing import Any, Generic, Protocol, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.running.inbox import Inbox

NOTHING: Any = object()
"""Result of `take` when there is nothing to do after all."""


class Runnable(Protocol):
    """Entity as seen by the queue that it waits in."""

    @property
    def gate(self) -> CallbackGroup:
        """The group that decides when it may run."""

    def take(self) -> Any:
        """Return what is to be executed, or NOTHING; called under the inbox's lock."""


class Pollable(Runnable, Protocol):
    """Entity that is polled, since it does not announce when it becomes ready."""

    waits: bool
    """True while it is among what is ready."""

    def is_ready(self) -> bool:
        """True if there is something to execute."""


class Scheduled(Runnable, Protocol):
    """Timer as seen by the queue that makes it ready when it is due."""

    version: int
    """Changes whenever an older deadline no longer holds."""

    _queue_: Any
    """The queue that it belongs to now."""


class Timekeeper(Protocol):
    """Keeper of the deadlines of all programs of a host."""

    def schedule(self, timer: Any, left: int) -> None:
        """Make a timer ready in `left` nanoseconds of steady time."""

    def postpone(self, entity: Any) -> None:
        """Make an entity ready again in a moment."""


EntityT = TypeVar("EntityT", bound=Runnable)


class ReadyQueue(Generic[EntityT]):
    """Ready entities in the order in which they became so, those their group holds back, and timers by deadline."""

    def __init__(self, inbox: Inbox, steady: Callable[[], int]) -> None:
        self.inbox = inbox
        """Where arrivals wait until they are delivered; whoever waits for work waits here."""
        self.lock = inbox.lock
        self.ready: deque[EntityT] = deque()
        """Entities that are ready; any thread may append."""
        self.blocked: deque[EntityT] = deque()
        """Entities that were ready, before all those in `ready`, when their callback group kept them back."""
        self.postponed: deque[EntityT] = deque()
        """Entities to be made ready again in a moment."""
        self.pollables: list[Any] = []
        """The polled entities: each is asked before each look at what is ready."""
        self.timers: list[tuple[int, int, int, Scheduled]] = []
        """Heap of deadlines in steady nanoseconds, each with a serial number and the timer's version."""
        self.timekeeper: Timekeeper | None = None
        """Keeps the deadlines instead of this queue, in a host."""
        self._serial = itertools.count()
        self._steady = steady

    # Putting in

    def wake(self) -> None:
        """Let the thread that waits for work look again."""
        self.inbox.wake()

    def post(self, entity: EntityT) -> None:
        """Make an entity ready, from any thread."""
        self.ready.append(entity)
        self.inbox.wake()

    def postpone(self, entity: EntityT) -> None:
        """Make an entity ready again in a moment."""
        if self.timekeeper is not None:
            self.timekeeper.postpone(entity)
            return
        self.postponed.append(entity)
        self.inbox.wake()

    def schedule(self, timer: Scheduled, left: int) -> None:
        """Make a timer ready in `left` nanoseconds of steady time."""
        if self.timekeeper is not None:
            self.timekeeper.schedule(timer, left)
            return
        due = self._steady() + left
        with self.lock:
            heapq.heappush(self.timers, (due, next(self._serial), timer.version, timer))

    def add_pollable(self, entity: Pollable) -> None:
        """Ask this entity from now on."""
        self.pollables = [*self.pollables, entity]

    def remove_pollable(self, entity: Pollable) -> None:
        """Ask it no more."""
        self.pollables = [each for each in self.pollables if each is not entity]

    def withdraw(self, entities: Collection[EntityT]) -> list[EntityT]:
        """Take out these entities, however often each is in, and return them in order."""
        self.unblock()
        withdrawn: list[EntityT] = []
        for _ in range(len(self.ready)):  # in place, since other threads may append
            entity = self.ready.popleft()
            (withdrawn if entity in entities else self.ready).append(entity)
        return withdrawn

    # What becomes ready

    def make_postponed_ready(self) -> None:
        """Move what `postpone` was called with to what is ready."""
        for _ in range(len(self.postponed)):  # one by one, since other threads may append
            self.ready.append(self.postponed.popleft())

    def poll(self) -> None:
        """Ask each of the polled entities; make it ready if it says so and its group lets it run."""
        for each in self.pollables:
            if not each.waits and each.gate.can_execute(each) and each.is_ready():
                each.waits = True
                self.ready.append(each)

    def collect_due(self) -> int | None:
        """Make timers ready that are due; return the deadline of the next one, in steady nanoseconds."""
        timers, steady = self.timers, self._steady
        with self.lock:
            while timers:
                due, _, version, timer = timers[0]
                if timer.version != version or timer._queue_ is not self:
                    heapq.heappop(timers)
                elif due <= steady():
                    heapq.heappop(timers)
                    self.ready.append(timer)
                else:
                    return due
        return None

    # Taking

    def take(self, wanted: Callable[[EntityT], bool] | None = None) -> tuple[EntityT, Any] | None:
        """Take the first entity that is ready and whose group lets it run, with what it is to execute."""
        with self.lock:
            if self.blocked:
                self.unblock()
            while self.ready:
                entity = self.ready.popleft()
                group = entity.gate
                if (wanted is not None and not wanted(entity)) or not (
                    group._acquire_(False) if group._acquire_ else reserve(group, entity)
                ):
                    self.blocked.append(entity)
                    continue
                taken = entity.take()
                if taken is not NOTHING:
                    return entity, taken
                group.ending_execution(entity)
        return None

    def take_at_once(self, arrival: Any, wanted: Callable[[EntityT], bool] | None = None) -> tuple[EntityT, Any] | None:
        """Take what arrived for an entity for which nothing waits; else deliver it, and it waits its turn."""
        target = arrival.target
        if target.straight and wanted is None:
            with self.lock:
                if target._queue_ is self and not self.ready and not target.mailbox.waiting:
                    group = target.gate
                    if group._acquire_(False) if group._acquire_ else reserve(group, target):
                        return target, arrival.content
        self.inbox.deliver(arrival)
        return None

    def has_blocked(self) -> bool:
        """True if something ready waits for its callback group."""
        with self.lock:
            return bool(self.blocked)

    def unblock(self) -> None:
        """Put what was blocked back to the front."""
        self.ready.extendleft(reversed(self.blocked))
        self.blocked.clear()


def reserve(group: CallbackGroup, entity: Any) -> bool:
    """Reserve a group for an entity; False if it must wait."""
    return group.can_execute(entity) and group.beginning_execution(entity)


def earlier(one: int | None, other: int | None) -> int | None:
    """Return the earlier of two moments; None is never."""
    if one is None or other is None:
        return other if one is None else one
    return min(one, other)
