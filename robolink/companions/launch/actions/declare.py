"""Declaration of a launch argument."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robolink.companions.launch.bases import Action, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.companions.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from robolink.exceptions import nearest
from robolink.system.terminal import shown


class DeclareLaunchArgument(Action):
    """Launch argument, which `LaunchConfiguration` reads.

    Args:
        name: Name of the argument.
        default_value: Value where none is given; without one it must be given.
        description: Description for people.
        choices: The values that are allowed; None allows all.
        **kwargs: `condition`.
    """

    NO_DESCRIPTION = "no description given"

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeSubstitutionsType | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name, self.description = name, description or self.NO_DESCRIPTION
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.choices = None if choices is None else list(choices)

    def execute(self, context: LaunchContext) -> None:
        """Set the default value in `context` if none was given; raises LaunchError for a value that is no choice."""
        known = context.launch_configurations
        context.asked.add(self.name)
        if self.name not in known:
            if self.default_value is None:
                about = "" if self.description == self.NO_DESCRIPTION else f" ({shown(self.description)})"
                raise LaunchError(f"'{self.name}' must be given{about}: {self.name}:=VALUE")
            known[self.name] = perform_substitutions(context, self.default_value)
        value = known[self.name]
        if self.choices is not None and value not in self.choices:
            allowed = ", ".join(self.choices)
            raise LaunchError(f"'{self.name}' is one of {allowed}, got '{shown(value)}'{nearest(value, self.choices)}")
