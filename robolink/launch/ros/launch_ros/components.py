"""Actions about containers and the components in them (`launch_ros.actions`)."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.launch.ros.launch.bases import Action, LaunchArgumentError, LaunchContext, SomeSubstitutionsType
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.utilities import performed
from robolink.launch.ros.launch_ros.descriptions import ComposableNode
from robolink.launch.ros.launch_ros.node import Node, note_name
from robolink.launch.ros.launch_ros.settings import NAMESPACE, PARAMETERS, REMAPS
from robolink.launch.ros.launch_ros.utilities import (
    evaluate_parameters,
    make_namespace_absolute,
    normalize_parameters,
    prefix_namespace,
    to_parameters_list,
)

if TYPE_CHECKING:
    from robolink.client import Client
    from robolink.interfaces.composition_interfaces.srv import LoadNode
    from robolink.task import Future


@inner_names("composable_node_descriptions")
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


@inner_names("composable_node_descriptions", "target_container")
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

    def ask(self, context: LaunchContext, container: str) -> None:
        """Ask a container that this launch has not started for the components, one after the other, on a thread.

        A LaunchService goes on until it has answered, or until it ends itself.

        Args:
            context: Context of a LaunchService.
            container: Full name of the container.
        """
        requests = [get_composable_node_load_request(each, context) for each in self.composable_node_descriptions]
        known = [each for each in requests if each is not None]
        if not known or context.asyncio_loop is None:
            return
        from robolink.interfaces.composition_interfaces.srv import LoadNode
        from robolink.launch.ros.launch_ros.ros_adapters import get_ros_node

        client = get_ros_node(context).create_client(LoadNode, f"{container}/_container/load_node")
        loading = context.asyncio_loop.run_in_executor(None, _load, context, client, container, known)
        context.add_completion_future(loading)


LOOK_AGAIN = 0.2
"""Interval between two looks whether the launch has ended, in s."""


def _load(context: LaunchContext, client: Client, container: str, requests: Sequence[LoadNode.Request]) -> None:
    """Load components into a container, as long as the launch goes on."""
    from robolink.launch.ros.launch.logging import get_logger  # its handlers take long to import

    logger = get_logger("launch_ros.actions.load_composable_nodes")
    for request in requests:
        while not client.wait_for_service(timeout_sec=LOOK_AGAIN):
            if context.is_shutdown:
                logger.warning(f"Abandoning wait for the '{client.srv_name}' service, due to shutdown.")
                return
        future = client.call_async(request)
        if not _has_ended(future, context):
            logger.warning(f"Abandoning wait for the '{client.srv_name}' service response, due to shutdown.")
            return
        _note_answer(context, container, request, future.result(), logger)


def _has_ended(future: Future[Any], context: LaunchContext) -> bool:
    """Wait until a call is answered, True, or until the launch ends, False, and cancel it then."""
    answered = threading.Event()
    future.add_done_callback(lambda _: answered.set())
    while not answered.wait(LOOK_AGAIN):
        if context.is_shutdown:
            future.cancel()
            return False
    return True


def _note_answer(
    context: LaunchContext, container: str, request: LoadNode.Request, response: LoadNode.Response | None, logger: Any
) -> None:
    name = (response.full_node_name if response is not None else "") or request.node_name
    if response is None or not response.success:
        why = "no answer" if response is None else response.error_message
        what = f"node '{name}' of type '{request.plugin_name}' in container '{container}'"
        logger.error(f"Failed to load {what}: {why}")
        return
    note_name(context, name)
    logger.info(f"Loaded node '{name}' in container '{container}'")


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
