"""Client of one node's parameter services, for the commands of `robolink param`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from robolink.cli.shared.graph import absolute, no_such_node
from robolink.cli.shared.session import looking, node_of
from robolink.exceptions import ExternalShutdownException, NotFoundError, RobolinkError
from robolink.interfaces.rcl_interfaces import srv
from robolink.interfaces.rcl_interfaces.msg import (
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetParametersResult,
)
from robolink.system.terminal import shown
from robolink.wire import EndpointKind

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node

ANSWER_WITHIN = 5.0
"""Timeout of a node's answer, in seconds: it may be busy with a callback."""


class ParameterCommandError(RobolinkError, RuntimeError):
    """A node's parameters are not available: it does not serve them, or does not answer."""


class ParameterClient:
    """Client of the parameter services of one node."""

    def __init__(self, asker: Node, name: str) -> None:
        self.name = name
        self._asker = asker

    def names(self, prefixes: Sequence[str] = ()) -> list[str]:
        """Return the names of its parameters, sorted; only those below `prefixes`, if there are any."""
        request = srv.ListParameters.Request(prefixes=list(prefixes))
        return sorted(self._call(srv.ListParameters, "list_parameters", request).result.names)

    def values(self, names: Sequence[str]) -> list[ParameterValue]:
        """Return the values. Raises NotFoundError if one is unknown, ParameterCommandError if one has no value."""
        found = list(self._call(srv.GetParameters, "get_parameters", srv.GetParameters.Request(names=names)).values)
        if len(found) == len(names):
            return found
        self._check_known(names)
        raise ParameterCommandError(f"{_listed(names)} of {self.name}: Parameter not set")

    def settled_values(self, names: Sequence[str]) -> dict[str, ParameterValue]:
        """Return the values of those parameters that have one; the others are declared with a type, but no value."""
        try:
            return dict(zip(names, self.values(names), strict=True))
        except ParameterCommandError:
            if len(names) == 1:
                return {}
        half = len(names) // 2
        return {**self.settled_values(names[:half]), **self.settled_values(names[half:])}

    def descriptors(self, names: Sequence[str]) -> list[ParameterDescriptor]:
        """Return the descriptors. Raises NotFoundError for an unknown parameter."""
        request = srv.DescribeParameters.Request(names=names)
        found = list(self._call(srv.DescribeParameters, "describe_parameters", request).descriptors)
        if len(found) != len(names):
            self._check_known(names)
            raise ParameterCommandError(f"{self.name} does not describe {_listed(names)}")
        return found

    def set(self, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one, and return a result for each."""
        request = srv.SetParameters.Request(parameters=parameters)
        results = list(self._call(srv.SetParameters, "set_parameters", request).results)
        if len(results) == 1 < len(parameters) and results[0].reason:
            raise ParameterCommandError(f"{self.name}/set_parameters: {shown(results[0].reason, 200)}")
        if len(results) != len(parameters):
            raise ParameterCommandError(
                f"{self.name}/set_parameters: expected {len(parameters)} results, got {len(results)}"
            )
        return results

    def _check_known(self, names: Sequence[str]) -> None:
        known = self.names()
        for each in names:
            if each not in known:
                raise NotFoundError("parameter", shown(each), known, self.name)

    def _call(self, srv_type: type[Any], name: str, request: Any) -> Any:
        client = self._asker.create_client(srv_type, f"{self.name}/{name}")
        try:
            return client.try_call(request, timeout_sec=ANSWER_WITHIN)
        except TimeoutError:
            raise ParameterCommandError(
                f"no answer within {ANSWER_WITHIN:g} s from {client.service_name}: does the node spin?"
            ) from None
        except ExternalShutdownException:
            raise KeyboardInterrupt from None
        finally:
            self._asker.destroy_client(client)


@contextmanager
def asking(node: str, timeout: float) -> Iterator[ParameterClient]:
    """Open a client of a node, by its full name or without its slash; wait `timeout` seconds for the node.

    Raises NotFoundError if it is not there, ParameterCommandError if it does not serve its parameters.
    """
    with looking() as context:
        name = absolute(node)
        if not serves(context, name, timeout):
            raise _absent(context, name)
        yield ParameterClient(node_of(context), name)


def serves(context: Context, name: str, timeout: float = 0.0) -> bool:
    """Wait up to `timeout` seconds for a node's parameter services; return True if they are there."""

    def is_there() -> bool:
        return context.graph.count(EndpointKind.SERVICE, f"{name}/set_parameters") > 0

    found = context.wait_until(is_there, timeout)
    if not context.ok():
        raise KeyboardInterrupt
    return found


def _absent(context: Context, name: str) -> RobolinkError:
    known = [each.full_node_name for each in context.graph.nodes()]
    if name in known:
        return ParameterCommandError(f"{name} has no parameter services: it was made without them")
    return ParameterCommandError(no_such_node(context, name, f"{name}/set_parameters", known))


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"'{shown(each)}'" for each in names)
