"""launch: ROS 2's launch descriptions, which `robolink launch FILE.launch.py` reads.

The actions, substitutions and conditions have ROS 2's names and arguments. They describe; robolink's own launcher
starts the processes and reacts to their events. A `LaunchService` runs a description in a program of its own.
"""

from __future__ import annotations

from robolink.launch.ros.launch import actions, conditions, event_handlers, events, substitutions, utilities
from robolink.launch.ros.launch import sources as launch_description_sources
from robolink.launch.ros.launch.bases import (
    Action,
    Condition,
    Event,
    EventHandler,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeActionsType,
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
    Substitution,
)
from robolink.launch.ros.launch.launch_service import LaunchService
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
    "SomeEntitiesType_types_tuple",
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
