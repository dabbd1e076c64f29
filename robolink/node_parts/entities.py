"""Store of a node's entities: its publishers, subscriptions, services, clients, timers, guards and waitables."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.event_handler import EventHandler, with_callbacks
from robolink.node_parts.losses import LossReports
from robolink.publisher import Publisher
from robolink.running.entity import Entity
from robolink.service import Service
from robolink.subscription import Subscription

if TYPE_CHECKING:
    from robolink.client import BaseClient
    from robolink.guard_condition import GuardCondition
    from robolink.node_parts.ports import OwningNode
    from robolink.timer import Timer
    from robolink.waitable import Waitable

EntityT = TypeVar("EntityT", bound=Entity)


class EntityStore:
    """Entities of one node, which owns this: they are attached to the node's executor, and end with the node."""

    def __init__(self, node: OwningNode) -> None:
        self._node = weakref.ref(node)  # weak: a node that nobody refers to is to go at once, without a collection
        self.publishers: list[Publisher[Any]] = []
        self.subscriptions: list[Subscription[Any]] = []
        self.clients: list[BaseClient] = []
        self.services: list[Service] = []
        self.timers: list[Timer] = []
        self.guards: list[GuardCondition] = []
        self.waitables: list[Waitable] = []
        self._losses = LossReports(node)

    def entities(self) -> list[Entity]:
        """Return all that an executor runs."""
        own: list[Entity] = [*self.subscriptions, *self.services, *self.clients, *self.timers, *self.guards]
        for publisher in self.publishers:
            own += with_callbacks(publisher.event_handlers)
        for subscription in self.subscriptions:
            own += with_callbacks(subscription.event_handlers)
        for waitable in self.waitables:
            own += waitable.entities()
        return own

    def all_services(self) -> list[Service]:
        """Return the node's services, those of its actions too."""
        parts = (each for waitable in self.waitables for each in waitable.entities())
        return [*self.services, *(each for each in parts if isinstance(each, Service))]

    def add_publisher(self, publisher: Publisher[Any]) -> None:
        """Own a publisher, and attach its event callbacks to the executor."""
        self._own(publisher, self.publishers)
        self._attach_handlers(publisher.event_handlers)

    def add_subscription(self, subscription: Subscription[Any]) -> None:
        """Own a subscription, and attach its callbacks to the executor."""
        subscription.on_loss = self._losses.note
        self.add(subscription, self.subscriptions)
        self._attach_handlers(subscription.event_handlers)

    def add_waitable(self, waitable: Waitable) -> None:
        """Own a waitable, and attach its entities to the executor."""
        self._own(waitable, self.waitables)
        self._attach(*waitable.entities())

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a waitable, without destroying it."""
        if waitable in self.waitables:
            self.waitables.remove(waitable)
            for entity in waitable.entities():
                entity.detach()

    def add(self, entity: EntityT, group: list[EntityT]) -> EntityT:
        """Own an entity as one of `group`, and attach it to the executor. Raises InvalidHandle if the node is gone."""
        self._own(entity, group)
        self._attach(entity)
        return entity

    def _own(self, made: Any, group: list[Any]) -> None:
        group.append(made)  # first, so that another thread that destroys the node just now finds it
        node = self._node()
        if node is not None and node._destroyed:  # nobody would destroy it
            destroy(made, group)
            raise node._gone_("the node")

    def _attach(self, *entities: Entity) -> None:
        node = self._node()
        if node is None:
            return
        executor = node._attached_to_
        for entity in entities:
            entity.node = node
            if executor is not None:
                executor.attach(entity)

    def _attach_handlers(self, handlers: list[EventHandler]) -> None:
        for handler in handlers:
            handler.attach_late = weakref.WeakMethod(self._attach)
        self._attach(*with_callbacks(handlers))

    def destroy(self) -> None:
        """Destroy all of them."""
        groups = self.publishers, self.subscriptions, self.clients, self.services, self.timers, self.guards
        for group in (*groups, self.waitables):
            for entity in list(group):
                destroy(entity, group)
        self._losses.destroy()


def destroy(entity: Any, group: list[Any]) -> bool:
    """Destroy an entity that is one of `group`, and return True; else return False."""
    if entity not in group:
        return False
    group.remove(entity)
    entity.destroy()
    return True
