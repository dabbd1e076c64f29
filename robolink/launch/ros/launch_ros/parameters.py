"""Parameters of nodes in a launch file: normalized when an action is made, evaluated when it is executed.

They are `launch_ros.utilities`' functions. Normalized parameters are a tuple of files, of `Parameter`s, and of mappings
in which each name is a tuple of substitutions, and each value a scalar, bytes, a tuple of one type, a `ParameterValue`,
a tuple of substitutions (one text in YAML), or a tuple of such (a list of texts in YAML).
"""

from __future__ import annotations

import base64
import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from robolink.documents.yamlfile import spell
from robolink.launch.ros.launch.bases import LaunchArgumentError, LaunchContext, LaunchError, Substitution
from robolink.launch.ros.launch.utilities import (
    AS_TEXT,
    SCALARS,
    TextSubstitution,
    as_node_reads,
    normalize_to_list_of_substitutions,
    performed,
)
from robolink.launch.ros.launch_ros.parameter_descriptions import Parameter, ParameterFile, ParameterValue
from robolink.system.terminal import shown

if TYPE_CHECKING:
    from robolink.parameter import Parameter as NodeParameter

__all__ = [
    "evaluate_parameter_dict",
    "evaluate_parameters",
    "normalize_parameter_dict",
    "normalize_parameters",
    "to_parameters_list",
]


class PlainText(TextSubstitution):
    """Text of a parameter that the launch file has given as one, spelled in YAML.

    Args:
        text: The text.
    """

    def __init__(self, text: str) -> None:
        super().__init__(text=spell(text))
        self.plain = text


def normalize_parameters(parameters: Sequence[Any]) -> tuple[Any, ...]:
    """Return the `parameters` of an action, files, mappings and `Parameter`s, in the form of `evaluate_parameters`.

    Raises LaunchArgumentError for another type, also within a mapping.
    """
    if isinstance(parameters, (str, Mapping)) or not isinstance(parameters, Iterable):
        raise LaunchArgumentError(f"parameters are a list, as in [{parameters!r:.60}]")
    return tuple(_normal(each) for each in parameters)


def _normal(given: Any) -> Any:
    if isinstance(given, Mapping):
        return normalize_parameter_dict(given)
    return given if isinstance(given, (Parameter, ParameterFile)) else ParameterFile(given)


