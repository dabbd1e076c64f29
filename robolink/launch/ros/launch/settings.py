"""Actions that declare arguments, and that set launch configurations and the environment (`launch.actions`)."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any

from robolink.exceptions import nearest
from robolink.launch.ros.launch.bases import Action, LaunchContext, LaunchError, SomeSubstitutionsType
from robolink.launch.ros.launch.utilities import (
    boolean,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    performed,
)
from robolink.system.terminal import shown

_CONFIGURATIONS = "launch_configurations"


class SetLaunchConfiguration(Action):
    """Set a launch configuration.

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
        context.launch_configurations[name] = perform_substitutions(context, self.value)


class UnsetLaunchConfiguration(Action):
    """Remove a launch configuration.

    Args:
        name: Its name.
        **kwargs: `condition`.
    """

    def __init__(self, name: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)

    def execute(self, context: LaunchContext) -> None:
        """Remove it from `context`."""
        context.launch_configurations.pop(perform_substitutions(context, self.name), None)


class PushLaunchConfigurations(Action):
    """Begin a scope: what is set from here on ends with PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        """Begin it in `context`."""
        context.push(_CONFIGURATIONS)


class PopLaunchConfigurations(Action):
    """End a scope."""

    def execute(self, context: LaunchContext) -> None:
        """End it in `context`."""
        context.pop(_CONFIGURATIONS)


class ResetLaunchConfigurations(Action):
    """Remove all launch configurations but some.

    Args:
        launch_configurations: Those that are set afterwards, by name; their values may use the ones before.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self._retained = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        """Remove them from `context`."""
        retained = {performed(context, name): performed(context, value) for name, value in self._retained.items()}
        context.launch_configurations.clear()
        context.launch_configurations.update(retained)


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
        self.name, self.about = name, description or ""
        self.default_value = None if default_value is None else normalize_to_list_of_substitutions(default_value)
        self.choices = None if choices is None else list(choices)
        if self.choices is not None and isinstance(default_value, str) and default_value not in self.choices:
            raise LaunchError(
                f"'{name}': the default '{shown(default_value)}' is not in provided choices {self.choices}"
            )

    @property
    def description(self) -> str:
        """Description for people, with the choices."""
        if self.choices is None:
            return self.about or self.NO_DESCRIPTION
        if not self.about:
            return f"One of: {self.choices}"
        return f"{self.about.removesuffix('.')}. Valid choices are: {self.choices}"

    def execute(self, context: LaunchContext) -> None:
        """Set the default value in `context` if none was given; raises LaunchError for a value that is not a choice."""
        known = context.launch_configurations
        context.requested.add(self.name)
        if self.name not in known:
            if self.default_value is None:
                about = f" ({shown(self.about)})" if self.about else ""
                raise LaunchError(f"'{self.name}' must be given{about}: {self.name}:=VALUE")
            known[self.name] = perform_substitutions(context, self.default_value)
        value = known[self.name]
        if self.choices is not None and value not in self.choices:
            allowed = ", ".join(self.choices)
            raise LaunchError(f"'{self.name}' is one of {allowed}, got '{shown(value)}'{nearest(value, self.choices)}")


class DeclareBooleanLaunchArgument(DeclareLaunchArgument):
    """Launch argument that is true or false.

    Args:
        name: Name of the argument.
        default_value: Value where none is given; without one it must be given.
        **kwargs: `description` and `condition`.
    """

    def __init__(self, name: str, *, default_value: bool | SomeSubstitutionsType | None = None, **kwargs: Any) -> None:
        default = str(default_value) if isinstance(default_value, bool) else default_value
        choices = ["true", "false", "True", "False", "TRUE", "FALSE"]
        super().__init__(name, default_value=default, choices=choices, **kwargs)


_ENVIRONMENT = "environment"


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
        context.push(_ENVIRONMENT)


class PopEnvironment(Action):
    """End a scope."""

    def execute(self, context: LaunchContext) -> None:
        """End it in `context`."""
        context.pop(_ENVIRONMENT)


class ResetEnvironment(Action):
    """Set the environment back to the launcher's."""

    def execute(self, context: LaunchContext) -> None:
        """Do it in `context`."""
        context.reset_environment()
