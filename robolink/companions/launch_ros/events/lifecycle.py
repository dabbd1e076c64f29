"""Events about the lifecycle of nodes (`launch_ros.events.lifecycle`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.companions.launch.bases import Event

__all__ = [
    "ChangeState",
    "StateTransition",
    "matches_node_name",
]


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
    wanted = full_name(node_name)
    return lambda action: getattr(action, "expanded_name", None) == wanted


def full_name(node_name: str) -> str:
    """Return `node_name` with a slash in front."""
    return node_name if node_name.startswith("/") else f"/{node_name}"
