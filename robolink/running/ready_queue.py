"""Ready queue of an executor: the entities that are ready, which have their turns in rounds, and timers by deadline.

An executor has one, takes from it and runs what it took; entities put themselves in, from any thread. As in rclpy, a
round gives each entity that is ready at its beginning one turn, in the order of their places: waitables, then of one
node after the other timers, subscriptions, guard conditions, clients and services. Tasks are run between two rounds. So
what waits behind one slow callback keeps nobody else waiting for longer than a round. Who is kept back by its callback
group keeps its turn, before all who become ready later: in rclpy the first of a group may keep the others from theirs.
"""

from __future__ import annotations

import heapq
import itertools
import operator
from collections import deque
from collections.abc import Callable, Collection
from typing import Any, Generic, Protocol, TypeAlias, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.running.inbox import Inbox

NOTHING: Any = object()
"""Result of `take` when there is nothing to do after all."""


HELD: Any = object()
"""Result of an entity's `turn` when its callback group holds it back."""


Place: TypeAlias = tuple[int, int, int, int]
"""Place of an entity in a round: TASK, WAITABLE or OTHER, its node's number, the rank of its kind, its own number."""

TASK, WAITABLE, OTHER = range(3)

_place = operator.attrgetter("place")


class Runnable(Protocol):
    """Entity as seen by the queue that it waits in."""

    @property
    def gate(self) -> CallbackGroup:
        """The group that decides when it may run."""

    @property
    def place(self) -> Place:
        """Its place in each round."""

    @property
    def lane(self) -> int:
        """Number of the waitable whose parts have one turn together in each round; 0 for an entity on its own."""

    def take(self) -> Any:
        """Return the value to execute with, or NOTHING; called under the inbox's lock."""


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


class Flooded(Protocol):
    """Mailbox in a flood as seen by the queue that looks for what no notice told of."""

    waiting: deque[Any]

    def deliver(self) -> None:
        """Make its receiver ready."""

    def calm(self) -> bool:
        """Put a notice for each message again if few have come; True if so."""


class Timekeeper(Protocol):
    """Keeper of the deadlines of all programs of a host."""

    def schedule(self, timer: Any, left: int) -> None:
        """Make a timer ready in `left` nanoseconds of steady time."""

    def postpone(self, entity: Any) -> None:
        """Make an entity ready again in a moment."""


EntityT = TypeVar("EntityT", bound=Runnable)


