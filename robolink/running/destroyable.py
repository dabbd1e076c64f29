"""Handles of entities, as in rclpy: a handle knows whether its owner is still in use, and nothing more.

In rclpy a handle holds what C has made. Here there is nothing of that kind; programs that write ``with node.handle:``
to be sure that it has not been destroyed get what they ask for.
"""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.exceptions import InvalidHandle, imported_as

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike

HandleT = TypeVar("HandleT", bound="Handle")


class Handle:
    """Weak reference to a node, publisher, subscription, service, client, timer or guard condition."""

    def __init__(self, owner: Destroyable) -> None:
        self._owner = weakref.ref(owner)
        self._kind = type(owner).__name__
        self.pointer = id(owner)
        """A number that no other handle in use has."""

    def __enter__(self: HandleT) -> HandleT:
        """Raise InvalidHandle, a RuntimeError, if the owner has been destroyed."""
        owner = self._owner()
        if owner is None or owner._destroyed:
            name = f"the {self._kind} of this handle"
            raise InvalidHandle(f"{name} has been destroyed") if owner is None else owner._gone_(name)
        return self

    def __exit__(self, *_: Any) -> None:
        """Do nothing: a handle in use does not put off the end of its owner."""


class Destroyable:
    """Base of all that can be destroyed, once and for all."""

    _destroyed = False

    def _check_(self, kind: str) -> None:
        """Raise InvalidHandle, a RuntimeError, if this `kind` of thing has been destroyed."""
        if self._destroyed:
            raise self._gone_(f"the {kind}")

    def _gone_(self, name: str) -> InvalidHandle:
        """Return the error for whoever uses this after its end; it says so if the context's end was that."""
        context = self._used_in_
        by = f": {imported_as()}.shutdown() ends all that nodes have" if context is not None and context.closed else ""
        return InvalidHandle(f"{name} has been destroyed{by}")

    @property
    def _used_in_(self) -> ContextLike | None:
        """The context that it belongs to, as far as that is known."""
        return None

    __handle: Handle | None = None

    @property
    def handle(self) -> Handle:
        """Handle as in rclpy: use it as a context manager to be sure that this has not been destroyed."""
        if self.__handle is None:
            self.__handle = Handle(self)
        return self.__handle
