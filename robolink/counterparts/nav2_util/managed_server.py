"""Managed nodes that serve actions: what each of Nav2's servers does in its transitions."""

from __future__ import annotations

from typing import Any

from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn


class ManagedServer(LifecycleNode):
    """A managed node whose actions take goals while it is active, and which withdraws all that it offers at the end.

    A subclass makes its parts in `on_configure`, its action servers into `actions`, and destroys the others in
    `withdraw`. That is called also by a configuration that fails half way.
    """

    def __init__(self, node_name: str, **options: Any) -> None:
        """Create a server that is not configured.

        Args:
            node_name: Name of the node.
            options: Options of `Node`.
        """
        super().__init__(node_name, **options)
        self.actions: list[SimpleActionServer] = []

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Take goals from now on."""
        self.get_logger().info("Activating")
        for each in self.actions:
            each.activate()
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Take no more goals, and end those that are there."""
        self.get_logger().info("Deactivating")
        for each in self.actions:
            each.deactivate()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is offered."""
        self.get_logger().info("Cleaning up")
        self.withdraw()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Withdraw what is left."""
        self.get_logger().info("Shutting down")
        self.withdraw()
        return TransitionCallbackReturn.SUCCESS

    def withdraw(self) -> None:
        """Destroy the action servers; again is allowed."""
        for each in self.actions:
            each.destroy()
        self.actions = []
