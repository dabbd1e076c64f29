"""Waitables: several entities of a node as one, such as an action's services and topics; or a program's own.

There are no rcl wait sets here. A program's own Waitable is asked instead, whenever its executor looks around: after
every callback, when anything arrives, at `executor.wake()`, and twice a second in any case. What it waits for must
be Python's: there are no rcl handles that could be put into a wait set, and no C events.
"""

from __future__ import annotations

import functools
from collections.abc import Awaitable
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.client import Client
from robolink.guard_condition import GuardCondition
from robolink.running.entity import NOTHING, Entity
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.task import Future
from robolink.timer import Timer
from robolink.type_support import in_brackets

if TYPE_CHECKING:
    from robolink.running.ports import Loop

WaitableT = TypeVar("WaitableT", bound="Waitable")


class NumberOfEntities:
    """Numbers of entities that an executor waits for, by kind; two of these can be added.

    Args:
        num_subs: Number of subscriptions.
        num_gcs: Number of guard conditions.
        num_timers: Number of timers.
        num_clients: Number of clients.
        num_services: Number of services.
        num_events: Number of events.
    """

    __slots__ = (
        "num_clients",
        "num_events",
        "num_guard_conditions",
        "num_services",
        "num_subscriptions",
        "num_timers",
    )

    def __init__(
        self,
        num_subs: int = 0,
        num_gcs: int = 0,
        num_timers: int = 0,
        num_clients: int = 0,
        num_services: int = 0,
        num_events: int = 0,
    ) -> None:
        self.num_subscriptions = num_subs
        self.num_guard_conditions = num_gcs
        self.num_timers = num_timers
        self.num_clients = num_clients
        self.num_services = num_services
        self.num_events = num_events

    def __add__(self, other: NumberOfEntities) -> NumberOfEntities:
        """Return the sums, kind by kind."""
        return NumberOfEntities().__iadd__(self).__iadd__(other)

    def __iadd__(self, other: NumberOfEntities) -> NumberOfEntities:
        """Add the other's numbers, kind by kind."""
        for each in self.__slots__:
            setattr(self, each, getattr(self, each) + getattr(other, each))
        return self

    def __repr__(self) -> str:
        return f"NumberOfEntities({', '.join(f'{each}={getattr(self, each)}' for each in self.__slots__)})"


class WaitSet:
    """Stand-in for an rcl wait set, for a Waitable: it holds nothing, and every attribute says so."""

    def __getattr__(self, name: str) -> Any:
        raise NotImplementedError(
            f"robolink has no rcl wait sets, so there is no '{name}': a Waitable is asked is_ready() whenever its"
            " executor looks around; call executor.wake() to have that happen now"
        )


class Waitable:
    """Base of what consists of several entities: the node's executor runs them, and the node destroys them.

    They are in none of the node's lists of publishers, subscriptions, services, clients and timers. A program's own
    Waitable overrides `is_ready`, `take_data` and `execute` instead of `entities`. `callback_group` is the group of
    all its callbacks.
    """

    __class_getitem__ = in_brackets(1)

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        callback_group.add_entity(self)
        self._futures: list[Future[Any]] = []

    def entities(self) -> list[Entity]:
        """Return the entities that an executor runs, the same each time."""
        return [self._asking]

    @functools.cached_property
    def _asking(self) -> _PolledWaitable:
        return _PolledWaitable(self)

    def interfaces(self) -> list[type[Any]]:
        """Return the message and service classes that are sent and received, so that the node can describe them."""
        return []

    def destroy(self) -> None:
        """End all its entities. Safe to call twice."""
        for entity in self.entities():
            entity.detach()

    def is_ready(self, wait_set: WaitSet) -> bool:
        """True if there is something to take; `wait_set` stands for rcl's, and holds nothing."""
        raise NotImplementedError

    def take_data(self) -> Any:
        """Return the data that `execute` gets; from then on it is not ready, until there is more."""
        raise NotImplementedError

    def execute(self, taken_data: Any) -> Awaitable[None]:
        """Do the work with `taken_data`, the result of `take_data`; a coroutine function."""
        raise NotImplementedError

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Prepare for `is_ready`, which is called next; `wait_set` stands for rcl's, and holds nothing."""

    def add_future(self, future: Future[Any]) -> None:
        """Let the executor run the done callbacks of this `future`."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        """Leave the done callbacks of this `future` to the thread that completes it."""
        self._futures.remove(future)

    def get_num_entities(self) -> NumberOfEntities:
        """Return the number of its entities of each kind."""
        kinds = (Subscription, GuardCondition, Timer, Client, Service)
        return NumberOfEntities(*(sum(isinstance(each, kind) for each in self.entities()) for kind in kinds))

    def __enter__(self: WaitableT) -> WaitableT:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class _PolledWaitable(Entity):
    """Polls a program's own Waitable for an executor, before each look at what is ready."""

    waits = False
    """True if it was found ready and waits its turn."""

    def __init__(self, waitable: Waitable) -> None:
        super().__init__()
        self.callback_group = waitable.callback_group
        self._waitable = waitable
        self._wait_set = WaitSet()

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this executor, which polls it."""
        super().attach(executor, has_turn)
        self.waits = has_turn
        executor._queue_.add_pollable(self)

    def detach(self) -> None:
        """Belong to no executor; nothing polls it then."""
        queue = self._queue_
        if queue is not None:
            queue.remove_pollable(self)
        super().detach()

    def is_ready(self) -> bool:
        """True if the Waitable says so; called by the thread that spins."""
        self._waitable.add_to_wait_set(self._wait_set)
        return self._waitable.is_ready(self._wait_set)

    def take(self) -> Any:
        """Return True, to be executed, or NOTHING if it was removed meanwhile."""
        return NOTHING if self.executor is None else True

    def execute(self, taken: Any) -> Any:
        """Take and execute."""
        for future in self._waitable._futures:
            future.set_executor(self.executor)
        data = self._waitable.take_data()
        self.waits = False
        return self._waitable.execute(data)
