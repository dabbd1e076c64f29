"""Entities of a node: its publishers, subscriptions, services, clients, timers, guard conditions and waitables."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.client import Client
from robolink.event_handler import EventHandler, with_callbacks
from robolink.guard_condition import GuardCondition
from robolink.node_parts.losses import LossReports
from robolink.publisher import Publisher
from robolink.running.destroyable import Destroyable
from robolink.running.entity import Entity
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.timer import Rate, Timer
from robolink.waitable import Waitable

if TYPE_CHECKING:
    from robolink.executors import Executor
    from robolink.impl.rcutils_logger import RcutilsLogger
    from robolink.running.ports import ContextLike

EntityT = TypeVar("EntityT", bound=Entity)


class NodeEntities(Destroyable):
    """The part of a node that keeps its entities, and destroys them."""

    if TYPE_CHECKING:  # the node's
        _number_: int

        @property
        def context(self) -> ContextLike:
            """The context that it lives in."""

        def get_fully_qualified_name(self) -> str:
            """Return namespace and name."""

        def get_logger(self) -> RcutilsLogger:
            """Return the logger that carries the node's name."""

    def _init_entities_(self) -> None:
        self._publishers: list[Publisher[Any]] = []
        self._subscriptions: list[Subscription[Any]] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._waitables_: list[Waitable] = []
        self._losses_ = LossReports(self)

    @property
    def executor(self) -> Executor | None:
        """The executor that the node was added to."""
        raise NotImplementedError

    @property
    def _attached_to_(self) -> Executor | None:
        """The executor that the node's entities are attached to."""
        raise NotImplementedError

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Publishers of the node."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Subscriptions of the node."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        """Clients of the node."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service]:
        """Services of the node."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """Timers of the node."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Guard conditions of the node."""
        yield from self._guards

    @property
    def waitables(self) -> Iterator[Waitable]:
        """Waitables of the node, each of several entities: its actions."""
        yield from self._waitables_

    def _entities_(self) -> list[Entity]:
        """Return all that an executor runs."""
        own: list[Entity] = [*self._subscriptions, *self._services, *self._clients, *self._timers, *self._guards]
        for publisher in self._publishers:
            own += with_callbacks(publisher.event_handlers)
        for subscription in self._subscriptions:
            own += with_callbacks(subscription.event_handlers)
        for waitable in self._waitables_:
            own += waitable.entities()
        return own

    def _all_services_(self) -> list[Service]:
        """Return the node's services, those of its actions too."""
        parts = (each for waitable in self._waitables_ for each in waitable.entities())
        return [*self._services, *(each for each in parts if isinstance(each, Service))]

    def add_waitable(self, waitable: Waitable) -> None:
        """Add a `waitable`: the node's executor runs its entities, and the node destroys it."""
        self._keep_(waitable, self._waitables_)
        self._attach_(*waitable.entities())

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a `waitable`, without destroying it."""
        if waitable in self._waitables_:
            self._waitables_.remove(waitable)
            for entity in waitable.entities():
                entity.detach()

    def _keep_(self, made: Any, group: list[Any]) -> None:
        """Own what was made. Raises InvalidHandle once the node has been destroyed, since nobody would destroy it."""
        group.append(made)  # first, so that another thread that destroys the node just now finds it
        if self._destroyed:
            _destroy(made, group)
            raise self._gone_("the node")

    def _add_(self, entity: EntityT, group: list[EntityT]) -> EntityT:
        self._keep_(entity, group)
        self._attach_(entity)
        return entity

    def _add_subscription_(self, made: Subscription[Any]) -> None:
        """Own a subscription, and attach its callbacks to the executor."""
        made.on_loss = self._losses_.note
        self._add_(made, self._subscriptions)
        self._attach_handlers_(made.event_handlers)

    def _attach_(self, *entities: Entity) -> None:
        executor = self._attached_to_
        for entity in entities:
            entity.node = self
            if executor is not None:
                executor.attach(entity)

    def _attach_handlers_(self, handlers: list[EventHandler]) -> None:
        for handler in handlers:
            handler.attach_late = weakref.WeakMethod(self._attach_)
        self._attach_(*with_callbacks(handlers))

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a `publisher`; False if it is none of this node's."""
        return _destroy(publisher, self._publishers)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a `subscription`; False if it is none of this node's."""
        return _destroy(subscription, self._subscriptions)

    def destroy_client(self, client: Client) -> bool:
        """Destroy a `client`; False if it is none of this node's."""
        return _destroy(client, self._clients)

    def destroy_service(self, service: Service) -> bool:
        """Destroy a `service`; False if it is none of this node's."""
        return _destroy(service, self._services)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a `timer`; False if it is none of this node's."""
        return _destroy(timer, self._timers)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition, `guard`; False if it is none of this node's."""
        return _destroy(guard, self._guards)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a `rate`; False if it is none of this node's."""
        found = self.destroy_timer(rate._timer)
        rate.destroy()
        return found

    def _destroy_entities_(self) -> None:
        for owned in (self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards):
            for entity in list(owned):
                _destroy(entity, owned)
        for waitable in list(self._waitables_):
            _destroy(waitable, self._waitables_)
        self._losses_.destroy()


def _destroy(entity: Any, owned: list[Any]) -> bool:
    if entity not in owned:
        return False
    owned.remove(entity)
    entity.destroy()
    return True
