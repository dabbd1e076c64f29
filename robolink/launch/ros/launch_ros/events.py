"""Events of nodes with a lifecycle, and reactions to them (`launch_ros.events`, `launch_ros.event_handlers`)."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from robolink.launch.ros.launch.bases import Event, EventHandler, SomeEntitiesType

__all__ = [
    "ChangeState",
    "OnStateTransition",
    "StateTransition",
    "lifecycle",
    "matchers",
    "matches_node_name",
]

lifecycle = matchers = sys.modules[__name__]
"""Modules of their own in ROS 2: here their names are in this file, too."""


class ChangeState(Event):
    """Nodes with a lifecycle are to make a transition.

    Args:
        lifecycle_node_matcher: Function that decides whether the node of an action is meant.
        transition_id: The transition (`lifecycle_msgs.msg.Transition`).
    """

    name = "launch_ros.events.lifecycle.ChangeState"

    def __init__(self, *, lifecycle_node_matcher: Callable[[Any], bool], transition_id: int) -> None:
        self.lifecycle_node_matcher, self.transition_id = lifecycle_node_matcher, transition_id
        self.node_name = ""
        """Full name of the node, where no action of this launch started it."""


class StateTransition(Event):
    """A node with a lifecycle has made a transition.

    Args:
        action: The action that started the node.
        msg: The message (`lifecycle_msgs.msg.TransitionEvent`).
    """

    name = "launch_ros.events.lifecycle.StateTransition"

    def __init__(self, *, action: Any, msg: Any) -> None:
        self.action, self.msg, self.timestamp = action, msg, msg.timestamp
        self.transition = msg.transition.label
        self.start_state, self.goal_state = msg.start_state.label, msg.goal_state.label


def matches_node_name(node_name: str) -> Callable[[Any], bool]:
    """Return a function that is true for the action whose node has the full name `node_name`."""
    expected = full_name(node_name)
    return lambda action: getattr(action, "node_name", None) == expected


def full_name(node_name: str) -> str:
    """Return `node_name` with a slash in front."""
    return node_name if node_name.startswith("/") else f"/{node_name}"


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
        expected = {"transition": transition, "start_state": start_state, "goal_state": goal_state}

        def is_meant(event: Event) -> bool:
            if not isinstance(event, StateTransition) or target_lifecycle_node not in (None, event.action):
                return False
            return all(label is None or getattr(event, name) == label for name, label in expected.items())

        super().__init__(matcher=matcher or is_meant, entities=entities, **kwargs)
