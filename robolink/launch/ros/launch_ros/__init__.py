"""launch_ros: the actions and substitutions of ROS 2's launch files that are about nodes and packages."""

from __future__ import annotations

from robolink.launch.ros.launch_ros import (
    actions,
    descriptions,
    events,
    parameter_descriptions,
    substitutions,
    utilities,
)
from robolink.launch.ros.launch_ros import events as event_handlers

__all__ = [
    "actions",
    "descriptions",
    "event_handlers",
    "events",
    "parameter_descriptions",
    "substitutions",
    "utilities",
]
