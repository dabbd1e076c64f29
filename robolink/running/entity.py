"""Entity: the base of all that an executor runs, subscriptions, services, timers and the rest."""

from __future__ import annotations

import functools
import itertools
import weakref
from collections.abc import Callable
from types import CoroutineType
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup, ReentrantCallbackGroup
from robolink.running.delivered import Delivered
from robolink.running.destroyable import Destroyable
from robolink.running.inbox import Inbox
from robolink.running.keep_last import KeepLast
from robolink.running.ready_queue import HELD, OTHER, TASK, WAITABLE, Place, ReadyQueue, reserve
from robolink.running.ready_queue import NOTHING as NOTHING
from robolink.transport.history import ALL

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike, Loop, NodeLike

ANY_TIME = ReentrantCallbackGroup()

TIMER, SUBSCRIPTION, GUARD_CONDITION, CLIENT, SERVICE = range(5)
"""Ranks of the kinds of entities: the order in which those of one node have their turns in a round, as in rclpy."""

next_number = itertools.count(1).__next__
"""Returns the number of an entity, or of a waitable of several, in the order in which they are made."""


class Entity(Destroyable):
    """Base of what executors run: it becomes ready, is taken, and then executed. At most one executor has it at a time.

    `callback_group` is the group of its callback; None lets it run at any time.
    """

    serves = False
    """True if it goes on while a callback waits for an answer: services and clients do."""

    quick = False
    """True if no user's code is in it, so that an executor need not run it in a thread."""

    is_gated = True
    """False if its group need not be waited for."""

    rank: int | None = None
    """Rank of its kind; None for what comes before all these, as waitables do."""

    lane = 0
    """Number of the waitable that it is a part of; these have one turn together in each round, in order of arrival."""

    place: Place = (TASK, 0, 0, 0)
    """Place in each round of its executor."""

    gate: CallbackGroup
    """Group that decides when it may run: its callback group if it `is_gated`. Executors read it for each callback."""

    def __init__(self, callback_group: CallbackGroup | None = None) -> None:
        self.gate = ANY_TIME  # no attribute of the class: a default of a class in Python slows down all that read it
        self.callback_group = callback_group or ANY_TIME
        self.executor: Loop | None = None
        self._queue_: ReadyQueue[Any] | None = None
        """Ready queue of its executor."""
        self._node: weakref.ReferenceType[NodeLike] | None = None
        self._number = next_number()
        if callback_group is not None:
            callback_group.add_entity(self)

    @property
    def callback_group(self) -> CallbackGroup:
        """Group of its callback; another one may be set, as in rclpy."""
        return self._callback_group

    @callback_group.setter
    def callback_group(self, group: CallbackGroup) -> None:
        self._callback_group = group
        if self.is_gated:
            self.gate = group

    @property
    def origin(self) -> Entity:
        """Entity whose callback is executed: another one for the parts of a callback that is a coroutine."""
        return self

    @property
    def node(self) -> NodeLike | None:
        """Node that has it, if one has."""
        return None if self._node is None else self._node()

    @node.setter
    def node(self, node: NodeLike) -> None:
        self._node = weakref.ref(node)

    @property
    def _used_in_(self) -> ContextLike | None:
        node = self.node
        return None if node is None else node.context

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this `executor` from now on; `has_turn`: it has a turn in the present round already."""
        node = self.node
        number = 0 if node is None else node._number_
        if self.rank is None or self.lane:
            self.place = WAITABLE, number, 0, self.lane or self._number
        else:
            self.place = OTHER, number, self.rank, self._number
        self.executor, self._queue_ = executor, executor._queue_

    def detach(self) -> None:
        """Belong to no executor."""
        self.executor = self._queue_ = None

    def take(self) -> Any:
        """Return the value to execute with, or NOTHING; called under the inbox's lock."""
        raise NotImplementedError

    def execute(self, taken: Any) -> Any:
        """Run the user's callback with what was `taken`; a coroutine that it returns is run by the executor."""
        raise NotImplementedError

    def turn(self) -> Any:
        """Do what an executor does to an entity that is ready alone: reserve its group, take, execute.

        Returns:
            The outcome of `execute`: a coroutine keeps the group reserved. HELD if the group holds it back; NOTHING if
            there was nothing to execute.
        """
        group = self.gate
        acquire = group._acquire_
        if not (acquire(False) if acquire else reserve(group, self)):
            return HELD
        outcome = taken = self.take()
        try:
            if taken is not NOTHING:
                outcome = None  # should it fail
                outcome = self.execute(taken)
        finally:
            if outcome is None or not isinstance(outcome, CoroutineType):
                release = group._release_
                if release:
                    release()
                else:
                    group.ending_execution(self)
        return outcome


