"""Conditions of actions (`launch.conditions`)."""

from __future__ import annotations

import warnings

from robolink.launch.ros.launch.bases import Condition, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.launch.ros.launch.inner_names import inner_names
from robolink.launch.ros.launch.utilities import (
    is_true,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    performed,
)

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]


class InvalidConditionExpressionError(LaunchError):
    """A condition is neither true nor false."""


def evaluate_condition_expression(context: LaunchContext, expression: SomeSubstitutionsType) -> bool:
    """Return the decision of a text, `expression`, with the values of `context`.

    Raises InvalidConditionExpressionError for another text than true, false, 1 and 0.
    """
    text = performed(context, expression)
    try:
        return is_true(context, text)
    except LaunchError as error:
        raise InvalidConditionExpressionError(str(error)) from None


@inner_names(predicate_expression="_expression")
class IfCondition(Condition):
    """True if a text is true or 1; anything but true, 1, false and 0 is an error.

    Args:
        predicate_expression: The text.
    """

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: evaluate_condition_expression(context, self._expression))


@inner_names(predicate_expression="_expression")
class UnlessCondition(Condition):
    """True if a text is false or 0.

    Args:
        predicate_expression: The text.
    """

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=lambda context: not evaluate_condition_expression(context, self._expression))


class LaunchConfigurationEquals(Condition):
    """True if a launch configuration has a value; deprecated, as in ROS 2: it warns.

    Args:
        launch_configuration_name: Name of the configuration.
        expected_value: The value; None stands for one that is not set.
    """

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        instead = "use IfCondition(EqualsSubstitution(...)), IfCondition(NotEqualsSubstitution(...))"
        warnings.warn(f"{type(self).__name__} is deprecated: {instead}", UserWarning, stacklevel=2)
        self._name = launch_configuration_name
        self._value = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=self._is_equal)

    def _is_equal(self, context: LaunchContext) -> bool:
        expected = None if self._value is None else perform_substitutions(context, self._value)
        return bool(context.launch_configurations.get(self._name) == expected)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True if a launch configuration has another value."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Return the decision with the values of `context`."""
        return not super().evaluate(context)
