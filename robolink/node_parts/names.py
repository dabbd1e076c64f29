"""Name, namespace and overrides of a new node, as its code, the command line and parameter files give them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.arguments.command_line import Arguments
from robolink.parameter import Parameter
from robolink.parameters.rules import WrittenParameter
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name


def own_name(arguments: Arguments, name: str, namespace: str | None) -> tuple[str, str]:
    """Return name and namespace after remapping. Raises what `Node` raises for a name or namespace."""
    if not isinstance(namespace, (str, type(None))):
        raise TypeError(f"namespace: expected a str or None, got {namespace!r}")
    absolute = namespace if namespace and namespace.startswith("/") else f"/{namespace or ''}"
    validate_node_name(name)
    validate_namespace(absolute)
    new_name = arguments.node_name(name)
    new_namespace = arguments.namespace(absolute, new_name)
    validate_node_name(new_name)
    validate_namespace(new_namespace)
    return new_name, new_namespace


def overrides_of(arguments: Arguments, full_name: str, given: Iterable[Parameter[Any]]) -> dict[str, Parameter[Any]]:
    """Return the overrides of a node's parameters by name: those that its code gives go before the written ones."""
    overrides: dict[str, Parameter[Any]] = {
        name: WrittenParameter(name, value=value) for name, value in arguments.overrides_for(full_name).items()
    }
    overrides.update({each.name: each for each in given})
    return overrides
