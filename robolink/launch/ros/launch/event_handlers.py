"""Reactions to what processes do and to the end of a launch (`launch.event_handlers`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from robolink.launch.ros.launch.bases import (
    Action,
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    entities_in,
)
from robolink.launch.ros.launch.events import ExecutionComplete, ProcessExited, ProcessIO, ProcessStarted, Shutdown

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


Target: TypeAlias = "Action | Callable[[Any], bool] | None"
Reaction: TypeAlias = "SomeEntitiesType | Callable[..., SomeEntitiesType | None]"


class _Reacting(BaseEventHandler):
    """Reaction by entities, or by a function of the event and the context that returns them."""

    _reaction: Reaction

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description for people, and the entities that follow, as far as they are known."""
        return type(self).__name__, [] if callable(self._reaction) else entities_in(self._reaction)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the entities that follow `event` in `context`."""
        super().handle(event, context)
        return self._reaction(event, context) if callable(self._reaction) else self._reaction


class OnActionEventBase(_Reacting):
    """Reaction to the events of one kind about an action.

    Args:
        action_matcher: The action, or a function that decides; None is any.
        on_event: What follows: entities, or a function of the event and the context that returns them.
        target_event_cls: Class of the events.
        target_action_cls: Class of the actions.
        handle_once: True ends the reaction with the first event.
    """

    def __init__(
        self,
        *,
        action_matcher: Target,
        on_event: Reaction,
        target_event_cls: type[Event],
        target_action_cls: type[Action] = Action,
        handle_once: bool = False,
    ) -> None:
        self._target, self._kind, self._reaction = action_matcher, target_event_cls, on_event
        super().__init__(matcher=self._is_meant, handle_once=handle_once)

    def _is_meant(self, event: Event) -> bool:
        if not isinstance(event, self._kind):
            return False
        action = getattr(event, "action", None)
        if self._target is None or isinstance(self._target, Action):
            return self._target is None or action is self._target
        return bool(self._target(action))


class OnProcessStart(OnActionEventBase):
    """Reaction to the start of a process.

    Args:
        target_action: The action that starts it, or a function that decides; None is any.
        on_start: What follows: entities, or a function of the event and the context.
        **kwargs: `handle_once`.
    """

    def __init__(self, *, target_action: Target = None, on_start: Reaction, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_start, target_event_cls=ProcessStarted, **kwargs)


class OnProcessExit(OnActionEventBase):
    """Reaction to the end of a process.

    Args:
        target_action: The action that started it, or a function that decides; None is any.
        on_exit: What follows: entities, or a function of the event and the context.
        **kwargs: `handle_once`.
    """

    def __init__(self, *, target_action: Target = None, on_exit: Reaction, **kwargs: Any) -> None:
        super().__init__(action_matcher=target_action, on_event=on_exit, target_event_cls=ProcessExited, **kwargs)


class OnExecutionComplete(OnActionEventBase):
    """Reaction to the end of an action that is not a process.

    Args:
        target_action: The action, or a function that decides; None is any.
        on_completion: What follows: entities, or a function of the event and the context.
        **kwargs: `handle_once`.
    """

    def __init__(self, *, target_action: Target = None, on_completion: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action, on_event=on_completion, target_event_cls=ExecutionComplete, **kwargs
        )


class OnProcessIO(OnActionEventBase):
    """Reaction to the lines of a process.

    Args:
        target_action: The action that starts it, or a function that decides; None is any.
        on_stdin: Function of an event of its input.
        on_stdout: Function of an event of its output.
        on_stderr: Function of an event of its errors; robolink's launcher reads both as output.
        **kwargs: `handle_once`.
    """

    def __init__(
        self,
        *,
        target_action: Target = None,
        on_stdin: Callable[[Any], SomeEntitiesType | None] | None = None,
        on_stdout: Callable[[Any], SomeEntitiesType | None] | None = None,
        on_stderr: Callable[[Any], SomeEntitiesType | None] | None = None,
        **kwargs: Any,
    ) -> None:
        self._by_fd = {0: on_stdin, 1: on_stdout, 2: on_stderr}
        super().__init__(action_matcher=target_action, on_event=self._heard, target_event_cls=ProcessIO, **kwargs)

    def _heard(self, event: ProcessIO, _: LaunchContext) -> SomeEntitiesType | None:
        reaction = self._by_fd.get(event.fd)
        return None if reaction is None else reaction(event)


class OnShutdown(_Reacting):
    """Reaction to the end of the launch, before its processes end.

    Args:
        on_shutdown: What follows: entities, or a function of the event and the context.
        handle_once: True ends the reaction with the first event.
    """

    def __init__(self, *, on_shutdown: Reaction, handle_once: bool = False) -> None:
        self._reaction = on_shutdown
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), handle_once=handle_once)
