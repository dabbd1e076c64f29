"""Parameters of a system's nodes: of those in this process directly, of others by their services."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.exceptions import (
    InvalidParameterValueException,
    NotFoundError,
    ParameterNotDeclaredException,
    nearest,
)
from robolink.parameter import Parameter, parameter_value_to_python
from robolink.parameter_client import AsyncParameterClient
from robolink.parameters.rules import WrittenParameter
from robolink.simulate.nodes import is_among
from robolink.testing.expectations import ExpectationError
from robolink.testing.stage import Named
from robolink.text.names import meant

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.testing.expecting import Expecting
    from robolink.testing.stage import Stage
    from robolink.testing.story import GraphView

PATIENCE = 5.0
"""Timeout of a node's answer about its declared parameters, in seconds."""


class _Given(NamedTuple):
    """A parameter that the test has given to a node, or to one of a program's."""

    name: str
    nodes: Callable[[], Sequence[str | Named]]


class Parameters:
    """The parameters of all nodes, and those that the test gave to nodes at their start."""

    def __init__(self, stage: Stage, graph: GraphView, expecting: Expecting) -> None:
        self._stage, self._graph, self._expecting = stage, graph, expecting
        self._given: list[_Given] = []

    def value_of(self, node: str, name: str, within: float) -> Any:
        """Return the value of a parameter of the node with this full name."""
        own = self._node_here(node)
        if own is not None:
            return own.get_parameter(name).value
        client = self._client(node, within)
        answer = self._expecting.result(client.get_parameters([name]), within)
        value = parameter_value_to_python(answer.values[0]) if answer.values else None
        if value is None:
            names = self._expecting.result(client.list_parameters(), within).result.names
            if name not in names:
                raise ParameterNotDeclaredException(name, known=names)
        return value

    def set_value(self, node: str, name: str, value: Any, within: float) -> None:
        """Set a parameter of the node with this full name. An integer serves for a parameter that is a double."""
        own, before = self._node_here(node), self.value_of(node, name, within)
        parameter = WrittenParameter(name, value=value).as_type(Parameter(name, value=before).type_)
        if own is not None:
            result = own.set_parameters([parameter])[0]
        else:
            answer = self._expecting.result(self._client(node, within).set_parameters([parameter]), within)
            result = answer.results[0]
        if not result.successful:
            raise InvalidParameterValueException(f"{name} of {node}", value, result.reason)

    def _client(self, node: str, within: float) -> AsyncParameterClient:
        client = AsyncParameterClient(self._stage.node, node)
        self._expecting.condition(client.services_are_ready, within)
        return client

    def _node_here(self, node: str) -> Node | None:
        """Return the node if it lives in this process, None if another has it. Raises NotFoundError for neither."""
        for each in self._stage.nodes():
            if each.get_fully_qualified_name() == node:
                return each
        known = self._graph.nodes()
        if node not in known:
            raise NotFoundError("node", node, known, "this system")
        return None

    # Parameters given at the start

    def note_given(self, started: Any, names: Iterable[str]) -> None:
        """Note what was given to what `start` has started."""
        self._given += [_Given(each, lambda: self._stage.nodes_beside(started)) for each in names]

    def note_set(self, places: Iterable[str]) -> None:
        """Note what was set in a launch file, as ``wall_follower.speed``."""
        for each in places:
            node, _, name = each.lstrip("/").partition(".")
            self._given.append(_Given(name, lambda node=node: meant(node, self._graph.nodes())))  # type: ignore[misc]

    def check_given(self) -> None:
        """Raise ExpectationError for what was given to nodes that run by now and have not declared it.

        Nodes with a lifecycle are left out: they may declare it once they are configured.
        """
        __tracebackhide__ = True
        given, self._given = self._given, []
        for each in given:
            nodes = each.nodes()
            if nodes:
                self._check(each.name, nodes)
            else:  # it waits for something that it is to start after
                self._given.append(each)

    def _check(self, name: str, nodes: Sequence[str | Named]) -> None:
        __tracebackhide__ = True
        served, known = self._graph.services(), set[str]()
        for each in nodes:
            full_name = each if isinstance(each, str) else each.get_fully_qualified_name()
            declared = None if f"{full_name}/change_state" in served else self._declared(each, full_name)
            if declared is None or is_among(name, declared):
                return
            known |= declared
        raise ExpectationError(
            f"parameter '{name}' was given to {full_name}, which has not declared it{nearest(name, known)}"
        )

    def _declared(self, node: str | Named, full_name: str) -> set[str] | None:
        """Return the names of all parameters that a node has declared so far; None if it does not answer."""
        if isinstance(node, str):
            here = (each for each in self._stage.nodes() if each.get_fully_qualified_name() == full_name)
            node = next(here, node)
        if hasattr(node, "_declared_so_far_"):
            return {*node._declared_so_far_}
        client = AsyncParameterClient(self._stage.node, full_name)
        if not self._stage.run_until(client.services_are_ready, PATIENCE):
            return None
        future = client.list_parameters()
        self._stage.run_until(future.done, PATIENCE)
        answer = future.result()
        return None if answer is None else {*answer.result.names}
