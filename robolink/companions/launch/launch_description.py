"""Launch descriptions: the list of what is to be done, and the arguments that it declares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

from robolink.companions.launch.actions.declare import DeclareLaunchArgument
from robolink.companions.launch.bases import LaunchContext, LaunchDescriptionEntity
from robolink.companions.launch.described import Described, described


class LaunchDescription(LaunchDescriptionEntity):
    """List of what is to be done.

    Args:
        initial_entities: The actions and descriptions in it.
        deprecated_reason: Reason why it should not be used any more; None for none.
    """

    def __init__(
        self,
        initial_entities: Iterable[LaunchDescriptionEntity] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.entities = list(initial_entities or ())
        self.deprecated_reason = deprecated_reason

    @property
    def deprecated(self) -> bool:
        """True if it should not be used any more."""
        return self.deprecated_reason is not None

    def add_entity(self, entity: LaunchDescriptionEntity) -> None:
        """Add an action or a description, `entity`."""
        self.entities.append(entity)

    def add_action(self, action: LaunchDescriptionEntity) -> None:
        """Add an `action`."""
        self.entities.append(action)

    def describe_sub_entities(self) -> list[LaunchDescriptionEntity]:
        """Return the entities in it."""
        return list(self.entities)

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities in it."""
        return list(self.entities)

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[Any]:
        """Return the DeclareLaunchArgument actions in it, and in what it holds and includes, each name once.

        Args:
            conditional_inclusion: True if the description itself is there only on a condition; of no effect here.
        """
        found: dict[str, DeclareLaunchArgument] = {}
        for each in _described(self):
            if isinstance(each, DeclareLaunchArgument):
                found.setdefault(each.name, each)
        return list(found.values())


class LaunchIntrospector:
    """Printer of launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the actions in `launch_description`, and in what it holds and includes, one a line."""
        return "\n".join(each.describe() for each in _described(launch_description))


def _described(top: LaunchDescription) -> Iterator[LaunchDescriptionEntity]:
    return (each.entity for each in described(Described(top), LaunchContext()))
