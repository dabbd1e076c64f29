"""Log what lifecycle_talker publishes, and its transitions.

robolink run lifecycle lifecycle_listener
"""

from __future__ import annotations

from typing import Any

from robolink.interfaces.lifecycle_msgs.msg import TransitionEvent
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class LifecycleListener(Node):
    """A node that logs messages and transitions. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("lc_listener", **options)
        self.create_subscription(String, "lifecycle_chatter", self.on_message, 10)
        self.create_subscription(TransitionEvent, "/lc_talker/transition_event", self.on_transition, 10)

    def on_message(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f"data_callback: {message.data}")

    def on_transition(self, event: TransitionEvent) -> None:
        """Log a transition."""
        states = f"from state {event.start_state.label} to {event.goal_state.label}"
        self.get_logger().info(f"notify callback: Transition {states}")
