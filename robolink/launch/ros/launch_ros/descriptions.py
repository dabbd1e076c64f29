"""Components as a launch file describes them (`launch_ros.descriptions`)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from robolink.launch.ros.launch.bases import (
    Condition,
    LaunchArgumentError,
    SomeSubstitutionsType,
    Substitution,
    calling_place,
    no_argument,
)
from robolink.launch.ros.launch.utilities import normalize_to_list_of_substitutions
from robolink.launch.ros.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from robolink.launch.ros.launch_ros.parameters import normalize_parameters
from robolink.launch.ros.launch_ros.utilities import given_remappings

__all__ = [
    "ComposableNode",
    "Parameter",
    "ParameterFile",
    "ParameterValue",
]


OLD_NAMES = {
    "node_executable": "executable",
    "node_name": "name",
    "node_namespace": "namespace",
    "node_plugin": "plugin",
}
"""New names by the old ones."""


def take_old_names(kind: str, values: dict[str, Any], given: dict[str, Any]) -> tuple[str, ...]:
    """Move arguments with old names into `values`, and return these names.

    Args:
        kind: Name of the class, for the error.
        values: Arguments by their new names; None is one that was not given.
        given: Further arguments, as they were given; those with old names are removed.

    Raises:
        LaunchArgumentError: for an argument that was given by both of its names.
    """
    found = tuple(old for old, new in OLD_NAMES.items() if old in given and new in values)
    for old in found:
        new = OLD_NAMES[old]
        if values[new] is not None:
            raise LaunchArgumentError(f"{kind} has {new} and {old}, which is its old name: {new} is enough")
        values[new] = given.pop(old)
    return found


def old_names_note(names: tuple[str, ...]) -> str:
    """Return the line about arguments with old `names`."""
    new = [OLD_NAMES[each] for each in names]
    return f"old names, which ROS 2 refuses since Galactic: {', '.join(names)}; write {', '.join(new)}"


class ComposableNode:
    """Node that a container of C++ loads as a plugin; robolink's launcher names it and leaves it out.

    Args:
        package: Its package.
        plugin: Its class; it must be given.
        name: Its name.
        namespace: Its namespace.
        parameters, remappings, extra_arguments: As those of `Node`.
        condition: Condition without which it is left out.
        **kwargs: Arguments with their old names (`OLD_NAMES`).
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        extra_arguments: Sequence[Any] | None = None,
        condition: Condition | None = None,
        **kwargs: Any,
    ) -> None:
        named: dict[str, Any] = {"plugin": plugin, "name": name, "namespace": namespace}
        self.old_names = take_old_names("ComposableNode", named, kwargs)
        for each in kwargs:
            raise no_argument(ComposableNode, each)
        if named["plugin"] is None:
            raise LaunchArgumentError("ComposableNode needs plugin=...")
        self.package = normalize_to_list_of_substitutions(package)
        self.node_plugin = normalize_to_list_of_substitutions(named["plugin"])
        self.node_name, self.node_namespace = _text(named["name"]), _text(named["namespace"])
        self.parameters = None if parameters is None else normalize_parameters(parameters)
        self.remappings = None if remappings is None else given_remappings(remappings)
        self.extra_arguments = None if extra_arguments is None else normalize_parameters(extra_arguments)
        self._condition, self.place = condition, calling_place()

    def condition(self) -> Condition | None:
        """Return the condition, None if there is none."""
        return self._condition


def _text(given: SomeSubstitutionsType | None) -> list[Substitution] | None:
    return None if given is None else normalize_to_list_of_substitutions(given)
