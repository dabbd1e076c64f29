"""Actions about containers and the components in them (`launch_ros.actions`)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.launch.ros.launch.bases import Action, LaunchArgumentError, SomeSubstitutionsType
from robolink.launch.ros.launch_ros.descriptions import ComposableNode
from robolink.launch.ros.launch_ros.node import Node


class ComposableNodeContainer(Node):
    """Process of C++ that loads nodes as plugins.

    Args:
        name: Name of the container; it must be given.
        namespace: Its namespace.
        composable_node_descriptions: The nodes in it.
        **kwargs: Those of Node.
    """

    def __init__(
        self,
        *,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        composable_node_descriptions: Iterable[ComposableNode] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        if self.requested_name is None:
            raise LaunchArgumentError("ComposableNodeContainer needs name=...")
        self.composable_node_descriptions = list(composable_node_descriptions or ())


class LoadComposableNodes(Action):
    """Load nodes of C++ into a container that runs.

    Args:
        composable_node_descriptions: The nodes.
        target_container: The container, or its name.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[ComposableNode],
        target_container: SomeSubstitutionsType | ComposableNodeContainer,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.composable_node_descriptions = list(composable_node_descriptions)
        self.target_container = target_container
