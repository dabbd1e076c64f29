"""Groups of actions, with a scope of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from robolink.companions.launch.actions.configurations import (
    PopLaunchConfigurations,
    PushLaunchConfigurations,
    ResetLaunchConfigurations,
    SetLaunchConfiguration,
)
from robolink.companions.launch.actions.environment import PopEnvironment, PushEnvironment, ResetEnvironment
from robolink.companions.launch.bases import Action, LaunchContext, LaunchDescriptionEntity, SomeSubstitutionsType


class GroupAction(Action):
    """Several actions; what they set ends with the group.

    Args:
        actions: The actions.
        scoped: False lets what they set go on behind the group.
        forwarding: False lets them see none of the configurations and variables set before the group.
        launch_configurations: Configurations for the group, by name.
        **left_over_kwargs: `condition`.
    """

    def __init__(
        self,
        actions: Iterable[LaunchDescriptionEntity],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
        **left_over_kwargs: Any,
    ) -> None:
        super().__init__(**left_over_kwargs)
        self._actions = list(actions)
        self._scoped, self._forwarding = scoped, forwarding
        self._configurations = dict(launch_configurations or {})

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return its actions, with those that begin and end the scope."""
        if not self._scoped or self._forwarding:
            own: list[Action] = [SetLaunchConfiguration(name, value) for name, value in self._configurations.items()]
        else:
            own = [ResetEnvironment(), ResetLaunchConfigurations(self._configurations)]
        inside = [*own, *self._actions]
        if not self._scoped:
            return inside
        before, behind = [PushLaunchConfigurations(), PushEnvironment()], [PopEnvironment(), PopLaunchConfigurations()]
        return [*before, *inside, *behind]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Return its actions."""
        return self.get_sub_entities()
