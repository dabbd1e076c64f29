"""What an executor runs: the base of subscriptions, services, timers and the rest."""

from __future__ import annotations

import functools
import weakref
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup, ReentrantCallbackGroup
from robolink.destroyable import Destroyable
from robolink.inbox import Inbox, Mailbox

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor
    from robolink.node import Node

NOTHING: Any = object()
"""What `take` gives when there is nothing to do after all."""

ANY_TIME = ReentrantCallbackGroup()


class Entity(Destroyable):
    """Something that becomes ready, is taken, and then executed. At most one executor has it at a time."""

    serves = False
    """Whether it goes on while a callback waits for an answer: services and clients do."""

    quick = False
    """Whether no user's code is in it, so that an executor need not give it a thread."""

    def __init__(self, callback_group: CallbackGroup | None = None) -> None:
        self.callback_group: CallbackGroup = callback_group or ANY_TIME
        self.executor: Executor | None = None
        self._node: weakref.ReferenceType[Node] | None = None
        if callback_group is not None:
            callback_group.add_entity(self)

    @property
    def gate(self) -> CallbackGroup:
        """The group that says when it may run: its callback group, unless that need not be waited for."""
        return self.callback_group

    @property
    def origin(self) -> Entity:
        """The entity whose callback is executed: another one for the parts of a callback that is a coroutine."""
        return self

    @property
    def node(self) -> Node | None:
        """The node that has it, if one has."""
        return None if self._node is None else self._node()

    @node.setter
    def node(self, node: Node) -> None:
        self._node = weakref.ref(node)

    @property
    def _used_in_(self) -> Context | None:
        node = self.node
        return None if node is None else node.context

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Belong to this executor from now on; it is `queued` times among what is ready there already."""
        self.executor = executor

    def detach(self) -> None:
        """Belong to none."""
        self.executor = None

    def take(self) -> Any:
        """Give what is to be executed, or NOTHING; called under the inbox's lock."""
        raise NotImplementedError

    def execute(self, taken: Any) -> Any:
        """Run the user's callback; a coroutine that it returns is run by the executor."""
        raise NotImplementedError


class Asked(Entity):
    """An entity that does not tell when it becomes ready: its executor asks it whenever it looks around."""

    waits = False
    """Whether it was found ready and waits its turn."""

    def is_ready(self) -> bool:
        """Whether there is something to execute; called by whoever spins."""
        raise NotImplementedError

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Be asked by this executor."""
        super().attach(executor, queued)
        self.waits = queued > 0
        executor.asked = [*executor.asked, self]

    def detach(self) -> None:
        """Be asked by none."""
        executor = self.executor
        if executor is not None:
            executor.asked = [each for each in executor.asked if each is not self]
        super().detach()


class Receiver(Entity):
    """An entity that a transport delivers to: it has a mailbox, and a sink that leads to whoever spins it."""

    straight = False

    gives_way = False
    """Whether what arrives waits until all else that is ready has had its turn."""

    def __init__(self, parking: Inbox, depth: int, callback_group: CallbackGroup | None = None) -> None:
        super().__init__(callback_group)
        self._parking = parking
        self.mailbox = Mailbox(depth)
        self.sink: functools.partial[Any] = parking.sink(self)
        self._gave_way = 0

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Belong to this executor, which holds its lock: what arrives goes to its inbox, what waited is ready."""
        self._move(self._parking, executor.inbox)
        super().attach(executor, queued)
        executor.ready.extend([self] * (len(self.mailbox) - queued))

    def detach(self) -> None:
        """Belong to none: what arrives waits in the context's inbox."""
        executor = self.executor
        if executor is not None:
            with executor.inbox.lock:
                self._move(executor.inbox, self._parking)
                super().detach()

    def _move(self, before: Inbox, after: Inbox) -> None:
        # Both locks, so that nothing is delivered or taken meanwhile; the executor's always first.
        with self._parking.lock:
            self.redirect(after)
            before.clear()  # nothing of ours stays behind

    def redirect(self, inbox: Inbox) -> None:
        """Have what comes from now on arrive in this inbox."""
        inbox.take_over(self.sink)

    def deliver(self, arrived: Any) -> None:
        """Keep what arrived; be ready once more if that is one more than before."""
        if self.mailbox.put(arrived) and self.executor is not None:
            self.executor.ready.append(self)

    def take(self) -> Any:
        """Give the oldest of what waits."""
        waiting = self.mailbox.waiting
        if self.gives_way:
            executor = self.executor
            if executor is not None and executor.ready and self._gave_way < len(waiting):
                self._gave_way += 1
                executor.ready.append(self)
                return NOTHING
        if self._gave_way:
            self._gave_way -= 1
        return waiting.popleft() if waiting else NOTHING
