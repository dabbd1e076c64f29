"""Substitutions that spell a boolean, or choose by one (`launch.substitutions`)."""

from __future__ import annotations

import math
from typing import Any

from robolink.launch.ros.launch.bases import (
    LaunchContext,
    LaunchError,
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
)
from robolink.launch.ros.launch.utilities import (
    FALSE,
    TRUE,
    boolean,
    is_substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class NotSubstitution(Substitution):
    """The opposite of a boolean.

    Args:
        value: Text that spells a boolean.
    """

    def __init__(self, value: SomeSubstitutionsType) -> None:
        self.value = normalize_to_list_of_substitutions(value)

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(not _truth(context, self.value))


class AllSubstitution(Substitution):
    """True if all booleans are, also if there is none.

    Args:
        *args: Texts that spell booleans.
    """

    def __init__(self, *args: SomeSubstitutionsType) -> None:
        self.args = [normalize_to_list_of_substitutions(each) for each in args]

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(all(self._truths(context)))

    def _truths(self, context: LaunchContext) -> list[bool]:
        """Return all the booleans: each text must spell one, wherever it stands."""
        return [_truth(context, each) for each in self.args]


class AnySubstitution(AllSubstitution):
    """True if one of the booleans is; false if there is none."""

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(any(self._truths(context)))


class AndSubstitution(AllSubstitution):
    """True if both booleans are.

    Args:
        left, right: Texts that spell booleans.
    """

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


class OrSubstitution(AnySubstitution):
    """True if one of two booleans is.

    Args:
        left, right: Texts that spell booleans.
    """

    def __init__(self, left: SomeSubstitutionsType, right: SomeSubstitutionsType) -> None:
        super().__init__(left, right)
        self.left, self.right = self.args


class EqualsSubstitution(Substitution):
    """True if two values are the same: as booleans if both spell one, as numbers if both are, else as texts.

    Args:
        left, right: Texts, substitutions or plain values.
    """

    def __init__(self, left: Any, right: Any) -> None:
        self.left, self.right = _as_list(left), _as_list(right)

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(self._are_equal(context))

    def _are_equal(self, context: LaunchContext) -> bool:
        left, right = (perform_substitutions(context, each) for each in (self.left, self.right))
        if {left.lower(), right.lower()} <= {*TRUE, *FALSE}:
            return (left.lower() in TRUE) == (right.lower() in TRUE)
        try:
            return math.isclose(float(left), float(right))
        except ValueError:
            return left == right


class NotEqualsSubstitution(EqualsSubstitution):
    """True if two values differ."""

    def perform(self, context: LaunchContext) -> str:
        """Return true or false."""
        return _spelled(not self._are_equal(context))


class IfElseSubstitution(Substitution):
    """One of two texts.

    Args:
        condition: Text that spells a boolean.
        if_value: Text where it is true.
        else_value: Text where it is false.
    """

    def __init__(
        self,
        condition: SomeSubstitutionsType,
        if_value: SomeSubstitutionsType = "",
        else_value: SomeSubstitutionsType = "",
    ) -> None:
        if if_value == else_value == "":
            raise SubstitutionFailure("IfElseSubstitution needs an if_value or an else_value")
        self.condition, self.if_value, self.else_value = map(
            normalize_to_list_of_substitutions, (condition, if_value, else_value)
        )

    def perform(self, context: LaunchContext) -> str:
        """Return the text that counts."""
        return perform_substitutions(context, self.if_value if _truth(context, self.condition) else self.else_value)


def _truth(context: LaunchContext, subs: SomeSubstitutionsType) -> bool:
    """Return the boolean that the text of `subs` spells. Raises SubstitutionFailure."""
    try:
        return boolean(context, subs)
    except LaunchError as error:
        raise SubstitutionFailure(str(error)) from None


def _spelled(value: bool) -> str:
    return "true" if value else "false"


def _as_list(value: Any) -> list[Substitution]:
    if is_substitution(value):
        return normalize_to_list_of_substitutions(value)
    text = "" if value is None else _spelled(value) if isinstance(value, bool) else str(value)
    return normalize_to_list_of_substitutions(text)
