"""Actions that repeat what a function of the launch file returns."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from robolink.companions.launch.bases import (
    Action,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.companions.launch.utilities import LaunchArgumentError, normalize_to_list_of_substitutions, performed
from robolink.documents.yamlfile import parse
from robolink.exceptions import DocumentError
from robolink.system.terminal import shown

MOST = 10_000
"""Most repetitions."""
LONGEST_NUMBER = 100
"""Longest text of a number of repetitions, in characters."""
_LENGTH = "the length of a loop is a number from 0 on"
Function = Callable[..., Iterable[LaunchDescriptionEntity] | None]


class ForEach(Action):
    """Entities for each of several mappings.

    Args:
        input_values: Text with the mappings in YAML, parted by semicolons: ``{name: ada, x: 1.0}; {name: bob}``.
        function: Function that gets the values of a mapping by their names, and returns entities.
        **kwargs: `condition`.
    """

    def __init__(self, input_values: SomeSubstitutionsType, *, function: Function, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.input_values, self.function = normalize_to_list_of_substitutions(input_values), _checked(function)

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities for the values in `context`. Raises LaunchError for what is not a mapping."""
        texts = [each for each in performed(context, self.input_values).split(";") if each.strip()]
        _check_count(len(texts))
        return [each for text in texts for each in self.function(**_mapping(text)) or ()]


class ForLoop(Action):
    """Entities for each of the numbers 0, 1, 2 and so on.

    Args:
        length: How many numbers.
        function: Function that gets a number, `i`, and returns entities.
        name: Name of the number for people.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        length: int | SomeSubstitutionsType,
        *,
        function: Function,
        name: SomeSubstitutionsType | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.length, self.function, self.name = length, _checked(function), name

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return the entities for the length in `context`. Raises LaunchError for a length that is not a number."""
        length = self.length if isinstance(self.length, int) else _length(performed(context, self.length))
        if length < 0:
            raise LaunchError(f"{_LENGTH}, got one below")
        _check_count(length)
        return [each for number in range(length) for each in self.function(number) or ()]


def _checked(function: Function) -> Function:
    if not callable(function):
        raise LaunchArgumentError(f"function takes a function, got {type(function).__name__}")
    return function


def _length(text: str) -> int:
    """Return the number that a text spells as Python does, as in ROS 2: ` 5 `, `+5`, `1_000` and `05` are numbers."""
    text = text.strip()
    try:
        if len(text) <= LONGEST_NUMBER:  # a million digits would take their time
            return int(text)
    except ValueError:
        pass
    raise LaunchError(f"{_LENGTH}, got '{shown(text, 60)}'")


def _check_count(count: int) -> None:
    if count > MOST:
        raise LaunchError(f"more than {MOST:,} repetitions")


def _mapping(text: str) -> dict[str, Any]:
    try:
        found = parse(text, name="")
    except DocumentError as error:
        raise LaunchError(f"'{shown(text.strip(), 60)}' is not YAML: {error.message}") from None
    if not isinstance(found, dict):
        raise LaunchError(f"a mapping such as {{name: ada}} is expected, got '{shown(text.strip(), 60)}'")
    return found
