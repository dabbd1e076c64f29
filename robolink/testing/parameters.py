"""Reads and sets the parameters of a system's nodes: of those in this process directly, of others by their services."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.exceptions import (
    InvalidParameterValueException,
    NotFoundError,
    ParameterNotDeclaredException,
)
from robolink.parameter import Parameter, parameter_value_to_python
from robolink.parameter_client import AsyncParameterClient
from robolink.parameter_rules import WrittenParameter

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.task import Future
    from robolink.testing.observing import Observing


def value_of(system: Observing, node: str, name: str, within: float) -> Any:
    """Give the value of a parameter of the node with this full name."""
    own = _node_here(system, node)
    if own is not None:
        return own.get_parameter(name).value
    client = _client(system, node, within)
    answer = _answer(system, client.get_parameters([name]), within)
    value = parameter_value_to_python(answer.values[0]) if answer.values else None
    if value is None:
        names = _answer(system, client.list_parameters(), within).result.names
        if name not in names:
            raise ParameterNotDeclaredException(name, known=names)
    return value


def set_value(system: Observing, node: str, name: str, value: Any, within: float) -> None:
    """Set a parameter of the node with this full name. An integer serves for a parameter that is a double."""
    own, before = _node_here(system, node), value_of(system, node, name, within)
    asked = WrittenParameter(name, value=value).as_type(Parameter(name, value=before).type_)
    if own is not None:
        result = own.set_parameters([asked])[0]
    else:
        result = _answer(system, _client(system, node, within).set_parameters([asked]), within).results[0]
    if not result.successful:
        raise InvalidParameterValueException(f"{name} of {node}", value, result.reason)


def _client(system: Observing, node: str, within: float) -> AsyncParameterClient:
    client = AsyncParameterClient(system.node, node)
    system.wait_until(client.services_are_ready, within)
    return client


def _answer(system: Observing, future: Future[Any], within: float) -> Any:
    return system.result(future, within)


def _node_here(system: Observing, node: str) -> Node | None:
    """Give the node if it lives in this process, None if another process has it. Raises NotFoundError for neither."""
    for each in system.nodes_here():
        if each.get_fully_qualified_name() == node:
            return each
    if node not in system.nodes:
        raise NotFoundError("node", node, system.nodes, "this system")
    return None
