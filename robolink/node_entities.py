"""What a node owns: its publishers, subscriptions, services, clients, timers and guard conditions."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeVar, cast

from robolink.client import Client
from robolink.destroyable import Destroyable
from robolink.entity import Entity
from robolink.event_handler import EventHandler, with_callbacks
from robolink.guard_condition import GuardCondition
from robolink.publisher import Publisher
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.timer import Rate, Timer
from robolink.waitable import Waitable

if TYPE_CHECKING:
    from robolink.executors import Executor
    from robolink.node import Node

EntityT = TypeVar("EntityT", bound=Entity)


class NodeEntities(Destroyable):
    """The part of a node that keeps what it has made, and unmakes it."""

    def _init_entities_(self) -> None:
        self._publishers: list[Publisher[Any]] = []
        self._subscriptions: list[Subscription[Any]] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._waitables_: list[Waitable] = []

    @property
    def executor(self) -> Executor | None:
        """The executor that the node was added to."""
        raise NotImplementedError

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Its publishers."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Its subscriptions."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        """Its clients."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service]:
        """Its services."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """Its timers."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Its guard conditions."""
        yield from self._guards

    @property
    def waitables(self) -> Iterator[Waitable]:
        """What it has that consists of several entities: its actions."""
        yield from self._waitables_

    def _entities_(self) -> list[Entity]:
        """All that an executor runs."""
        own: list[Entity] = [*self._subscriptions, *self._services, *self._clients, *self._timers, *self._guards]
        for publisher in self._publishers:
            own += with_callbacks(publisher.event_handlers)
        for subscription in self._subscriptions:
            own += with_callbacks(subscription.event_handlers)
        for waitable in self._waitables_:
            own += waitable.entities()
        return own

    def _all_services_(self) -> list[Service]:
        """Its services, those of its actions too."""
        parts = (each for waitable in self._waitables_ for each in waitable.entities())
        return [*self._services, *(each for each in parts if isinstance(each, Service))]

    def add_waitable(self, waitable: Waitable) -> None:
        """Have the entities of a waitable run by the node's executor, and the waitable destroyed with the node."""
        self._keep_(waitable, self._waitables_)
        self._attach_(*waitable.entities())

    def remove_waitable(self, waitable: Waitable) -> None:
        """Let go of a waitable, which is none of the node's any more."""
        if waitable in self._waitables_:
            self._waitables_.remove(waitable)
            for entity in waitable.entities():
                entity.detach()

    def _keep_(self, made: Any, group: list[Any]) -> None:
        """Own what was made. Raises InvalidHandle once the node has been destroyed: nobody would unmake it."""
        group.append(made)  # first, so that another thread that destroys the node just now finds it
        if self._destroyed:
            _destroy(made, group)
            raise self._gone_("the node")

    def _add_(self, entity: EntityT, group: list[EntityT]) -> EntityT:
        self._keep_(entity, group)
        self._attach_(entity)
        return entity

    def _add_subscription_(self, made: Subscription[Any]) -> None:
        """Own a subscription, and have its callbacks run."""
        self._add_(made, self._subscriptions)
        self._attach_handlers_(made.event_handlers)

    def _attach_(self, *entities: Entity) -> None:
        executor = self.executor
        for entity in entities:
            entity.node = cast("Node", self)
            if executor is not None:
                executor.attach(entity)

    def _attach_handlers_(self, handlers: list[EventHandler]) -> None:
        for handler in handlers:
            handler.attach_late = weakref.WeakMethod(self._attach_)
        self._attach_(*with_callbacks(handlers))

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Undeclare a publisher; False when it is none of this node's."""
        return _destroy(publisher, self._publishers)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Undeclare a subscription; False when it is none of this node's."""
        return _destroy(subscription, self._subscriptions)

    def destroy_client(self, client: Client) -> bool:
        """Undeclare a client; False when it is none of this node's."""
        return _destroy(client, self._clients)

    def destroy_service(self, service: Service) -> bool:
        """Undeclare a service; False when it is none of this node's."""
        return _destroy(service, self._services)

    def destroy_timer(self, timer: Timer) -> bool:
        """End a timer; False when it is none of this node's."""
        return _destroy(timer, self._timers)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """End a guard condition; False when it is none of this node's."""
        return _destroy(guard, self._guards)

    def destroy_rate(self, rate: Rate) -> bool:
        """End a rate; False when it is none of this node's."""
        found = self.destroy_timer(rate._timer)
        rate.destroy()
        return found

    def _destroy_entities_(self) -> None:
        for owned in (self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards):
            for entity in list(owned):
                _destroy(entity, owned)
        for waitable in list(self._waitables_):
            _destroy(waitable, self._waitables_)


def _destroy(entity: Any, owned: list[Any]) -> bool:
    if entity not in owned:
        return False
    owned.remove(entity)
    entity.destroy()
    return True
