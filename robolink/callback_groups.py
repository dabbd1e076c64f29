"""Callback groups: they decide which callbacks of an executor may run at the same time."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable
from typing import Any


class CallbackGroup:
    """Base class of callback groups; one of your own overrides `can_execute` and the two methods below it."""

    _acquire_: Callable[[bool], bool] | None = None
    """Function in C that, called with False, is `can_execute` and `beginning_execution` in one, where there is one."""

    _release_: Callable[[], object] | None = None
    """Function in C that is `ending_execution`, where there is one."""

    def __init__(self) -> None:
        super().__init__()
        self.entities: set[weakref.ReferenceType[Any]] = set()

    def add_entity(self, entity: Any) -> None:
        """Make `entity` (a timer, a subscription ...) a member."""
        self.entities.add(weakref.ref(entity, self.entities.discard))

    def has_entity(self, entity: Any) -> bool:
        """True if `entity` is a member."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Any) -> bool:
        """True if the callback of `entity` may run now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Any) -> bool:
        """Note that the callback of `entity` is about to run; False forbids it."""
        raise NotImplementedError

    def ending_execution(self, entity: Any) -> None:
        """Note that the callback of `entity` has ended."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """Callback group without limits: its callbacks may run at the same time, also one beside itself."""

    def can_execute(self, entity: Any) -> bool:
        """Return True, for every `entity`."""
        return True

    def beginning_execution(self, entity: Any) -> bool:
        """Return True, for every `entity`."""
        return True

    def ending_execution(self, entity: Any) -> None:
        """Do nothing, for any `entity`."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """Callback group of which one callback runs at a time."""

    def __init__(self) -> None:
        super().__init__()
        # In place of a lock, whose two calls take half as long again: one thread takes what is in it, and puts it back.
        self._free = {True: True}
        if type(self) is MutuallyExclusiveCallbackGroup:
            self._acquire_ = functools.partial(self._free.pop, True)  # the argument is what is returned if it is taken
            self._release_ = functools.partial(self._free.setdefault, True, True)

    def can_execute(self, entity: Any) -> bool:
        """True if no callback of the group runs, that of `entity` or another."""
        return bool(self._free)

    def beginning_execution(self, entity: Any) -> bool:
        """Reserve the group for `entity`, whose callback is to run; False if another one runs."""
        return self._free.pop(True, False)

    def ending_execution(self, entity: Any) -> None:
        """Release the group, which `entity` had reserved, for the next callback."""
        if self._free:
            raise AssertionError("no callback of this group runs")  # as in rclpy
        self._free[True] = True
