"""launch: ROS 2's launch descriptions, which `robolink launch FILE.launch.py` reads.

The actions, substitutions and conditions have ROS 2's names and arguments. They describe; robolink's own launcher
starts the processes and reacts to their events. A `LaunchService` of a program of its own is not there: the file is
run by `robolink launch`.
"""

from __future__ import annotations

from typing import Any

from robolink.launch.ros.launch import actions, conditions, event_handlers, events, substitutions, utilities
from robolink.launch.ros.launch import sources as launch_description_sources
from robolink.launch.ros.launch.bases import (
    Action,
    Condition,
    Event,
    EventHandler,
    LaunchContext,
    LaunchDescriptionEntity,
    LaunchError,
    SomeActionsType,
    SomeEntitiesType,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
    Substitution,
)
from robolink.launch.ros.launch.sources import (
    InvalidLaunchFileError,
    LaunchDescription,
    LaunchDescriptionSource,
    LaunchIntrospector,
)

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeActionsType",
    "SomeEntitiesType",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "actions",
    "conditions",
    "event_handlers",
    "events",
    "launch_description_sources",
    "substitutions",
    "utilities",
]


class LaunchService:
    """Launcher within a program, which robolink has not: `robolink launch FILE` runs a launch file.

    Args:
        *args, **kwargs: Those of ROS 2, of no effect.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self.context = LaunchContext()

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Refuse to launch `launch_description`: raises LaunchError."""
        raise LaunchError("there is no LaunchService here: run the launch file by 'robolink launch FILE'")

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Refuse: raises LaunchError. `shutdown_when_idle` is of no effect."""
        raise LaunchError("there is no LaunchService here: run the launch file by 'robolink launch FILE'")
