"""The handle that rclpy's entities have: it says whether its owner is still in use, and nothing more.

In rclpy a handle holds what C has made. Here there is nothing of that kind; programs that write ``with node.handle:``
to be sure that it has not been destroyed get what they ask for.
"""

from __future__ import annotations

import weakref
from typing import Any, TypeVar

from robolink.exceptions import InvalidHandle

HandleT = TypeVar("HandleT", bound="Handle")


class Handle:
    """Refers to a node, publisher, subscription, service, client, timer or guard condition, and keeps none alive."""

    def __init__(self, owner: Destroyable) -> None:
        self._owner = weakref.ref(owner)
        self._kind = type(owner).__name__
        self.pointer = id(owner)
        """A number that no other handle in use has."""

    def __enter__(self: HandleT) -> HandleT:
        """Raise InvalidHandle, a RuntimeError, if the owner has been destroyed."""
        owner = self._owner()
        if owner is None or owner._destroyed:
            raise InvalidHandle(f"cannot use the handle of a {self._kind} that has been destroyed")
        return self

    def __exit__(self, *_: Any) -> None:
        """Do nothing: a handle in use does not put off the end of its owner."""


class Destroyable:
    """What can be destroyed, once and for all."""

    _destroyed = False

    __handle: Handle | None = None

    @property
    def handle(self) -> Handle:
        """What stands for rclpy's handle: use it as a context manager to be sure that this has not been destroyed."""
        if self.__handle is None:
            self.__handle = Handle(self)
        return self.__handle
