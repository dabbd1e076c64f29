"""Reactions to the lifecycle of nodes (`launch_ros.event_handlers`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.companions.launch.bases import Event, EventHandler, SomeEntitiesType
from robolink.companions.launch_ros.events.lifecycle import StateTransition

__all__ = [
    "OnStateTransition",
]


class OnStateTransition(EventHandler):
    """Reaction to a transition of a node with a lifecycle.

    Args:
        entities: What follows.
        target_lifecycle_node: The node; None is any.
        transition: Label of the transition; None is any.
        start_state: Label of the state before; None is any.
        goal_state: Label of the state behind; None is any.
        matcher: Function that decides in place of these.
        **kwargs: `handle_once`.
    """

    def __init__(
        self,
        *,
        entities: SomeEntitiesType,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        matcher: Callable[[Event], bool] | None = None,
        **kwargs: Any,
    ) -> None:
        wanted = {"transition": transition, "start_state": start_state, "goal_state": goal_state}

        def is_meant(event: Event) -> bool:
            if not isinstance(event, StateTransition) or target_lifecycle_node not in (None, event.action):
                return False
            return all(label is None or getattr(event, name) == label for name, label in wanted.items())

        super().__init__(matcher=matcher or is_meant, entities=entities, **kwargs)
