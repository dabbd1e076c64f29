"""Reactions to what processes do and to the end of a launch (`launch.event_handlers`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

from robolink.launch.ros.launch.bases import (
    Action,
    BaseEventHandler,
    Event,
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    check_actions,
    entities_in,
)
from robolink.launch.ros.launch.events import ExecutionComplete, IncludeLaunchDescription, Shutdown
from robolink.launch.ros.launch.process_events import ProcessExited, ProcessIO, ProcessStarted
from robolink.launch.ros.launch.processes import ExecuteLocal

__all__ = [
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnIncludeLaunchDescription",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
    "event_named",
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
        is_matcher = isinstance(action_matcher, target_action_cls) or callable(action_matcher)
        if action_matcher is not None and not is_matcher:
            kind, expected = type(action_matcher).__name__, target_action_cls.__name__
            raise LaunchArgumentError(
                f"{type(self).__name__} reacts to an {expected} or what a function means, got {kind}"
            )
        if not callable(on_event):
            check_actions(on_event, type(self).__name__)
        self._target, self._kind, self._target_kind = action_matcher, target_event_cls, target_action_cls
        self._reaction = on_event if callable(on_event) else entities_in(on_event)
        super().__init__(matcher=self._is_meant, handle_once=handle_once)

    @property
    def handler_description(self) -> str:
        """Description of what is done, for people."""
        return str(self._reaction) if callable(self._reaction) else "<actions>"

    @property
    def matcher_description(self) -> str:
        """Description of the events that are meant, for people."""
        which = "" if self._target is None else f" and {self._target_kind.__name__}(event.action)"
        return f"event == {self._kind.__name__}{which}"

    def _is_meant(self, event: Event) -> bool:
        if not isinstance(event, self._kind):
            return False
        action = getattr(event, "action", None)
        if callable(self._target):
            return bool(self._target(action))
        return self._target is None or action is self._target


class OnProcessStart(OnActionEventBase):
    """Reaction to the start of a process.

    Args:
        target_action: The action that starts it, or a function that decides; None is any.
        on_start: What follows: entities, or a function of the event and the context.
        **kwargs: `handle_once`.
    """

    def __init__(self, *, target_action: Target = None, on_start: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )


class OnProcessExit(OnActionEventBase):
    """Reaction to the end of a process.

    Args:
        target_action: The action that started it, or a function that decides; None is any.
        on_exit: What follows: entities, or a function of the event and the context.
        **kwargs: `handle_once`.
    """

    def __init__(self, *, target_action: Target = None, on_exit: Reaction, **kwargs: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )


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
        super().__init__(
            action_matcher=target_action,
            on_event=self._heard,
            target_event_cls=ProcessIO,
            target_action_cls=ExecuteLocal,
            **kwargs,
        )

    def _heard(self, event: ProcessIO, _: LaunchContext) -> SomeEntitiesType | None:
        reaction = self._by_fd.get(event.fd)
        return None if reaction is None else reaction(event)


class OnIncludeLaunchDescription(BaseEventHandler):
    """Reaction to the request to carry out a launch description: that follows.

    The launcher does so by itself; this is for a program that does it at a time of its own.

    Args:
        **kwargs: `handle_once`.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, IncludeLaunchDescription), **kwargs)

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        """Return the description of `event`."""
        super().handle(event, context)
        assert isinstance(event, IncludeLaunchDescription)
        found: LaunchDescriptionEntity = event.launch_description
        return found

    @property
    def handler_description(self) -> str:
        """Description of what is done, for people."""
        return "the launch description of the event"

    @property
    def matcher_description(self) -> str:
        """Description of the events that are meant, for people."""
        return "event is a launch.events.IncludeLaunchDescription"


def event_named(name: str) -> Callable[[Event], bool]:
    """Return a function that is true for an event called `name`, such as `launch.events.Shutdown`."""
    return lambda event: event.name == name


class OnShutdown(_Reacting):
    """Reaction to the end of the launch, before its processes end.

    Args:
        on_shutdown: What follows: entities, or a function of the event and the context.
        handle_once: True ends the reaction with the first event.
    """

    def __init__(self, *, on_shutdown: Reaction, handle_once: bool = False) -> None:
        self._reaction = on_shutdown
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), handle_once=handle_once)
