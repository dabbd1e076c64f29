"""Actions about containers and the components in them (`launch_ros.actions`)."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.launch.ros.launch.bases import Action, LaunchArgumentError, LaunchContext, SomeSubstitutionsType
from robolink.launch.ros.launch.utilities import performed
from robolink.launch.ros.launch_ros.descriptions import ComposableNode
from robolink.launch.ros.launch_ros.node import Node
from robolink.launch.ros.launch_ros.settings import NAMESPACE, PARAMETERS, REMAPS
from robolink.launch.ros.launch_ros.utilities import (
    evaluate_parameters,
    make_namespace_absolute,
    normalize_parameters,
    prefix_namespace,
    to_parameters_list,
)

if TYPE_CHECKING:
    from robolink.interfaces.composition_interfaces.srv import LoadNode


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


def get_composable_node_load_request(
    composable_node_description: ComposableNode, context: LaunchContext
) -> LoadNode.Request | None:
    """Return the request that asks a container for a component; None if its condition is against it.

    Args:
        composable_node_description: The component.
        context: The context with whose values it is performed.

    Raises:
        LaunchError: for what cannot be performed, and for a value that no parameter can have.
    """
    from robolink.interfaces.composition_interfaces.srv import LoadNode  # late: classes of messages take their time

    described = composable_node_description
    condition = described.condition()
    if condition is not None and not condition.evaluate(context):
        return None
    own = None if described.node_namespace is None else performed(context, described.node_namespace)
    namespace = make_namespace_absolute(prefix_namespace(context.launch_configurations.get(NAMESPACE), own))
    request = LoadNode.Request()
    request.package_name = performed(context, described.package)
    request.plugin_name = performed(context, described.node_plugin)
    request.node_name = performed(context, described.node_name or "")
    request.node_namespace = namespace or ""
    pairs = list(context.launch_configurations.get(REMAPS, ()))
    pairs += [(performed(context, match), performed(context, new)) for match, new in described.remappings or ()]
    request.remap_rules = [f"{match}:={new}" for match, new in pairs]

    def messages(parameters: Iterable[Any]) -> list[Any]:
        evaluated = evaluate_parameters(context, parameters)
        return [
            each.to_parameter_msg() for each in to_parameters_list(context, request.node_name, namespace, evaluated)
        ]

    around = context.launch_configurations.get(PARAMETERS, ())
    set_before = normalize_parameters([dict([each]) if isinstance(each, tuple) else Path(each) for each in around])
    request.parameters = messages([*set_before, *(described.parameters or ())])
    request.extra_arguments = messages(described.extra_arguments or ())
    return request
