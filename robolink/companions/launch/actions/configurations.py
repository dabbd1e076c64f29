"""Actions on launch configurations, which LaunchConfiguration reads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from robolink.companions.launch.bases import Action, LaunchContext, SomeSubstitutionsType
from robolink.companions.launch.utilities import normalize_to_list_of_substitutions, perform_substitutions, performed

_WHICH = "launch_configurations"


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
        context.push(_WHICH)


class PopLaunchConfigurations(Action):
    """End a scope."""

    def execute(self, context: LaunchContext) -> None:
        """End it in `context`."""
        context.pop(_WHICH)


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
        self._kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        """Remove them from `context`."""
        kept = {performed(context, name): performed(context, value) for name, value in self._kept.items()}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)
