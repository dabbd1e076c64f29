"""Actions on events: timers, event handlers, and the end of the launch."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import (
    Action,
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.companions.launch.events import Shutdown as ShutdownEvent
from robolink.companions.launch.utilities import performed


class TimerAction(Action):
    """Actions for later.

    Args:
        period: Time until then, in seconds.
        actions: The actions.
        cancel_on_shutdown: Of no effect here: nothing is started once the launch ends.
        **kwargs: `condition`.
    """

    lasts = True

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[LaunchDescriptionEntity],
        cancel_on_shutdown: bool | SomeSubstitutionsType = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period, self.actions = period, list(actions)
        self.is_canceled = False

    def seconds(self, context: LaunchContext) -> float:
        """Return the period with the values of `context`; raises LaunchError for one that is no time."""
        text = str(self.period) if isinstance(self.period, (int, float)) else performed(context, self.period)
        try:
            seconds = float(text)
        except ValueError:
            raise LaunchError(f"a timer's period is a number of seconds, got '{text:.60}'") from None
        if not 0.0 <= seconds < 1e9:
            raise LaunchError(f"a timer's period is a number of seconds from 0 on, got {text:.60}")
        return seconds

    def cancel(self) -> None:
        """Let it do nothing when its time comes."""
        self.is_canceled = True

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return nothing: its actions come later."""
        return []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return its actions."""
        return [(f"after {self.period} s", self.actions)]


class RegisterEventHandler(Action):
    """React to events from here on.

    Args:
        event_handler: The reaction.
        **kwargs: `condition`.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register the handler in `context`."""
        context.register_event_handler(self.event_handler)

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        """Return what follows the event, as far as it is known."""
        return [self.event_handler.describe()]


class UnregisterEventHandler(Action):
    """React no longer.

    Args:
        event_handler: The reaction.
        **kwargs: `condition`.
    """

    def __init__(self, event_handler: BaseEventHandler, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Remove the handler from `context`."""
        context.unregister_event_handler(self.event_handler)


class EmitEvent(Action):
    """Emit an event.

    Args:
        event: The event.
        **kwargs: `condition`.
    """

    def __init__(self, *, event: Event, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        """Emit it in `context`."""
        context.emit_event_sync(self.event)


class Shutdown(EmitEvent):
    """End the launch.

    Args:
        reason: Reason for people.
        **kwargs: `condition`; robolink ignores the event and the context that a handler would pass.
    """

    def __init__(self, *, reason: str = "reason not given", **kwargs: Any) -> None:
        super().__init__(event=ShutdownEvent(reason=reason), **kwargs)
