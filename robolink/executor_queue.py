"""What an executor has before it: its nodes, what of theirs is ready, and when their timers are due."""

from __future__ import annotations

import heapq
import itertools
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from robolink.entity import NOTHING, Asked, Entity

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor
    from robolink.node import Node
    from robolink.timer import Timer

Taken = tuple[Entity, Any]
"""An entity, and what it gave to be executed."""


class ExecutorQueue:
    """The part of an executor that knows what is to be done, and in which order."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self.inbox = context.make_inbox()
        self.ready: deque[Entity] = deque()
        self.asked: list[Asked] = []
        """Those of its entities that must be asked whether they are ready."""
        self._blocked: deque[Entity] = deque()
        self._polled: deque[Entity] = deque()
        self._timers: list[tuple[int, int, int, Timer]] = []
        self._serial = itertools.count()
        self._nodes: list[Node] = []
        self._lock = self.inbox.lock

    # Nodes

    def add_node(self, node: Node) -> bool:
        """Run this node's callbacks, and take it from another executor; False when it is here already."""
        executor = cast("Executor", self)
        before = node.executor
        if before is not None and before is not executor:
            before.remove_node(node)
        with self._lock:
            if node in self._nodes:
                return False
            self._nodes.append(node)
            node._belong_to_(executor)
            self._context.look_after(self.inbox)
            queued, node._queued_ = node._queued_, []
            self.ready.extend(queued)
            for entity in node._entities_():
                entity.attach(executor, queued.count(entity))
        self.wake()
        return True

    def remove_node(self, node: Node) -> None:
        """Run its callbacks no more. What is ready keeps its turn until the node is added again."""
        with self._lock:
            if node not in self._nodes:
                return
            self._nodes.remove(node)
            entities = node._entities_()
            for entity in entities:
                entity.detach()
            node._queued_ = self._withdraw(set(entities))
            node._belong_to_(None)
        self.wake()

    def _withdraw(self, entities: set[Entity]) -> list[Entity]:
        self._unblock()
        withdrawn: list[Entity] = []
        for _ in range(len(self.ready)):  # in place, since other threads may append
            entity = self.ready.popleft()
            (withdrawn if entity in entities else self.ready).append(entity)
        return withdrawn

    def get_nodes(self) -> list[Node]:
        """All nodes that were added."""
        return list(self._nodes)

    def attach(self, entity: Entity) -> None:
        """Run this entity's callback from now on."""
        with self._lock:
            entity.attach(cast("Executor", self))
        self.wake()

    # What becomes ready

    def wake(self) -> None:
        """Let whoever waits look around."""
        self.inbox.wake()

    def post(self, entity: Entity) -> None:
        """Make an entity ready, from any thread."""
        self.ready.append(entity)
        self.wake()

    def poll(self, entity: Entity) -> None:
        """Make an entity ready again in a moment."""
        self._polled.append(entity)

    def _ask_again(self) -> None:
        for _ in range(len(self._polled)):  # one by one, since other threads may append
            self.ready.append(self._polled.popleft())

    def _ask_waitables(self) -> None:
        for each in self.asked:
            if not each.waits and each.gate.can_execute(each) and each.is_ready():
                each.waits = True
                self.ready.append(each)

    # Timers

    def schedule(self, timer: Timer, left: int) -> None:
        """Have a timer made ready in `left` nanoseconds of steady time."""
        due = self._context.time.steady() + left
        with self._lock:
            heapq.heappush(self._timers, (due, next(self._serial), timer.version, timer))

    def _collect_due(self) -> int | None:
        """Make timers ready that are due; give when the next one is."""
        timers, steady = self._timers, self._context.time.steady
        with self._lock:
            while timers:
                due, _, version, timer = timers[0]
                if timer.version != version or timer.executor is not self:
                    heapq.heappop(timers)
                elif due <= steady():
                    heapq.heappop(timers)
                    self.ready.append(timer)
                else:
                    return due
        return None

    # Taking

    def _take(self, wanted: Callable[[Entity], bool] | None = None) -> Taken | None:
        """Take the first that is ready and whose group lets it run."""
        with self._lock:
            if self._blocked:
                self._unblock()
            while self.ready:
                entity = self.ready.popleft()
                group = entity.gate
                if (wanted is not None and not wanted(entity)) or not (
                    group.can_execute(entity) and group.beginning_execution(entity)
                ):
                    self._blocked.append(entity)
                    continue
                taken = entity.take()
                if taken is not NOTHING:
                    return entity, taken
                group.ending_execution(entity)
        return None

    def _take_at_once(self, arrival: Any, wanted: Callable[[Entity], bool] | None = None) -> Taken | None:
        """Take what arrived for an entity for which nothing waits; else deliver it, and it waits its turn."""
        target = arrival.target
        if target.straight and wanted is None:
            with self._lock:
                group = target.gate
                is_next = target.executor is self and not (self.ready or len(target.mailbox))
                if is_next and group.can_execute(target) and group.beginning_execution(target):
                    return target, arrival.content
        self.inbox.deliver(arrival)
        return None

    def _unblock(self) -> None:
        self.ready.extendleft(reversed(self._blocked))
        self._blocked.clear()


def earlier(one: int | None, other: int | None) -> int | None:
    """The earlier of two moments; None is never."""
    if one is None or other is None:
        return other if one is None else one
    return min(one, other)
