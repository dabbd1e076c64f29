"""What a managed node tells of its transitions: its publishers, and whatever else a program makes."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

from robolink.lifecycle.state_machine import TransitionCallbackReturn as TransitionCallbackReturn

if TYPE_CHECKING:
    from robolink.lifecycle.node import LifecycleState

SUCCESS = TransitionCallbackReturn.SUCCESS


class ManagedEntity:
    """Something that goes through its node's transitions; each method is given the state before.

    What is not overridden succeeds. FAILURE leads back to the state before, ERROR to `on_error` of the node.
    """

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Get ready to be activated."""
        return SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo what `on_configure` did."""
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Give up everything: the node will do nothing more."""
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Begin to work."""
        return SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working, but stay ready."""
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Tidy up after an error: SUCCESS makes the node unconfigured, anything else ends it."""
        return SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """A managed entity that knows whether it is active, and no more."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Be active from now on."""
        self._enabled = True
        return SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Be active no longer."""
        self._enabled = False
        return SUCCESS

    @property
    def is_activated(self) -> bool:
        """Whether it is active."""
        return self._enabled

    @staticmethod
    @overload
    def when_enabled(
        wrapped: None = None, *, when_not_enabled: Callable[..., None] | None = None
    ) -> Callable[[Callable[..., None]], Callable[..., None]]: ...

    @staticmethod
    @overload
    def when_enabled(
        wrapped: Callable[..., None], *, when_not_enabled: Callable[..., None] | None = None
    ) -> Callable[..., None]: ...

    @staticmethod
    def when_enabled(
        wrapped: Callable[..., None] | None = None, *, when_not_enabled: Callable[..., None] | None = None
    ) -> Any:
        """Decorate a method that does nothing while the entity is inactive; then `when_not_enabled()` is called."""

        def decorate(method: Callable[..., None]) -> Callable[..., None]:
            @functools.wraps(method)
            def run_when_enabled(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return run_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
