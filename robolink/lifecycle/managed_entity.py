"""Managed entities: publishers and other parts of a managed node that follow its transitions."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, overload

from robolink.lifecycle.state_machine import LifecycleState
from robolink.lifecycle.state_machine import TransitionCallbackReturn as TransitionCallbackReturn

SUCCESS = TransitionCallbackReturn.SUCCESS


class ManagedEntity:
    """Base class of what follows a node's transitions; each method gets the state before.

    A method that is not overridden succeeds. FAILURE leads back to the state before, ERROR to `on_error` of the node.
    """

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Prepare for activation; `state` is the one before."""
        return SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Undo `on_configure`; `state` is the one before."""
        return SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Release everything before the node's end; `state` is the one before."""
        return SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start to work; `state` is the one before."""
        return SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working, but stay configured; `state` is the one before."""
        return SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean up after an error; `state` is the one before. SUCCESS makes the node unconfigured, else it ends."""
        return SUCCESS


class SimpleManagedEntity(ManagedEntity):
    """A managed entity with a flag that it is active."""

    def __init__(self) -> None:
        self._enabled = False

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Set the flag; `state` is the one before."""
        self._enabled = True
        return SUCCESS

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clear the flag; `state` is the one before."""
        self._enabled = False
        return SUCCESS

    @property
    def is_activated(self) -> bool:
        """True while it is active."""
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
        """Decorate a method so that it does nothing while the entity is inactive.

        Args:
            wrapped: The method; None, as in ``@when_enabled(...)``, returns a decorator.
            when_not_enabled: Called without arguments instead of the method while the entity is inactive.
        """

        def decorate(method: Callable[..., None]) -> Callable[..., None]:
            @functools.wraps(method)
            def run_when_enabled(self: SimpleManagedEntity, *args: Any, **kwargs: Any) -> None:
                if self._enabled:
                    method(self, *args, **kwargs)
                elif when_not_enabled is not None:
                    when_not_enabled()

            return run_when_enabled

        return decorate if wrapped is None else decorate(wrapped)
