"""Values of launch files (`launch.utilities`): texts, substitutions and types, of what people write in any form."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import yaml

from robolink.arguments.parameter_file import parse_scalar
from robolink.launch.ros.launch.bases import (
    LaunchArgumentError,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeEntitiesType,
    SomeSubstitutionsType,
    Substitution,
    entities_in,
)
from robolink.launch.ros.launch.signals import AsyncSafeSignalManager
from robolink.system.terminal import shown

if TYPE_CHECKING:
    import asyncio


__all__ = [
    "AsyncSafeSignalManager",
    "LaunchArgumentError",
    "TextSubstitution",
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "is_substitution",
    "is_true",
    "isclassinstance",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "performed",
    "visit_all_entities_and_collect_futures",
]


MOST_TEXT = 1_000_000
"""Longest text of a substitution, in characters."""
TRUE, FALSE = ("true", "1"), ("false", "0")
"""Spellings of a boolean."""


def normalize_to_list_of_entities(entities: Iterable[SomeEntitiesType]) -> list[LaunchDescriptionEntity]:
    """Return `entities`, of which some may be lists of such, as one list."""
    return [each for some in entities for each in entities_in(some)]


class TextSubstitution(Substitution):
    """Fixed text.

    Args:
        text: The text.
    """

    def __init__(self, *, text: str) -> None:
        if not isinstance(text, str):
            raise LaunchArgumentError(f"TextSubstitution(text=...) takes a text, got {_kind(text)}")
        self.text = text

    def perform(self, context: LaunchContext) -> str:
        """Return the text."""
        return self.text

    def describe(self) -> str:
        """Return the text in quotes."""
        return f"'{self.text}'"


def normalize_to_list_of_substitutions(subs: SomeSubstitutionsType) -> list[Substitution]:
    """Return a text, a path, a substitution or several of these, `subs`, as a list of substitutions.

    Raises LaunchArgumentError for anything else.
    """
    if isinstance(subs, Substitution):
        return [subs]
    if isinstance(subs, (str, os.PathLike)):
        return [TextSubstitution(text=os.fspath(subs))]
    if not isinstance(subs, Iterable) or isinstance(subs, (bytes, dict)):
        raise LaunchArgumentError(f"expected a text or a substitution, got {_kind(subs)}")
    parts = list(subs)
    for each in parts:
        if not isinstance(each, (str, os.PathLike, Substitution)):  # ROS 2 takes no lists within lists either
            raise LaunchArgumentError(f"expected a text or a substitution, got {_kind(each)}")
    return [each for part in parts for each in normalize_to_list_of_substitutions(part)]


def perform_substitutions(context: LaunchContext, subs: Iterable[Substitution]) -> str:
    """Return the texts of `subs`, joined, with the values of `context`.

    Raises LaunchError for more than `MOST_TEXT` characters.
    """
    parts, length = [], 0
    for each in subs:
        part = each.perform(context)
        if not isinstance(part, str):
            raise LaunchArgumentError(f"{type(each).__name__} became {_kind(part)}, and a text was expected")
        length += len(part)
        if length > MOST_TEXT:
            raise LaunchError(f"with each substitution performed this has more than {MOST_TEXT:,} characters")
        parts.append(part)
    return "".join(parts)


def performed(context: LaunchContext, subs: SomeSubstitutionsType) -> str:
    """Return the text of anything that stands for one, `subs`, with the values of `context`."""
    return subs if isinstance(subs, str) else perform_substitutions(context, normalize_to_list_of_substitutions(subs))


def is_true(context: LaunchContext, subs: SomeSubstitutionsType | bool) -> bool:
    """Return a boolean, or the one that the text of `subs` spells with the values of `context`.

    Raises LaunchError for another text than true, false, 1 and 0.
    """
    if isinstance(subs, bool):
        return subs
    text = performed(context, subs).strip().lower()
    if text not in (*TRUE, *FALSE):
        raise LaunchError(f"expected true, false, 1 or 0, got '{text}'")
    return text in TRUE


def ensure_argument_type(argument: Any, types: Any, argument_name: str, caller: str | None = None) -> None:
    """Raise LaunchArgumentError unless `argument` is of one of these types.

    Args:
        argument: The value.
        types: A type, or several.
        argument_name: Its name, for the error.
        caller: Name of the function, for the error.
    """
    expected = tuple(types) if isinstance(types, Iterable) else (types,)
    if not isinstance(argument, expected):
        names = " or ".join(each.__name__ for each in expected)
        where = f"{caller}: " if caller else ""
        raise LaunchArgumentError(f"{where}'{argument_name}' is {names}, got {_kind(argument)}")


def isclassinstance(obj: Any) -> bool:
    """Return whether `obj` has a class, as all that Python 3 has."""
    return hasattr(obj, "__class__")


def is_a(obj: Any, entity_type: type) -> bool:
    """Return whether `obj` is an `entity_type`."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type) -> bool:
    """Return whether `obj` is an `entity_type`, or a class of such."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))


def visit_all_entities_and_collect_futures(
    entity: LaunchDescriptionEntity, context: LaunchContext
) -> list[tuple[LaunchDescriptionEntity, asyncio.Future[Any]]]:
    """Visit `entity` in `context`, and what that brings along, depth first; return those that have a future, and it.

    A LaunchService visits by itself, and starts what it visits; this starts nothing.
    """
    inside = entity.visit(context)
    future = entity.get_asyncio_future()
    own = [] if future is None else [(entity, future)]
    return [*own, *(pair for each in inside or () for pair in visit_all_entities_and_collect_futures(each, context))]


def is_substitution(value: Any) -> bool:
    """Return whether `value` is a substitution, or a sequence of texts with at least one."""
    if isinstance(value, Substitution):
        return True
    if not isinstance(value, Sequence) or isinstance(value, (str, bytes)):
        return False
    is_text = all(isinstance(each, (str, Path, Substitution)) for each in value)
    return is_text and any(isinstance(each, Substitution) for each in value)


def _kind(value: Any) -> str:
    return f"{type(value).__name__} ({value!r:.60})"


SCALARS = (bool, int, float, str)
"""Types of a parameter's scalars."""
AS_TEXT = "ParameterValue(..., value_type=str) keeps it a text"


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


def coerced(text: str, expected: type[bool | int | float]) -> bool | int | float:
    """Return `text` as a value of the type `expected`. Raises LaunchError for a text that is not of it."""
    try:
        return truth_of(text) if expected is bool else expected(text)
    except ValueError:
        raise LaunchError(f"expected {expected.__name__}, got '{shown(text)}'") from None


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
