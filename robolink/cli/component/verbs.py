"""The verbs of components: containers and their services, offered types, and a container for one node."""

from __future__ import annotations

import sys
import threading
import time
import uuid
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from robolink.arguments.parameter_file import parse_parameter_value
from robolink.cli.shared.graph import absolute
from robolink.cli.shared.output import say, tell
from robolink.cli.shared.session import call_all, looking
from robolink.companions.ament_index import (
    get_package_prefix,
    get_packages_with_prefixes,
    get_resource,
    get_resources,
)
from robolink.context import Context
from robolink.exceptions import NotFoundError, RobolinkError
from robolink.interfaces.composition_interfaces.srv import ListNodes, LoadNode, UnloadNode
from robolink.interfaces.rcl_interfaces.msg import Parameter as ParameterMsg
from robolink.parameter import Parameter
from robolink.system import clocks
from robolink.utilities import try_shutdown
from robolink.wire import EndpointKind
from robolink.workspace import (
    NodeLoadError,
    NodeSource,
    find_executable,
    find_package,
    load_node,
    named_executables,
    own_process_needed,
    sources_of,
)

SERVICES = "/_container"
"""Part of the names of a container's services, after that of its node."""
LISTING = f"{SERVICES}/list_nodes"
ANSWER_WITHIN, LOAD_WITHIN = 5.0, 60.0
"""Timeouts of an answer, in seconds: a node that is loaded may open a device."""


class ComponentError(RobolinkError, RuntimeError):
    """A container does not answer, or refuses."""


class Requested(NamedTuple):
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


def load(container: str, requested: Requested) -> LoadNode.Response:
    """Load a component into a running container. Raises ComponentError with the container's reason if that fails."""
    request = LoadNode.Request(
        package_name=requested.package,
        plugin_name=requested.plugin,
        node_name=requested.name,
        node_namespace=requested.namespace,
        log_level=requested.log_level,
        remap_rules=list(requested.remap_rules),
        parameters=[_parameter(each) for each in requested.parameters],
        extra_arguments=[_parameter(each) for each in requested.extra_arguments],
    )
    answer: LoadNode.Response = _ask(container, LoadNode, "load_node", request)
    if not answer.success:
        raise ComponentError(f"{container} did not load {requested.package} {requested.plugin}: {answer.error_message}")
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


RESOURCE = "rclcpp_components"
"""Type of the resource by which packages in C++ register theirs, a line ``TYPE;LIBRARY`` for each."""


def offered(package: str = "") -> Iterator[tuple[str, list[str]]]:
    """Yield the packages that offer components, by name, with these; only `package`, if one is named.

    Raises PackageNotFoundError for a package that is not there.
    """
    if package:
        get_package_prefix(package)  # raises
    registered = get_resources(RESOURCE)
    for name in [package] if package else sorted(get_packages_with_prefixes()):
        found = [each for source in _sources(name) for each in _in_python(source)]
        if name in registered:
            lines = get_resource(RESOURCE, name)[0].splitlines()
            found += [each.partition(";")[0] for each in lines if each]
        if found:
            yield name, sorted(found)


def _sources(package: str) -> list[NodeSource]:
    folder = find_package(package)
    own = [] if folder is None else named_executables(folder)
    return [*own, *sources_of(package).values()]


def _in_python(source: NodeSource) -> Iterator[str]:
    """Yield the name of an executable that is a Node class: only such a one can share a process."""
    try:
        if not own_process_needed(source):
            yield source.name
    except NodeLoadError:  # a file with a mistake
        return


BEGINS_WITHIN = 20.0
"""Timeout of the container's announcement, in s."""


def run(requested: Requested, container: str = "") -> None:
    """Run a container, and a component in it, until Ctrl-C.

    Args:
        requested: The component.
        container: Name of the container's node; '' takes one that nobody has.

    Raises:
        RobolinkError: if the component cannot be loaded.
    """
    name = container or f"standalone_container_{uuid.uuid4().hex[:12]}"
    failures: list[RobolinkError] = []
    thread = threading.Thread(target=_load, args=(name, requested, failures), name="loading", daemon=True)
    serve: Any = load_node(find_executable("rclcpp_components", "component_container"))
    sys.argv = ["component_container", "--ros-args", "-r", f"__node:={name}"]
    thread.start()
    serve()
    if failures:
        raise failures[0]


def _load(name: str, requested: Requested, failures: list[RobolinkError]) -> None:
    """Load the component as soon as the container is there; end the container if that fails."""
    try:
        deadline = clocks.monotonic() + BEGINS_WITHIN
        while f"/{name}" not in containers() and clocks.monotonic() < deadline:
            time.sleep(0.05)
        answer = load(f"/{name}", requested)
        say(f"Loaded component {answer.unique_id} into '{name}' container node as '{answer.full_node_name}'")
    except RobolinkError as error:
        failures.append(error)
        try_shutdown()
