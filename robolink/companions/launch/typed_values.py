"""Values of a type from texts, as in ROS 2's launch: YAML reads a text, and in the node rcl reads it again."""

from __future__ import annotations

import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import yaml

from robolink.arguments.parameter_file import parse_scalar
from robolink.companions.launch.bases import LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.companions.launch.utilities import LaunchArgumentError, performed
from robolink.system.terminal import shown

SCALARS = (bool, int, float, str)
"""Types of a parameter's scalars."""
AS_TEXT = "ParameterValue(..., value_type=str) keeps it a text"


def value_in(text: str) -> Any:
    """Return the value that `text` spells in YAML: a scalar, or a list of one type.

    Raises LaunchError for what is not YAML, and for a date, a null, a mapping and a list of several types.
    """
    if not text:
        return text
    try:
        value = yaml.safe_load(text)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        problem = getattr(error, "problem", None) or "it is not valid YAML"
        raise LaunchError(f"'{shown(text, 60)}' is not a parameter's value: {problem}; {AS_TEXT}") from None
    return checked(value, text)


def checked(value: Any, text: object) -> Any:
    """Return a `value` as YAML has read it, if a parameter can have it; `text` is for the error. Raises LaunchError."""
    if isinstance(value, list):
        kinds = list(dict.fromkeys(map(type, value)))
        if set(kinds) <= set(SCALARS) and len(kinds) <= 1:
            return value
        names = " and ".join(each.__name__ for each in kinds)
        advice = ": write 1.0 for 1" if set(kinds) == {int, float} else ""
        raise LaunchError(f"'{shown(str(text), 60)}' is a list of {names}, and ROS 2 takes one type{advice}")
    if not isinstance(value, SCALARS):
        name = "null" if value is None else type(value).__name__
        raise LaunchError(f"'{shown(str(text), 60)}' is a {name} in YAML, and not a parameter's value; {AS_TEXT}")
    return value


def coerced(text: str, wanted: Any) -> Any:
    """Return `text` as a value of the type `wanted`, None for what YAML reads.

    Raises:
        LaunchError: for a text that is not of this type.
        LaunchArgumentError: for another type than bool, int, float, str or a list of one.
    """
    if wanted is None:
        return as_node_reads(value_in(text))
    inner = item_type(wanted)
    if inner is not None:
        value = value_in(text)
        if not isinstance(value, list) or not all(isinstance(each, inner) for each in value):
            advice = ": write 1.0 for 1" if inner is float else ""
            raise LaunchError(f"expected a list of {inner.__name__}, got '{shown(text)}'{advice}")
        return value
    try:
        if wanted is bool:
            return truth_of(text)
        return {str: str, int: int, float: float}[wanted](text)
    except KeyError:
        raise LaunchArgumentError(f"value_type is str, int, float, bool or a list of one, got {wanted}") from None
    except ValueError:
        raise LaunchError(f"expected {wanted.__name__}, got '{shown(text)}'") from None


def item_type(wanted: Any) -> Any:
    """Return the type of the items of a list type `wanted`, `List[int]`; None for a scalar type."""
    arguments = typing.get_args(wanted)
    return arguments[0] if arguments and typing.get_origin(wanted) in (list, Sequence) else None


def truth_of(text: str) -> bool:
    """Return the boolean that `text` spells in YAML, `true`, `off`, or 1 or 0. Raises LaunchError."""
    try:
        value = yaml.safe_load({"1": "true", "0": "false"}.get(text, text))
    except (yaml.YAMLError, ValueError, RecursionError):
        value = None
    if not isinstance(value, bool):
        raise LaunchError(f"expected true or false, got '{shown(text)}'")
    return value


def boolean(context: LaunchContext, subs: SomeSubstitutionsType | bool) -> bool:
    """Return a boolean, or the one that the text of `subs` spells with the values of `context`. Raises LaunchError."""
    return subs if isinstance(subs, bool) else truth_of(performed(context, subs))


def as_node_reads(value: Any) -> Any:
    """Return the value that a node of ROS 2 gets for a text that YAML has read, and any other `value` as it is.

    launch writes it into a parameter file by PyYAML, without quotes unless PyYAML would read something else, and the
    node reads that by rcl, for which `1e5`, `inf` and `y` are a number, another one and a boolean.
    """
    if not isinstance(value, str):
        return value
    found = parse_scalar(value)
    if isinstance(found, str):
        return value
    try:
        is_bare = isinstance(yaml.safe_load(value), str)
    except yaml.YAMLError:
        return value
    return found if is_bare else value


def read_otherwise(value: Any) -> Mapping[str, Any]:
    """Return the texts in a parameter's `value` that a node of ROS 2 reads as something else, with what it reads."""
    texts: list[Any] = value if isinstance(value, list) else [value]
    read: Callable[[Any], Any] = as_node_reads
    return {each: read(each) for each in texts if isinstance(each, str) and not isinstance(read(each), str)}
