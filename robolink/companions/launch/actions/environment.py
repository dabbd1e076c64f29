"""Actions on the environment of the processes that are started from there on."""

from __future__ import annotations

import os
from typing import Any

from robolink.companions.launch.bases import Action, LaunchContext, SomeSubstitutionsType
from robolink.companions.launch.typed_values import boolean
from robolink.companions.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions

_WHICH = "environment"


class SetEnvironmentVariable(Action):
    """Set an environment variable.

    Args:
        name: Its name.
        value: Its value.
        **kwargs: `condition`.
    """

    def __init__(self, name: SomeSubstitutionsType, value: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value)

    def execute(self, context: LaunchContext) -> None:
        """Set it in `context`."""
        name = perform_substitutions(context, self.name)
        context.environment[name] = perform_substitutions(context, self.value)


class AppendEnvironmentVariable(Action):
    """Add to an environment variable, such as a list of folders.

    Args:
        name: Its name.
        value: What is added.
        prepend: True adds it in front.
        separator: Text between the values.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        name: SomeSubstitutionsType,
        value: SomeSubstitutionsType,
        prepend: bool | SomeSubstitutionsType = False,
        separator: SomeSubstitutionsType = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name, self.value = normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value)
        self.separator = normalize_to_list_of_substitutions(separator)
        self.prepend = prepend

    def execute(self, context: LaunchContext) -> None:
        """Add it in `context`."""
        name, value, between = (
            perform_substitutions(context, each) for each in (self.name, self.value, self.separator)
        )
        before = context.environment.get(name, "")
        parts = [value, before] if boolean(context, self.prepend) else [before, value]
        context.environment[name] = between.join(filter(None, parts))


class UnsetEnvironmentVariable(Action):
    """Remove an environment variable.

    Args:
        name: Its name.
        **kwargs: `condition`.
    """

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        """Remove it from `context`."""
        context.environment.pop(perform_substitutions(context, self.name), None)


class PushEnvironment(Action):
    """Begin a scope: what is set from here on ends with PopEnvironment."""

    def execute(self, context: LaunchContext) -> None:
        """Begin it in `context`."""
        context.push(_WHICH)


class PopEnvironment(Action):
    """End a scope."""

    def execute(self, context: LaunchContext) -> None:
        """End it in `context`."""
        context.pop(_WHICH)


class ResetEnvironment(Action):
    """Set the environment back to the launcher's."""

    def execute(self, context: LaunchContext) -> None:
        """Do it in `context`."""
        context.reset_environment()
