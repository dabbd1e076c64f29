"""Events about nodes (`launch_ros.events`)."""

from robolink.companions.launch_ros.events import lifecycle, matchers

__all__ = ["lifecycle", "matchers"]
