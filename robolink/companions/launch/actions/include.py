"""Inclusion of another launch file."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from robolink.companions.launch.actions.configurations import SetLaunchConfiguration
from robolink.companions.launch.bases import (
    Action,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeSubstitutionsType,
)
from robolink.companions.launch.described import DEEPEST, FILES, circle
from robolink.companions.launch.launch_description_sources import AnyLaunchDescriptionSource, LaunchDescriptionSource


class IncludeLaunchDescription(Action):
    """Another launch file, or another description, with arguments.

    Args:
        launch_description_source: The source, or the path of a file of any kind.
        launch_arguments: Its arguments, as pairs of name and value; what they set goes on behind it, as in ROS 2.
        **kwargs: `condition`.
    """

    def __init__(
        self,
        launch_description_source: LaunchDescriptionSource | SomeSubstitutionsType,
        *,
        launch_arguments: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        is_source = isinstance(launch_description_source, LaunchDescriptionSource)
        self.launch_description_source: LaunchDescriptionSource = (
            launch_description_source if is_source else AnyLaunchDescriptionSource(launch_description_source)  # type: ignore[arg-type,assignment]
        )
        self.launch_arguments = list(launch_arguments or ())

    def get_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the description if its path is known before the launch runs."""
        found = self.launch_description_source.try_get_launch_description_without_context()
        return [] if found is None else [found]

    def execute(self, context: LaunchContext) -> list[LaunchDescriptionEntity]:
        """Read the file with the values of `context`; return its arguments and its description."""
        source = self.launch_description_source
        around = context.get_locals_as_dict()
        chain: tuple[str, ...] = around.get("launch_files", ())
        description = source.get_launch_description(context)
        if not Path(source.location).is_file():
            return [*(SetLaunchConfiguration(*each) for each in self.launch_arguments), description]
        path = os.path.abspath(source.location)  # noqa: PTH100 - a link stays a link
        if circle(chain, path):
            raise LaunchError(circle(chain, path))
        if len(chain) > DEEPEST:
            raise LaunchError(f"launch files are included over {DEEPEST} deep")
        arguments = [SetLaunchConfiguration(*each) for each in self.launch_arguments]
        own = {FILES[0]: path, FILES[1]: str(Path(path).parent), "launch_files": (*chain, path)}
        back = {name: around.get(name) for name in own if name in around}
        # ROS 2 performs an argument's value where the included file counts already: ThisLaunchFileDir is its folder.
        return [_Locals(own), *arguments, description, _Locals(back)]


class _Locals(Action):
    """Set locals of the context."""

    def __init__(self, values: dict[str, Any]) -> None:
        super().__init__()
        self._values = values

    def execute(self, context: LaunchContext) -> None:
        context.extend_locals(self._values)
