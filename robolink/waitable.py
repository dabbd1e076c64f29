"""Waitables: several things that a node has as one, such as an action's services and topics; or a program's own.

There are no rcl wait sets here. A program's own Waitable is asked instead, whenever its executor looks around: after
every callback, when anything arrives, at `executor.wake()`, and twice a second in any case. What it waits for must
be Python's: there are no rcl handles that could be put into a wait set, and no C events.
"""

from __future__ import annotations

import functools
from collections.abc import Awaitable
from typing import Any, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.client import Client
from robolink.entity import NOTHING, Asked, Entity
from robolink.guard_condition import GuardCondition
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.task import Future
from robolink.timer import Timer

WaitableT = TypeVar("WaitableT", bound="Waitable")


class NumberOfEntities:
    """How many of each kind an executor waits for; two of these can be added."""

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
        """Give the sums, kind by kind."""
        return NumberOfEntities().__iadd__(self).__iadd__(other)

    def __iadd__(self, other: NumberOfEntities) -> NumberOfEntities:
        """Add the other's numbers, kind by kind."""
        for each in self.__slots__:
            setattr(self, each, getattr(self, each) + getattr(other, each))
        return self

    def __repr__(self) -> str:
        return f"NumberOfEntities({', '.join(f'{each}={getattr(self, each)}' for each in self.__slots__)})"


class WaitSet:
    """What a Waitable is shown in place of an rcl wait set: it holds nothing, and says so."""

    def __getattr__(self, name: str) -> Any:
        raise NotImplementedError(
            f"robolink has no rcl wait sets, so there is no '{name}': a Waitable is asked is_ready() whenever its"
            " executor looks around; call executor.wake() to have that happen now"
        )


class Waitable:
    """The base of what consists of several entities: the node's executor runs them, and the node destroys them.

    They are in none of the node's lists of publishers, subscriptions, services, clients and timers. A program's own
    Waitable overrides `is_ready`, `take_data` and `execute` instead of `entities`.
    """

    def __init__(self, callback_group: CallbackGroup) -> None:
        self.callback_group = callback_group
        callback_group.add_entity(self)
        self._futures: list[Future[Any]] = []

    def entities(self) -> list[Entity]:
        """Give what an executor runs, the same each time."""
        return [self._asking]

    @functools.cached_property
    def _asking(self) -> _Asking:
        return _Asking(self)

    def interfaces(self) -> list[type[Any]]:
        """Give the message and service classes that are sent and received, so that the node can describe them."""
        return []

    def destroy(self) -> None:
        """Undeclare all of it. Safe to call twice."""
        for entity in self.entities():
            entity.detach()

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Whether there is something to take."""
        raise NotImplementedError

    def take_data(self) -> Any:
        """Give what `execute` gets, and be ready no longer."""
        raise NotImplementedError

    def execute(self, taken_data: Any) -> Awaitable[None]:
        """Do the work; a coroutine function."""
        raise NotImplementedError

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Be told that the executor is about to ask."""

    def add_future(self, future: Future[Any]) -> None:
        """Have the done callbacks of this future run by the executor."""
        self._futures.append(future)

    def remove_future(self, future: Future[Any]) -> None:
        """Leave its done callbacks to whoever sets its result."""
        self._futures.remove(future)

    def get_num_entities(self) -> NumberOfEntities:
        """Count them by their kinds."""
        kinds = (Subscription, GuardCondition, Timer, Client, Service)
        return NumberOfEntities(*(sum(isinstance(each, kind) for each in self.entities()) for kind in kinds))

    def __enter__(self: WaitableT) -> WaitableT:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class _Asking(Asked):
    """Asks a program's own Waitable for an executor."""

    def __init__(self, waitable: Waitable) -> None:
        super().__init__()
        self.callback_group = waitable.callback_group
        self._waitable = waitable
        self._wait_set = WaitSet()

    def is_ready(self) -> bool:
        """Ask."""
        self._waitable.add_to_wait_set(self._wait_set)
        return self._waitable.is_ready(self._wait_set)

    def take(self) -> Any:
        """Be executed, unless it was removed meanwhile."""
        return NOTHING if self.executor is None else True

    def execute(self, taken: Any) -> Any:
        """Take and execute."""
        for future in self._waitable._futures:
            future.set_executor(self.executor)
        data = self._waitable.take_data()
        self.waits = False
        return self._waitable.execute(data)
