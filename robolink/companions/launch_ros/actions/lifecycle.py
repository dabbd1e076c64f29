"""Nodes with a lifecycle, and the transitions that a launch file asks of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import Action, SomeSubstitutionsType
from robolink.companions.launch_ros.actions.node import Node


class LifecycleNode(Node):
    """Start a node with a lifecycle.

    Args:
        name: Name of the node.
        namespace: Namespace of the node.
        autostart: True configures and activates it once it is there.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType,
        namespace: SomeSubstitutionsType,
        autostart: bool | SomeSubstitutionsType = False,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.autostart = autostart


class LifecycleTransition(Action):
    """Ask nodes with a lifecycle for transitions.

    Args:
        lifecycle_node_names: Full names of the nodes.
        transition_ids: The transitions, in their order (`lifecycle_msgs.msg.Transition`).
        **kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeSubstitutionsType],
        transition_ids: Iterable[int | SomeSubstitutionsType],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.lifecycle_node_names, self.transition_ids = list(lifecycle_node_names), list(transition_ids)
