"""Nodes of C++ that share a process, and parameters with their names (`launch_ros.descriptions`)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import (
    Condition,
    LaunchArgumentError,
    SomeSubstitutionsType,
    calling_place,
    no_argument,
)
from robolink.companions.launch_ros.old_names import take_old_names
from robolink.companions.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue

__all__ = ["ComposableNode", "Parameter", "ParameterFile", "ParameterValue"]


class ComposableNode:
    """Node that a container of C++ loads as a plugin; robolink's launcher names it and leaves it out.

    Args:
        package: Its package.
        plugin: Its class; it must be given.
        name: Its name.
        namespace: Its namespace.
        parameters, remappings, extra_arguments: As those of `Node`.
        condition: Condition without which it is left out.
        **kwargs: Arguments with their old names (`old_names.OLD_NAMES`).
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        extra_arguments: Iterable[Any] | None = None,
        condition: Condition | None = None,
        **kwargs: Any,
    ) -> None:
        named: dict[str, Any] = {"plugin": plugin, "name": name, "namespace": namespace}
        self.old_names = take_old_names("ComposableNode", named, kwargs)
        for each in kwargs:
            raise no_argument(ComposableNode, each)
        if named["plugin"] is None:
            raise LaunchArgumentError("ComposableNode needs plugin=...")
        self.package, self.node_plugin = package, named["plugin"]
        self.node_name, self.node_namespace = named["name"], named["namespace"]
        self.parameters, self.remappings, self.extra_arguments = parameters, remappings, extra_arguments
        self.condition, self.place = condition, calling_place()
