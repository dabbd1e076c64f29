"""Look-up of types that are not installed here: a node that uses one describes it, and a class is built of that."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from robolink.exceptions import ExternalShutdownException, MessageError, NotFoundError, RobolinkError
from robolink.interfaces import find_announced
from robolink.message import Service, type_hash
from robolink.system.terminal import shown
from robolink.wire import NO_HASH, EndpointKind, EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node

ANSWER_WITHIN = 1.5
"""Timeout of one node's answer, in seconds."""
MOST_REQUESTED = 3
"""Most nodes that are asked."""
SERVICE = "get_type_description"
SERVICE_TYPE = "type_description_interfaces/srv/GetTypeDescription"
SERVICES = (EndpointKind.SERVICE, EndpointKind.CLIENT)


class TypeLookupError(RobolinkError, LookupError):
    """A type is not installed, or is another one here, and no node tells what it is."""


def type_of(context: Context, endpoint: EndpointToken) -> type[Any]:
    """Return the message or service class that an endpoint of the graph uses.

    That is the installed one if its hash is the endpoint's, or the endpoint (ROS 2 Humble's) states none. Otherwise
    the endpoint's node is asked at its service `~/get_type_description`, then other nodes that use the type; what
    they answer must have the endpoint's hash. Takes up to 1.5 s for each of at most three nodes.

    Args:
        context: Context whose network is asked.
        endpoint: Publisher, subscription, service or client, as the graph knows it.

    Raises:
        TypeLookupError: (a LookupError) if no node describes the type; the text says what to do.
        MessageError: (a ValueError) if a definition in the workspace is wrong.
        ExternalShutdownException: if the context ends meanwhile.
    """
    same = installed_type(endpoint)
    if same is not None:
        return same
    installed = _installed(endpoint.type_name)
    refusals = []
    for node_name, served in _nodes_with(context, endpoint):
        try:
            if not served:
                raise TypeLookupError(f"it does not serve {SERVICE}")
            return _ask(context, node_name, endpoint)
        except (RobolinkError, TimeoutError) as error:
            if not context.ok():  # Ctrl-C, which says nothing of the node
                raise ExternalShutdownException(f"{endpoint.name}: ended while its type was asked for") from error
            refusals.append(f"{node_name}: {shown(str(error), 300)}")
    raise TypeLookupError(_what_to_do(endpoint, installed, refusals))


def installed_type(endpoint: EndpointToken) -> type[Any] | None:
    """Return the installed class that `endpoint` uses; None if there is none of its name and hash.

    Raises MessageError (a ValueError) if a definition in the workspace is wrong.
    """
    installed = _installed(endpoint.type_name)
    if installed is not None and endpoint.type_hash in (NO_HASH, type_hash(installed)):
        return installed
    return None


def _installed(type_name: str) -> type[Any] | None:
    try:
        return find_announced(type_name)
    except NotFoundError:
        return None


def _nodes_with(context: Context, endpoint: EndpointToken) -> Iterator[tuple[str, bool]]:
    """Yield the endpoint's own node, then others that use the same type and serve descriptions; and whether they do."""
    tokens = context.graph.endpoints(*EndpointKind)
    serving = {each.name for each in tokens if each.kind is EndpointKind.SERVICE and each.type_name == SERVICE_TYPE}
    own = endpoint.full_node_name
    yield own, f"{own}/{SERVICE}" in serving
    named = [each for each in tokens if each.type_name == endpoint.type_name]
    same = [each for each in named if endpoint.type_hash in (NO_HASH, each.type_hash)]
    others = {each.full_node_name for each in same} - {own}
    for name in sorted(name for name in others if f"{name}/{SERVICE}" in serving)[: MOST_REQUESTED - 1]:
        yield name, True


def _ask(context: Context, node_name: str, endpoint: EndpointToken) -> type[Any]:
    """Ask a node to describe a type, and build a class of that. Raises RobolinkError or TimeoutError if that fails."""
    from robolink.interfaces.type_description_interfaces.srv import GetTypeDescription
    from robolink.message.building import checked_class, class_of_description
    from robolink.message.description import from_message

    stated = "" if endpoint.type_hash == NO_HASH else endpoint.type_hash
    request = GetTypeDescription.Request(type_name=endpoint.type_name, type_hash=stated, include_type_sources=False)
    with _asking_node(context) as node:
        client = node.create_client(GetTypeDescription, f"{node_name}/{SERVICE}")
        answer = client.try_call(request, timeout_sec=ANSWER_WITHIN)
    if not answer.successful:
        # As of services over DDS, which announces the hashes of their requests and replies: rcl finds types by hash.
        why = "" if stated else " without the type's hash, which is not announced"
        raise TypeLookupError(f"refused{why}: {answer.failure_reason or 'no reason given'}")
    description = from_message(answer.type_description)
    if description.type_name != endpoint.type_name:
        raise MessageError(f"it described {description.type_name} instead")
    found = checked_class(description, stated) if stated else class_of_description(description)
    if issubclass(found, Service) != (endpoint.kind in SERVICES):
        raise MessageError("it described a service as a message, or a message as a service")
    return found


def _asking_node(context: Context) -> Node:
    from robolink.node import Node
    from robolink.parameter import Parameter

    return Node(
        f"_robolink_types_{os.getpid()}",
        context=context,
        use_global_arguments=False,
        enable_rosout=False,
        start_parameter_services=False,
        parameter_overrides=[Parameter("start_type_description_service", value=False)],
    )


def _what_to_do(endpoint: EndpointToken, installed: type[Any] | None, refusals: list[str]) -> str:
    package, *_, short = endpoint.type_name.split("/")
    kind = endpoint.type_name.split("/")[1]
    file = f"interfaces/{package}/{kind}/{short.partition('_')[0]}.{kind}"
    tried = f"no node tells what it is ({'; '.join(refusals)})"
    if installed is None:
        missing = f"{endpoint.name} has the type {endpoint.type_name}, which is not installed"
        return f"{missing}, and {tried}: put {file} into your workspace"
    hashes = f"{_short(endpoint.type_hash)} there, {_short(type_hash(installed))} here"
    other = f"{endpoint.name} has another {endpoint.type_name} than is installed ({hashes})"
    return f"{other}, and {tried}: bring {file} up to date"


def _short(hash_text: str) -> str:
    return hash_text[:15]
