"""Which callbacks may run at the same time."""

from __future__ import annotations

import threading
import weakref
from typing import Any


class CallbackGroup:
    """The base class: a user may make a group of their own by overriding the last three methods."""

    def __init__(self) -> None:
        super().__init__()
        self.entities: set[weakref.ReferenceType[Any]] = set()

    def add_entity(self, entity: Any) -> None:
        """Make an entity a member."""
        self.entities.add(weakref.ref(entity, self.entities.discard))

    def has_entity(self, entity: Any) -> bool:
        """Whether it is a member."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        """Whether its callback may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Be told that its callback is about to run; False forbids it."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Be told that its callback has ended."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """All callbacks may run at any time."""

    def can_execute(self, entity: Any) -> bool:
        """Say yes."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Say yes."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Do nothing."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One callback at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._busy = threading.Lock()

    def can_execute(self, entity: Any) -> bool:
        """Whether none runs."""
        return not self._busy.locked()

    def beginning_execution(self, entity: Any) -> bool:
        """Whether none runs; from now on, this one does."""
        return self._busy.acquire(blocking=False)

    def ending_execution(self, entity: Any) -> None:
        """Let the next one run."""
        self._busy.release()