class Receiver(Entity):
    """Entity that a transport delivers to: it has a mailbox, and a sink that leads to the executor's inbox.

    Args:
        parking: Inbox of the context, for what arrives while no executor has it.
        depth: Largest number of arrivals that wait; 0 is any number.
        callback_group: Group of its callback; None lets it run at any time.
        prepare: Function of what arrives, which returns what is stored in its place, or None for nothing.
        threaded: True if threads of the network deliver: what is too much is dropped there, without Python.
    """

    def __init__(
        self,
        parking: Inbox,
        depth: int,
        callback_group: CallbackGroup | None = None,
        prepare: Callable[[Any], Any] | None = None,
        threaded: bool = False,
    ) -> None:
        super().__init__(callback_group)
        self.lane = 0  # in the instance, where Python 3.11 finds it in a tenth of the time
        self._parking = parking
        drops_in_c = threaded and depth != ALL and prepare is None
        self.straight = prepare is None and not drops_in_c
        """True if an executor may take what arrives straight from the inbox: its mailbox would only hand it on."""
        self.mailbox: KeepLast | Delivered
        self.deliver: Callable[[Any], None]
        """Store what arrives, and be ready from then on."""
        self.sink: functools.partial[Any]
        """Sink for the network."""
        self._to_inbox: functools.partial[Any]
        """Sink that leads to the inbox, of what arrives or of notices; another inbox can take it over."""
        if drops_in_c:
            self.mailbox = last = KeepLast(depth, self, parking)
            self.deliver = self.sink = last.entrance
            self._to_inbox = last.sink
        else:
            self.mailbox = Delivered(depth, self, prepare)
            self.deliver = self.mailbox.put
            self.sink = self._to_inbox = parking.sink(self)

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this `executor`, which holds its lock: what arrives goes to its inbox, what waited is ready."""
        queue = executor._queue_
        self._move(self._parking, queue.inbox)
        super().attach(executor, has_turn)
        has_turns = bool(self.lane) or not queue.in_rounds
        self.mailbox.begin(queue, self, has_turn=has_turn, has_turns=has_turns)

    def detach(self) -> None:
        """Belong to no executor: what arrives waits in the context's inbox."""
        queue = self._queue_
        if queue is not None:
            with queue.lock:
                self.mailbox.end(queue)
                self._move(queue.inbox, self._parking)
                super().detach()

    def _move(self, before: Inbox, after: Inbox) -> None:
        # Both locks, so that nothing is delivered or taken meanwhile; the executor's always first.
        with self._parking.lock:
            self.redirect(after)
            before.clear()  # nothing of ours stays behind

    def redirect(self, inbox: Inbox) -> None:
        """Redirect what comes from now on to this `inbox`."""
        inbox.take_over(self._to_inbox)

    def become_ready(self) -> None:
        """Take a turn in the next round; as a part of a waitable, one turn more."""
        queue = self._queue_
        if queue is None:
            return
        self.mailbox.listed = queue.in_rounds and not self.lane  # else each message has a turn, as a waitable's do
        queue.ready.append(self)

    def arrives_for(self) -> Receiver:
        """Return the entity that arrivals are for: itself."""
        return self

    def take_arrived(self, _: Receiver, content: Any) -> Any:
        """Return `content`, which has just arrived; NOTHING if others came before it, behind which it waits then."""
        if self.mailbox.waiting:
            self.deliver(content)
            return NOTHING
        return content

    def overflowed(self) -> None:
        """Note, under the inbox's lock, that the oldest of what waited was dropped for what has arrived."""

    def take(self) -> Any:
        """Return the oldest of what waits, or NOTHING; what waits behind it has its turn in the next round."""
        return self.mailbox.take_next(self)
