"""Nodes of C++ that share a process, and parameters with their names (`launch_ros.descriptions`)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import Condition, SomeSubstitutionsType, calling_place
from robolink.companions.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """Node that a container of C++ loads as a plugin; robolink's launcher names it and leaves it out.

    Args:
        package: Its package.
        plugin: Its class.
        name: Its name.
        namespace: Its namespace.
        parameters, remappings, extra_arguments: As those of `Node`.
        condition: Condition without which it is left out.
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.package, self.node_plugin, self.node_name, self.node_namespace = package, plugin, name, namespace
        self.parameters, self.remappings, self.extra_arguments = parameters, remappings, extra_arguments
        self.condition, self.place = condition, calling_place()
