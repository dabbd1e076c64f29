"""Parameters and components in launch files (`launch_ros.descriptions`, `launch_ros.parameter_descriptions`)."""

from __future__ import annotations

import base64
import os
import typing
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from robolink.launch.ros.launch.bases import (
    Condition,
    LaunchArgumentError,
    LaunchContext,
    LaunchError,
    SomeSubstitutionsType,
    calling_place,
    no_argument,
)
from robolink.launch.ros.launch.utilities import (
    SCALARS,
    boolean,
    checked,
    coerced,
    is_substitution,
    item_type,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    performed,
    value_in,
)
from robolink.system.terminal import shown

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


class ParameterValue:
    """Value of a parameter, of a type.

    Args:
        value: A plain value, a list, or substitutions.
        value_type: `str`, `int`, `float`, `bool` or a list of one, `List[int]`; None reads the text of substitutions as
            YAML, and takes plain values as they are.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the plain value, with the values of `context`. Raises LaunchError."""
        value, expected = self.value, self.value_type
        if isinstance(value, SCALARS):
            return _instance(value, expected)
        if is_substitution(value):
            return coerced(performed(context, value), expected)
        if not isinstance(value, Sequence) or isinstance(value, bytes):
            raise LaunchArgumentError(f"a parameter is a plain value, a list or substitutions, got {_kind(value)}")
        inner = item_type(expected)
        if expected is not None and inner is None:
            raise LaunchArgumentError(f"expected {expected.__name__}, got a list")
        found = [
            _instance(each, inner) if isinstance(each, SCALARS) else coerced(performed(context, each), inner)
            for each in value
        ]
        return _uniform(found, found)


def _instance(value: Any, expected: Any) -> Any:
    """Return a plain `value` that is of the type `expected`, None for any. Raises LaunchArgumentError otherwise."""
    if expected is None or (expected in SCALARS and isinstance(value, expected)):
        return value
    name = expected.__name__ if isinstance(expected, type) and not typing.get_args(expected) else expected
    raise LaunchArgumentError(f"value_type is {name}, and {value!r} is a {type(value).__name__}")


class Parameter:
    """Parameter with its name.

    Args:
        name: Its name.
        value: Its value, as that of ParameterValue.
        value_type: Its type, as that of ParameterValue.
    """

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.parameter_value = (
            value if isinstance(value, ParameterValue) else ParameterValue(value, value_type=value_type)
        )

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return its name and its plain value, with the values of `context`."""
        return perform_substitutions(context, self.name), self.parameter_value.evaluate(context)


class ParameterFile:
    """File of parameters.

    Args:
        param_file: Its path.
        allow_substs: True performs the substitutions `$(var NAME)` in it.
    """

    def __init__(
        self, param_file: SomeSubstitutionsType, *, allow_substs: bool | SomeSubstitutionsType = False
    ) -> None:
        self.param_file, self.allow_substs = normalize_to_list_of_substitutions(param_file), allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return its path, with the values of `context`."""
        return Path(perform_substitutions(context, self.param_file))

    def substituted(self, context: LaunchContext) -> str | None:
        """Return the file's text with the values of `context` put in; None where that is not requested.

        Raises LaunchError, also for a file that cannot be read.
        """
        if not boolean(context, self.allow_substs):
            return None
        from robolink.launch.ros.launch.frontend.parse_substitution import parse_substitution

        path = self.evaluate(context)
        if not path.is_file():
            return None
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, ValueError) as error:
            raise LaunchError(f"{path} cannot be read: {error}") from None
        return perform_substitutions(context, parse_substitution(text))


def evaluated(parameters: Mapping[Any, Any], context: LaunchContext) -> Iterator[tuple[str, Any]]:
    """Yield the name and the plain value of each parameter of a mapping, nested names joined by dots.

    Args:
        parameters: Values by name: plain ones, lists, substitutions, or mappings of these.
        context: The context with whose values they are performed.
    """
    for key, value in parameters.items():
        name = performed(context, key)
        if isinstance(value, Mapping):
            yield from ((f"{name}.{inner}", each) for inner, each in evaluated(value, context))
            continue
        try:
            yield name, plain(value, context)
        except LaunchError as error:
            raise type(error)(f"parameter '{shown(name)}': {error}") from None


def plain(value: Any, context: LaunchContext) -> Any:
    """Return the plain value of a parameter, `value`, with the values of `context`.

    A text stays one. Substitutions are performed and read as YAML, also a list of them and texts, which is joined; in a
    list of lists each is such a text, and a list of several types is one of texts that YAML reads.
    """
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if is_substitution(value):
        return _filled(coerced(performed(context, value), None))
    if isinstance(value, bytes):
        return base64.encodebytes(value).decode()
    if isinstance(value, SCALARS):
        return value
    if not isinstance(value, Sequence):
        hint = ": write str(...)" if isinstance(value, os.PathLike) else ""
        raise LaunchArgumentError(f"a parameter is a plain value, a list or substitutions, got {_kind(value)}{hint}")
    kinds = {type(each) for each in value}
    if kinds == {int, float}:
        return [float(each) for each in value]
    if kinds and kinds <= set(SCALARS):
        return _uniform(list(value), value)
    return _filled(_uniform([_item(each, context) for each in value], value))


def _item(value: Any, context: LaunchContext) -> Any:
    """Return an item of a list: a plain value, or what YAML reads of a text with substitutions."""
    return value if isinstance(value, SCALARS) else value_in(performed(context, value))


def _filled(value: Any) -> Any:
    """Return a `value`, unless it is an empty list: its type is unknown. Raises LaunchError."""
    if isinstance(value, list) and not value:
        raise LaunchError("an empty list has no type, and ROS 2 takes none: leave the parameter out")
    return value


def _uniform(found: list[Any], said: object) -> list[Any]:
    checked(found, said)
    return found


def _kind(value: object) -> str:
    return type(value).__name__


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
