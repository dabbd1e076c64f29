"""launch_ros: the actions and substitutions of ROS 2's launch files that are about nodes and packages."""

from robolink.companions.launch_ros import (
    actions,
    descriptions,
    event_handlers,
    events,
    parameter_descriptions,
    substitutions,
)

__all__ = ["actions", "descriptions", "event_handlers", "events", "parameter_descriptions", "substitutions"]
