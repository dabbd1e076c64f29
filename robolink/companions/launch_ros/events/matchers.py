"""Functions that decide which node an event means (`launch_ros.events.matchers`)."""

from robolink.companions.launch_ros.events.lifecycle import matches_node_name

__all__ = ["matches_node_name"]