def normalize_parameter_dict(
    parameters: Mapping[Any, Any], *, _prefix: Sequence[Substitution] = ()
) -> dict[tuple[Substitution, ...], Any]:
    """Return a mapping of parameters in the form of `evaluate_parameter_dict`: nested names are joined by dots.

    Args:
        parameters: Values by name: plain ones, lists, substitutions, or mappings of these.
        _prefix: What is in front of each name.

    Raises:
        LaunchArgumentError: for a value that no parameter can have.
    """
    if not isinstance(parameters, Mapping):
        raise LaunchArgumentError(f"a mapping of parameters is expected, got {_kind(parameters)}")
    normal: dict[tuple[Substitution, ...], Any] = {}
    for key, value in parameters.items():
        name = (*_prefix, *normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            normal.update(normalize_parameter_dict(value, _prefix=(*name, TextSubstitution(text="."))))
        else:
            normal[name] = _named(name, _normal_value, value)
    return normal


def _named(name: Sequence[Substitution], act: Callable[[Any], Any], value: Any) -> Any:
    """Return `act(value)`; an error of it names the parameter."""
    try:
        return act(value)
    except LaunchError as error:
        label = "".join(each.text if isinstance(each, TextSubstitution) else each.describe() for each in name)
        raise type(error)(f"parameter '{shown(label)}': {error}") from None


def _normal_value(value: Any) -> Any:
    if isinstance(value, str):
        return (PlainText(value),)
    if isinstance(value, Substitution):
        return (value,)
    if isinstance(value, (ParameterValue, bytes, *SCALARS)):
        return value
    if isinstance(value, Sequence):
        return _normal_list(value)
    hint = ": write str(...)" if isinstance(value, os.PathLike) else ""
    raise LaunchArgumentError(f"a parameter is a plain value, a list or substitutions, got {_kind(value)}{hint}")


def _normal_list(items: Sequence[Any]) -> tuple[Any, ...]:
    """Return a list as a tuple: of one type, of substitutions that are one text, or of several such texts."""
    kinds = {type(each) for each in items}
    if kinds in ({bool}, {int}, {float}):
        return tuple(items)
    if kinds == {int, float}:
        return tuple(map(float, items))
    texts = all(isinstance(each, (str, os.PathLike, Substitution)) for each in items)
    if texts and any(isinstance(each, Substitution) for each in items):
        return tuple(normalize_to_list_of_substitutions(items))
    return tuple(map(_normal_item, items))


def _normal_item(item: Any) -> Sequence[Substitution]:
    if isinstance(item, str):
        return [PlainText(item)]
    if isinstance(item, SCALARS):
        return [TextSubstitution(text=yaml.safe_dump(item))]
    return normalize_to_list_of_substitutions(item)


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> tuple[Any, ...]:
    """Return normalized parameters with the values of `context`: paths, `Parameter`s, and plain values by name.

    Args:
        context: The context.
        parameters: What `normalize_parameters` has returned.

    Raises:
        LaunchArgumentError: for a value that no parameter can have.
    """
    return tuple(_evaluated(context, each) for each in parameters)


def _evaluated(context: LaunchContext, normal: Any) -> Any:
    if isinstance(normal, ParameterFile):
        return normal.evaluate(context)
    return normal if isinstance(normal, Parameter) else evaluate_parameter_dict(context, normal)


def evaluate_parameter_dict(context: LaunchContext, parameters: Mapping[Any, Any]) -> dict[str, Any]:
    """Return the plain value of each parameter of a normalized mapping by its name; a list is a tuple.

    Args:
        context: The context.
        parameters: What `normalize_parameter_dict` has returned.

    Raises:
        LaunchArgumentError: for a value that no parameter can have.
    """
    return dict(_values(context, parameters, _value))


def values_for_node(context: LaunchContext, parameters: Mapping[Any, Any]) -> Iterator[tuple[str, Any]]:
    """Yield the name and the value of each parameter of a normalized mapping as a node of ROS 2 gets it.

    Args:
        context: The context.
        parameters: What `normalize_parameter_dict` has returned.

    Raises:
        LaunchError: for a value that no parameter can have.
    """
    return _values(context, parameters, _for_node)


def _values(context: LaunchContext, parameters: Mapping[Any, Any], value_of: Any) -> Iterator[tuple[str, Any]]:
    if not isinstance(parameters, Mapping):
        raise LaunchArgumentError(f"a mapping of parameters is expected, got {_kind(parameters)}")
    for key, value in parameters.items():
        if not isinstance(key, tuple):
            raise LaunchArgumentError(f"a normalized name is a tuple of substitutions, got {key!r:.60}")
        name = performed(context, key)
        try:
            yield name, value_of(context, value)
        except LaunchError as error:
            raise type(error)(f"parameter '{shown(name)}': {error}") from None


def _for_node(context: LaunchContext, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return value.for_node(context)
    found = _value(context, value)
    if isinstance(found, bytes):  # PyYAML writes them so
        return base64.encodebytes(found).decode()
    if isinstance(found, tuple):
        return list(found)
    is_plain = isinstance(value, tuple) and isinstance(value[0], PlainText)
    return found if is_plain else as_node_reads(found)


def _value(context: LaunchContext, value: Any) -> Any:
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, (bytes, *SCALARS)):
        return value
    if not isinstance(value, tuple):
        raise LaunchArgumentError(f"a normalized value is expected, got {_kind(value)}")
    if not value:
        raise LaunchArgumentError("an empty list has no type, and ROS 2 takes none: leave the parameter out")
    if isinstance(value[0], Substitution):
        found = _spelled(context, value)
        return _of_one_type(found) if isinstance(found, list) else _scalar(found)
    if isinstance(value[0], Sequence):
        return _of_one_type([_spelled(context, each) for each in value])
    return value


def _spelled(context: LaunchContext, parts: Sequence[Substitution]) -> Any:
    """Return the YAML value that substitutions, which are one text, spell; an empty text stays one."""
    if len(parts) == 1 and isinstance(parts[0], PlainText):
        return parts[0].plain
    text = performed(context, parts)
    try:
        return yaml.safe_load(text) if text else text
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        problem = getattr(error, "problem", None) or "it is not valid"
        raise LaunchArgumentError(f"Unable to parse '{shown(text, 60)}' as YAML: {problem}; {AS_TEXT}") from None


def _scalar(value: Any) -> Any:
    if isinstance(value, (bytes, *SCALARS)):
        return value
    name = "null" if value is None else type(value).__name__
    raise LaunchArgumentError(
        f"Allowed value types are bool, int, float, str and lists of one of them, got {name} ({value!r:.60}); {AS_TEXT}"
    )


def _of_one_type(items: list[Any]) -> tuple[Any, ...]:
    kinds = list(dict.fromkeys(map(type, items)))
    if len(kinds) == 1 and kinds[0] in SCALARS:
        return tuple(items)
    advice = ": write 1.0 for 1" if set(kinds) == {int, float} else ""
    raise LaunchArgumentError(
        f"Expected a non-empty sequence of bool, int, float or str, all of one type, got {items!r:.60}{advice}"
    )


def to_parameters_list(
    context: LaunchContext, node_name: str, namespace: str | None, evaluated_parameters: Iterable[Any]
) -> list[NodeParameter[Any]]:
    """Return parameters as those of a node, in their order; the later ones count.

    Of a file, the section `/**` and that of the node count; a file without sections counts as a whole.

    Args:
        context: The context.
        node_name: Name of the node, '' for an unknown one.
        namespace: Its namespace.
        evaluated_parameters: What `evaluate_parameters` has returned.

    Raises:
        LaunchArgumentError: for a value that no parameter can have.
    """
    from robolink.parameter import Parameter as NodeParameter  # late: it needs the classes of messages

    full_name = "/".join(filter(None, [(namespace or "").strip("/"), node_name.lstrip("/")]))
    found: list[tuple[str, Any]] = []
    for each in evaluated_parameters:
        if isinstance(each, Path):
            found += evaluate_parameter_dict(context, normalize_parameter_dict(_in_file(each, full_name))).items()
        elif isinstance(each, Mapping):
            found += each.items()
        else:
            found.append(each.evaluate(context))
    return [NodeParameter(name, value=_listed(value)) for name, value in found]


def _listed(value: Any) -> Any:
    return list(value) if isinstance(value, tuple) else value


def _in_file(path: Path, full_name: str) -> dict[str, Any]:
    """Return the parameters in a file for the node with this full name, without the first slash."""
    data = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
    sections = dict(_sections(data, ()))
    if not sections:
        return dict(data)
    if not full_name:
        warnings.warn("node name not provided to launch; parameter files will not apply", UserWarning, stacklevel=2)
    return {**sections.get("**", {}), **sections.get(full_name, {})}


def _sections(data: Any, above: tuple[str, ...]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the parameters in parts of a file, each with its pattern of node names without the first slash."""
    for key, value in data.items() if isinstance(data, Mapping) else ():
        if key == "ros__parameters":
            yield "/".join(above), value
        else:
            yield from _sections(value, (*above, str(key).lstrip("/")))


def _kind(value: object) -> str:
    return type(value).__name__