class ReadyQueue(Generic[EntityT]):
    """Ready entities, which have their turns in rounds, those their group holds back, and timers by deadline."""

    in_rounds = True
    """True if an entity has one turn in each round, however much waits for it; False if all that waits has its own."""

    def __init__(self, inbox: Inbox, steady: Callable[[], int]) -> None:
        self.inbox = inbox
        """Where arrivals wait until they are delivered; whoever waits for work waits here."""
        self.lock = inbox.lock
        self.turns: deque[EntityT] = deque()
        """Entities whose turn is still to come in this round, in order."""
        self.ready: deque[EntityT] = deque()
        """Entities and tasks that have become ready since the round began; any thread may append."""
        self.blocked: deque[EntityT] = deque()
        """Entities whose turn came while their callback group was busy: they go first when something is taken next."""
        self._unsorted = 0
        """Index in `blocked` of the first entity of the rounds in which nothing could be taken: they count as one."""
        self._took = False
        """True if something was taken in this round."""
        self._ran_tasks = False
        """True if tasks were the last to have turns."""
        self.postponed: deque[EntityT] = deque()
        """Tasks to be run again in a moment."""
        self.is_gathered = False
        """True if whoever waits here calls `gather` and `calm`: only then may a mailbox be in a flood."""
        self.flooded: list[Flooded] = []
        """Mailboxes that a flood fills: they do not tell of each message."""
        self.pollables: list[Any] = []
        """The polled entities: each is asked before each look at what is ready."""
        self.timers: list[tuple[int, int, int, Scheduled]] = []
        """Heap of deadlines in steady nanoseconds, each with a serial number and the timer's version."""
        self.schedule: Callable[[Any, int], None] = self._schedule
        """Makes a timer ready in so many nanoseconds of steady time; in a host one for all programs."""
        self.postpone: Callable[[Any], None] = self._postpone
        """Runs the next part of a task in a moment; in a host one for all programs."""
        self.in_rounds = self.in_rounds  # in the instance, where Python 3.11 finds it in a tenth of the time
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

    def keep_time_by(self, timekeeper: Timekeeper) -> None:
        """Let another keep the deadlines."""
        self.schedule, self.postpone = timekeeper.schedule, timekeeper.postpone

    def _postpone(self, task: EntityT) -> None:
        self.postponed.append(task)
        self.inbox.wake()

    def _schedule(self, timer: Scheduled, left: int) -> None:
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
        """Take out these entities, and return those whose turn was still to come in this round, in order."""
        self.unblock()
        withdrawn: list[EntityT] = []
        for waiting, removed in ((self.turns, withdrawn), (self.ready, list[EntityT]())):
            for _ in range(len(waiting)):  # in place, since other threads may append
                entity = waiting.popleft()
                (removed if entity in entities else waiting).append(entity)
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

    # Rounds

    def begin(self, accepts: Callable[[EntityT], bool] | None = None) -> bool:
        """Begin with the tasks or, when they have had their turns, begin a round. False if there is nothing to do."""
        if self._took:
            self._unsorted, self._took = len(self.blocked), False
        ready = self.ready
        batch = [ready.popleft() for _ in range(len(ready))]  # one by one, since other threads may append
        batch.sort(key=_place)
        if batch and batch[0].place[0] < OTHER:
            batch = self._apart(batch, accepts)
        else:
            self._ran_tasks = False
        self.turns.extend(batch)
        return bool(batch)

    def _apart(self, batch: list[EntityT], accepts: Callable[[EntityT], bool] | None) -> list[EntityT]:
        """Return those of a sorted batch with tasks or waitables that have their turns now, and put back the others."""
        tasks = [each for each in batch if each.place[0] == TASK]
        others = batch[len(tasks) :]
        if tasks and not self._ran_tasks:
            turns, left = tasks, others
        else:
            turns, left = _with_one_part_each(others, accepts)
            if turns:
                left = [*tasks, *left]
            else:
                turns = tasks
        self._ran_tasks = turns is tasks
        self.ready.extendleft(reversed(left))
        return turns

    # Floods

    def gather(self) -> bool:
        """Make ready what waits in flooded mailboxes; False if nothing does."""
        with self.lock:
            for each in self.flooded:
                if each.waiting:
                    each.deliver()
            return bool(self.ready)

    def calm(self) -> None:
        """Let flooded mailboxes put a notice for each message again, where few have come."""
        with self.lock:
            self.flooded = [each for each in self.flooded if not each.calm()]

    # Taking

    def take(self, accepts: Callable[[EntityT], bool] | None = None) -> tuple[EntityT, Any] | None:
        """Take the entity whose turn it is and whose group lets it run, with what it is to execute."""
        with self.lock:
            turns, ready, blocked = self.turns, self.ready, self.blocked
            if blocked:
                self.unblock()
            while True:
                is_alone = not turns
                if turns:
                    entity = turns.popleft()
                elif len(ready) == 1 and not blocked:  # a round of one, as usual
                    entity, self._ran_tasks = ready.popleft(), False
                elif self.begin(accepts):
                    continue
                else:
                    return None
                group = entity.gate
                acquire = group._acquire_
                if (accepts is None or accepts(entity)) and (acquire(False) if acquire else reserve(group, entity)):
                    taken = entity.take()
                    if taken is not NOTHING:
                        self._took = True
                        return entity, taken
                    group.ending_execution(entity)
                else:
                    if is_alone:
                        self._took, self._unsorted = False, 0
                    blocked.append(entity)

    def take_at_once(
        self, arrival: Any, accepts: Callable[[EntityT], bool] | None = None
    ) -> tuple[EntityT, Any] | None:
        """Take what arrived for an entity if nothing else waits; else deliver it, and it waits its turn."""
        target = arrival.target
        if target.straight and accepts is None:
            with self.lock:
                if not (self.ready or self.turns):
                    entity = target.arrives_for()
                    if entity is not None and entity._queue_ is self:
                        group = entity.gate
                        if group._acquire_(False) if group._acquire_ else reserve(group, entity):
                            taken = target.take_arrived(entity, arrival.content)
                            if taken is not NOTHING:
                                return entity, taken
                            group.ending_execution(entity)
                            return None
        self.inbox.deliver(arrival)
        return None

    def hold_back(self, entity: EntityT) -> None:
        """Let an entity that was ready alone wait for its callback group."""
        self._took, self._unsorted = False, 0
        self.blocked.append(entity)

    def has_blocked(self) -> bool:
        """True if something ready waits for its callback group."""
        with self.lock:
            return bool(self.blocked or self.ready)

    def unblock(self) -> None:
        """Let what was blocked try again, before all others."""
        blocked = [*self.blocked]
        self.blocked.clear()
        blocked[self._unsorted :] = sorted(blocked[self._unsorted :], key=_place)
        self.turns.extendleft(reversed(blocked))


def _with_one_part_each(
    batch: list[EntityT], accepts: Callable[[EntityT], bool] | None
) -> tuple[list[EntityT], list[EntityT]]:
    """Return a sorted batch with the first part of each waitable that may run now, and the other parts."""
    turns, left, lane = list[EntityT](), list[EntityT](), 0
    for each in batch:
        if not each.lane:
            turns.append(each)
        elif each.lane != lane and (accepts is None or accepts(each)) and each.gate.can_execute(each):
            lane = each.lane
            turns.append(each)
        else:
            left.append(each)
    return turns, left


def reserve(group: CallbackGroup, entity: Any) -> bool:
    """Reserve a group for an entity; False if it must wait."""
    return group.can_execute(entity) and group.beginning_execution(entity)


def earlier(one: int | None, other: int | None) -> int | None:
    """Return the earlier of two moments; None is never."""
    if one is None or other is None:
        return other if one is None else one
    return min(one, other)
