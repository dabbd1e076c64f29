"""Nodes of an executor: those that were added, and the parked node, whose entities stay attached between two spins.

A program that calls `spin_once(node)` in a loop adds the node and removes it each time. To take its entities out and in
again would cost ten times as much as the callback. So a node that is spun once and again is parked instead: to the
program it belongs to no executor, but its entities stay attached. It is removed for good as soon as anything else is
spun here, or another executor wants it.
"""

from __future__ import annotations

import weakref
from collections.abc import Collection
from typing import TYPE_CHECKING

from robolink.running.entity import Entity
from robolink.running.ready_queue import ReadyQueue

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike, Loop, SpunNode


class SpunNodes:
    """Nodes whose callbacks an executor runs, and the parked one, whose callbacks it does not run for now."""

    def __init__(self, queue: ReadyQueue[Entity], context: ContextLike) -> None:
        self._queue, self._context = queue, context
        self.added: list[SpunNode] = []
        self.parked: weakref.ReferenceType[SpunNode] | None = None
        """The parked node, if there is one."""
        self._members: weakref.WeakSet[Entity] | None = None
        """Entities of the parked node, or of the one that was parked just before; None if there is none."""
        self._last: weakref.ReferenceType[SpunNode] | None = None
        """The node that was to be parked last."""

    def add(self, node: SpunNode, executor: Loop) -> bool:
        """Attach the entities of a node to this executor, which has it from now on; False if it is here already."""
        with self._queue.lock:
            if self.resume(node):
                return True
            if node in self.added:
                return False
            self._context.look_after(self._queue.inbox, self)
            self.evict()
            self._members = None
            self.added.append(node)
            node._belong_to_(executor)
            turns, node._turns_ = node._turns_, []
            for entity in node._entity_store_.entities():
                entity.attach(executor, entity in turns)
            self._queue.turns.extend(turns)
        return True

    def remove(self, node: SpunNode) -> bool:
        """Detach the entities of a node; False if it is not here. A turn still to come comes once the node is added."""
        with self._queue.lock:
            if node in self.added:
                self.added.remove(node)
                if self.parked is None:
                    self._members = None
                self._let_go(node)
                return True
            if self.parked is not None and self.parked() is node:
                self.evict()
                return True
        return False

    def _detach(self, entities: Collection[Entity]) -> list[Entity]:
        """Detach these entities, and return those whose turn was still to come, in order."""
        for entity in entities:
            entity.detach()
        return self._queue.withdraw(set(entities))

    def _let_go(self, node: SpunNode) -> None:
        node._turns_ = self._detach(node._entity_store_.entities())
        node._is_parked_ = False
        node._belong_to_(None)

    def attach(self, entity: Entity, executor: Loop) -> None:
        """Attach a new entity of one of the nodes, or one of no node."""
        with self._queue.lock:
            entity.attach(executor)
            if self._members is not None:
                self._members.add(entity)

    # Parking

    def park(self, node: SpunNode) -> bool:
        """Take a node from this executor, but leave its entities attached, in case that it is soon added again.

        Returns False if it is to be removed, since another one was spun before: two nodes by turns would only be in
        each other's way.
        """
        with self._queue.lock:
            seen, self._last = self._last, weakref.ref(node)
            if self._last is not seen or node not in self.added:
                return False
            if self.parked is not None:
                self.evict()
            self.added.remove(node)
            if self._members is None:
                self._members = weakref.WeakSet(node._entity_store_.entities())
            self.parked = self._last
            node._is_parked_ = True
        return True

    def resume(self, node: SpunNode) -> bool:
        """Add a node that is parked here; False if it is not."""
        if self.parked is None:
            return False
        with self._queue.lock:
            if self.parked is None or self.parked() is not node:
                return False
            self.parked = None
            self.added.append(node)
            node._is_parked_ = False
        return True

    def evict(self) -> None:
        """Remove the parked node, if there is one: whoever spins now must not run its callbacks."""
        with self._queue.lock:
            if self.parked is None:
                return
            node, members = self.parked(), self._members or ()
            self.parked = self._members = None
            if node is not None:
                self._let_go(node)
            else:  # nobody held it any more, but something may hold entities of it
                self._detach([each for each in members if each.node is None])

    def clear(self) -> None:
        """Sweep what arrived for the parked node: what waits stays bounded by the mailboxes while nobody spins."""
        if self.parked is not None:
            with self._queue.lock:
                if self.parked is not None:
                    self._queue.inbox.sweep()
