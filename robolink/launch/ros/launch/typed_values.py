"""Values of a type, as texts spell them and substitutions stand for them (`launch.utilities.type_utils`)."""

from __future__ import annotations

import typing
from collections.abc import Iterable, Sequence
from typing import Any, List, TypeAlias  # noqa: UP035 - ROS 2 names its list types by it

import yaml

from robolink.launch.ros.launch.bases import (
    LaunchArgumentError,
    LaunchContext,
    LaunchError,
    SomeSubstitutionsType,
    Substitution,
)
from robolink.launch.ros.launch.utilities import (
    ensure_argument_type,
    is_substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from robolink.system.terminal import shown

__all__ = [
    "AllowedTypesTuple",
    "AllowedTypesType",
    "AllowedValueType",
    "ListTypesTuple",
    "ListTypesType",
    "ListValueType",
    "NormalizedScalarType",
    "NormalizedSequenceType",
    "NormalizedValueType",
    "ScalarTypesTuple",
    "ScalarTypesType",
    "ScalarValueType",
    "SequenceValueType",
    "SomeScalarType",
    "SomeSequenceType",
    "SomeValueType",
    "StrSomeScalarType",
    "StrSomeSequenceType",
    "StrSomeValueType",
    "coerce_list",
    "coerce_to_type",
    "extract_type",
    "get_typed_value",
    "is_instance_of",
    "is_instance_of_valid_type",
    "is_normalized_substitution",
    "is_substitution",
    "is_typing_list",
    "is_valid_scalar_type",
    "normalize_typed_substitution",
    "perform_typed_substitution",
]

ScalarTypesTuple = (int, float, bool, str)
ListTypesTuple = (List[int], List[float], List[bool], List[str])  # noqa: UP006
AllowedTypesTuple = ScalarTypesTuple + ListTypesTuple
ScalarTypesType: TypeAlias = type[int | float | bool | str]
ListTypesType: TypeAlias = type[list[int] | list[float] | list[bool] | list[str]]
AllowedTypesType: TypeAlias = ScalarTypesType | ListTypesType
ScalarValueType: TypeAlias = int | float | bool | str
ListValueType: TypeAlias = list[int] | list[float] | list[bool] | list[str]
SequenceValueType: TypeAlias = Sequence[int] | Sequence[float] | Sequence[bool] | Sequence[str]
AllowedValueType: TypeAlias = ScalarValueType | SequenceValueType
SomeScalarType: TypeAlias = SomeSubstitutionsType | ScalarValueType
SomeSequenceType: TypeAlias = Sequence[SomeScalarType]
SomeValueType: TypeAlias = SomeScalarType | SomeSequenceType
NormalizedScalarType: TypeAlias = list[Substitution] | ScalarValueType
NormalizedSequenceType: TypeAlias = list[NormalizedScalarType]
NormalizedValueType: TypeAlias = NormalizedScalarType | NormalizedSequenceType
StrSomeScalarType = SomeScalarType
StrSomeSequenceType: TypeAlias = Sequence[ScalarValueType]
StrSomeValueType: TypeAlias = StrSomeScalarType | StrSomeSequenceType
SPELLED = {"1": "true", "0": "false"}
"""Spellings of booleans that are none in YAML."""


class ValueTypeError(LaunchError, ValueError):
    """A text does not spell a value of the type, or the type is none that a value may have."""


def is_typing_list(data_type: Any) -> bool:
    """Return whether `data_type` is `typing.List`, or a list type such as `List[int]` and `list[int]`."""
    return data_type is List or typing.get_origin(data_type) is list  # noqa: UP006


def is_valid_scalar_type(data_type: Any) -> bool:
    """Return whether `data_type` is int, float, bool or str."""
    return data_type in ScalarTypesTuple


def extract_type(data_type: Any) -> tuple[Any, bool]:
    """Return the scalar type in `data_type`, and whether it is that of a list's items.

    Raises ValueTypeError for a type that is neither a scalar one nor a list of one.
    """
    arguments = typing.get_args(data_type) if is_typing_list(data_type) else ()
    kind = arguments[0] if arguments else data_type
    if not is_valid_scalar_type(kind):
        raise ValueTypeError(f"a value is an int, float, bool, str or a list of one, and not {data_type}")
    return kind, bool(arguments)


def is_instance_of_valid_type(value: Any, *, can_be_str: bool = False) -> bool:
    """Return whether `value` is a scalar, or a list of one type.

    Args:
        value: The value.
        can_be_str: True lets texts stand among other items of a list.
    """
    if not isinstance(value, list):
        return isinstance(value, ScalarTypesTuple)
    kind = next((type(each) for each in value if type(each) is not str), str)
    kinds = (kind, str) if can_be_str else (kind,)
    return not value or (kind in ScalarTypesTuple and all(isinstance(each, kinds) for each in value))


def is_instance_of(value: Any, data_type: Any = None, *, can_be_str: bool = False) -> bool:
    """Return whether `value` is of a type.

    Args:
        value: The value.
        data_type: A scalar type or a list type; None stands for any of them.
        can_be_str: True takes texts, too.

    Raises:
        ValueTypeError: for another `data_type`.
    """
    if data_type is None:
        return is_instance_of_valid_type(value, can_be_str=can_be_str)
    kind, is_list = extract_type(data_type)
    kinds = (kind, str) if can_be_str else (kind,)
    if not is_list:
        return isinstance(value, kinds)
    return isinstance(value, list) and all(isinstance(each, kinds) for each in value)


def coerce_to_type(value: str, data_type: Any = None, *, can_be_str: bool = False) -> Any:
    """Return the value that a text spells.

    Args:
        value: The text.
        data_type: Type of the value; None is what YAML reads.
        can_be_str: True leaves a text as it is that does not spell one, and takes texts among a list's items.

    Raises:
        ValueTypeError: for a text that does not spell a value of this type, and for another type.
        LaunchArgumentError: if `value` is not a text.
    """
    ensure_argument_type(value, str, "value", "coerce_to_type")
    kind, is_list = (None, False) if data_type is None else extract_type(data_type)
    if kind is str and not is_list:
        return value
    if kind in (int, float) and not is_list:
        try:
            return kind(value)
        except ValueError:
            if can_be_str:
                return value
            raise ValueTypeError(f"expected {_named(data_type)}, got '{shown(value)}'") from None
    found = _of_yaml(SPELLED.get(value, value) if data_type is bool else value, data_type, can_be_str)
    is_empty = data_type is None and found == ""
    if not is_empty and not is_instance_of(found, data_type, can_be_str=can_be_str):
        raise ValueTypeError(f"expected {_named(data_type)}, got '{shown(value)}'")
    return found


def _of_yaml(text: str, data_type: Any, can_be_str: bool) -> Any:
    try:
        return yaml.safe_load(text) if text else text
    except (yaml.YAMLError, ValueError, RecursionError):
        if can_be_str:
            return text
        raise ValueTypeError(f"expected {_named(data_type)}, got '{shown(text)}', which is not YAML") from None


def coerce_list(value: list[str], data_type: Any = None, *, can_be_str: bool = False) -> list[Any]:
    """Return the values that several texts spell.

    Args:
        value: The texts.
        data_type: Type of each value; None is what YAML reads.
        can_be_str: True leaves texts as they are that do not spell one.

    Raises:
        ValueTypeError: for a text that does not spell a value of this type, and for values of several types.
        LaunchArgumentError: if `value` is not a list of texts.
    """
    ensure_argument_type(value, list, "value", "coerce_list")
    found = [coerce_to_type(each, data_type, can_be_str=can_be_str) for each in value]
    if not is_instance_of_valid_type(found, can_be_str=can_be_str):
        raise ValueTypeError(f"expected a list of one type, got {value!r:.60}")
    return found


def get_typed_value(value: str | list[str], data_type: Any, *, can_be_str: bool = False) -> Any:
    """Return the value that a text or several of them spell, as `coerce_to_type` and `coerce_list` do.

    Args:
        value: The text, or several.
        data_type: Type of the value; a list type for several texts; None is what YAML reads.
        can_be_str: True leaves texts as they are that do not spell one.

    Raises:
        ValueTypeError: for a text that does not spell a value of this type.
        LaunchArgumentError: for another `value`, and for several texts where a scalar is expected.
    """
    if not isinstance(value, list):
        return coerce_to_type(value, data_type, can_be_str=can_be_str)
    kind, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise LaunchArgumentError(f"expected {_named(data_type)}, got a list")
    return coerce_list(value, kind, can_be_str=can_be_str)


def normalize_typed_substitution(value: Any, data_type: Any) -> Any:
    """Return a value that may hold substitutions in the form that `perform_typed_substitution` takes.

    Args:
        value: A scalar, a substitution, texts and substitutions that are one text together, or a list of such.
        data_type: Type that it will have; None leaves it open.

    Raises:
        LaunchArgumentError: for a value that cannot have this type.
        ValueTypeError: for another type.
    """
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type):
            raise LaunchArgumentError(f"expected {_named(data_type)}, got {value!r:.60}")
        return value
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    if not isinstance(value, Iterable):
        raise LaunchArgumentError(f"expected a value or a substitution, got {value!r:.60}")
    kind, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise LaunchArgumentError(f"expected {_named(data_type)}, got a list")
    return [_normalized_item(each, kind, value) for each in _of_one_type(list(value))]


