"""Client of containers' services, for the commands of `robolink component`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.cli.shared.graph import absolute
from robolink.cli.shared.output import tell
from robolink.cli.shared.session import call_all, looking
from robolink.context import Context
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.interfaces.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.parameter import Parameter
from robolink.wire import EndpointKind

SERVICES = "/_container"
"""Part of the names of a container's services, after that of its node."""
LISTING = f"{SERVICES}/list_nodes"
ANSWER_WITHIN, LOAD_WITHIN = 5.0, 60.0
"""Timeouts of an answer, in seconds: a node that is loaded may open a device."""


class ComponentError(RobolinkError, RuntimeError):
    """A container does not answer, or refuses."""


class Wanted(NamedTuple):
    """A component to load, as `robolink component load` was told of it."""

    package: str
    plugin: str
    name: str = ""
    namespace: str = ""
    log_level: int = 0
    remap_rules: Sequence[str] = ()
    parameters: Sequence[str] = ()
    extra_arguments: Sequence[str] = ()


def containers() -> list[str]:
    """Return the full names of the containers that run, sorted."""
    with looking() as context:
        return _containers(context)


def listed(container: str = "") -> list[tuple[str, list[tuple[int, str]]]]:
    """Return the containers, each with its nodes' numbers and names; only `container`, if one is named.

    One that does not answer is told of, and left out, unless it was named. Raises NotFoundError for an unknown name.
    """
    with looking() as context:
        names = [_known(context, container)] if container else _containers(context)
        requests = {f"{name}{LISTING}": ListNodes.Request() for name in names}
        answers = call_all(context, ListNodes, requests, ANSWER_WITHIN, _no_answer)
    found = []
    for name, answer in zip(names, answers.values(), strict=True):
        if not isinstance(answer, RobolinkError):
            found.append((name, list(zip(answer.unique_ids, answer.full_node_names, strict=False))))
        elif container:
            raise answer
        else:
            tell(f"robolink: {answer}")
    return found


def load(container: str, wanted: Wanted) -> LoadNode.Response:
    """Load a component into a running container. Raises ComponentError with the container's reason if that fails."""
    request = LoadNode.Request(
        package_name=wanted.package,
        plugin_name=wanted.plugin,
        node_name=wanted.name,
        node_namespace=wanted.namespace,
        log_level=wanted.log_level,
        remap_rules=list(wanted.remap_rules),
        parameters=[_parameter(each) for each in wanted.parameters],
        extra_arguments=[_parameter(each) for each in wanted.extra_arguments],
    )
    answer: LoadNode.Response = _ask(container, LoadNode, "load_node", request)
    if not answer.success:
        raise ComponentError(f"{container} did not load {wanted.package} {wanted.plugin}: {answer.error_message}")
    return answer


def unload(container: str, number: int) -> None:
    """Take the node of a number out of a container. Raises ComponentError with its reason if that fails."""
    answer = _ask(container, UnloadNode, "unload_node", UnloadNode.Request(unique_id=number))
    if not answer.success:
        raise ComponentError(f"{container} did not unload {number}: {answer.error_message}")


def _ask(container: str, srv_type: type[Any], service: str, request: Any) -> Any:
    with looking() as context:
        name = f"{_known(context, container)}{SERVICES}/{service}"
        answer = call_all(context, srv_type, {name: request}, LOAD_WITHIN, _no_answer)[name]
    if isinstance(answer, RobolinkError):
        raise answer
    return answer


def _containers(context: Context) -> list[str]:
    served = context.graph.endpoints(EndpointKind.SERVICE)
    return sorted({each.name.removesuffix(LISTING) for each in served if each.name.endswith(LISTING)})


def _known(context: Context, container: str) -> str:
    name, known = absolute(container), _containers(context)
    if name not in known:
        raise NotFoundError("container", container[:200], known, "this domain: 'robolink component list' shows them")
    return name


def _no_answer(service: str) -> RobolinkError:
    return ComponentError(f"no answer in time from {service}: does the container spin?")


def _parameter(text: str) -> ParameterMsg:
    name, assigned, value = text.partition(":=")
    if not (name and assigned):
        raise ComponentError(f"'{text[:100]}' is not a parameter: expected NAME:=VALUE")
    return Parameter(name, value=parse_parameter_value(value)).to_parameter_msg()
