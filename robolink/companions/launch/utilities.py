"""Functions that turn texts and substitutions into lists, and those into text or typed values."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from robolink.companions.launch.bases import LaunchArgumentError, LaunchError, Substitution, entities_in

if TYPE_CHECKING:
    from robolink.companions.launch.bases import LaunchContext, SomeSubstitutionsType

MOST_TEXT = 1_000_000
"""Longest text of a substitution, in characters."""
TRUE, FALSE = ("true", "1"), ("false", "0")
"""Spellings of a boolean."""

normalize_to_list_of_entities = entities_in

__all__ = [
    "LaunchArgumentError",
    "TextSubstitution",
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "is_substitution",
    "is_true",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "perform_substitutions",
    "performed",
]


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
    return [each for part in subs for each in normalize_to_list_of_substitutions(part)]


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
    wanted = tuple(types) if isinstance(types, Iterable) else (types,)
    if not isinstance(argument, wanted):
        names = " or ".join(each.__name__ for each in wanted)
        where = f"{caller}: " if caller else ""
        raise LaunchArgumentError(f"{where}'{argument_name}' is {names}, got {_kind(argument)}")


def is_a(obj: Any, entity_type: type) -> bool:
    """Return whether `obj` is an `entity_type`."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type) -> bool:
    """Return whether `obj` is a class below `entity_type`."""
    return isinstance(obj, type) and issubclass(obj, entity_type)


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