def _of_one_type(items: list[Any]) -> list[Any]:
    """Return items of a list; those of a list with floats are floats. Raises LaunchArgumentError for several types."""
    plain = [each for each in items if isinstance(each, ScalarTypesTuple)]
    kinds = {type(each) for each in plain}
    if kinds == {int, float}:
        return [float(each) if type(each) is int else each for each in items]
    if len(kinds) > 1:
        raise LaunchArgumentError(f"expected a list of one type, got {items!r:.60}")
    return items


def _normalized_item(item: Any, kind: Any, items: Any) -> Any:
    if is_substitution(item):
        return normalize_to_list_of_substitutions(item)
    if not isinstance(item, ScalarTypesTuple):
        raise LaunchArgumentError(f"a list's items are values and substitutions, got {item!r:.60}")
    if kind is float and type(item) is int:
        return float(item)
    if kind is not None and not isinstance(item, kind):
        raise LaunchArgumentError(f"expected a list of {kind.__name__}, got {items!r:.60}")
    return item


def is_normalized_substitution(value: Any) -> bool:
    """Return whether `value` is a list of substitutions, which are one text together."""
    return isinstance(value, list) and bool(value) and all(isinstance(each, Substitution) for each in value)


def perform_typed_substitution(context: LaunchContext, value: Any, data_type: Any) -> Any:
    """Return the value that a normalized one, `value`, has in a context.

    Args:
        context: The context.
        value: What `normalize_typed_substitution` has returned.
        data_type: Type of the value; None is what YAML reads.

    Raises:
        ValueTypeError: for texts that do not spell a value of this type.
        LaunchArgumentError: for a value of another type.
    """
    if isinstance(value, ScalarTypesTuple):
        if not is_instance_of(value, data_type):
            raise LaunchArgumentError(f"expected {_named(data_type)}, got {value!r:.60}")
        return value
    if is_normalized_substitution(value):
        return coerce_to_type(perform_substitutions(context, value), data_type)
    if not isinstance(value, list):
        raise LaunchArgumentError(f"expected a value or a list of substitutions, got {value!r:.60}")
    kind, is_list = (None, True) if data_type is None else extract_type(data_type)
    if not is_list:
        raise ValueTypeError(f"expected {_named(data_type)}, got a list")
    found = [
        coerce_to_type(perform_substitutions(context, each), kind) if is_normalized_substitution(each) else each
        for each in value
    ]
    if not is_instance_of(found, data_type):
        raise ValueTypeError(f"expected {_named(data_type)}, got {found!r:.60}")
    return found


def _named(data_type: Any) -> str:
    """Return a type in words."""
    if data_type is None:
        return "a value of YAML"
    kind, is_list = extract_type(data_type)
    return f"a list of {kind.__name__}" if is_list else str(kind.__name__)
