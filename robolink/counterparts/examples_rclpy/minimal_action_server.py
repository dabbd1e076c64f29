"""Compute Fibonacci's numbers as the action /fibonacci, one a second."""

from __future__ import annotations

from typing import Any

from robolink.action import ActionServer, CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.program import pause
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.node import Node

PERIOD = 1.0
"""Time for each number, in seconds."""
LARGEST_ORDER = 46
"""Largest order whose numbers fit into 32 bits."""


class MinimalActionServer(Node):
    """A node that computes numbers on request, several requests at a time. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_action_server", **options)
        self._group = ReentrantCallbackGroup()
        ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            self.execute,
            callback_group=self._group,
            goal_callback=self.on_goal,
            cancel_callback=self.on_cancel,
        )

    def on_goal(self, goal: Fibonacci.Goal) -> GoalResponse:
        """Accept a goal whose numbers a message can have."""
        self.get_logger().info("Received goal request")
        return GoalResponse.ACCEPT if goal.order <= LARGEST_ORDER else GoalResponse.REJECT

    def on_cancel(self, goal_handle: ServerGoalHandle) -> CancelResponse:
        """Accept that a goal is cancelled."""
        self.get_logger().info("Received cancel request")
        return CancelResponse.ACCEPT

    async def execute(self, goal_handle: ServerGoalHandle) -> Fibonacci.Result:
        """Publish one number after the other."""
        self.get_logger().info("Executing goal...")
        feedback = Fibonacci.Feedback(sequence=[0, 1])
        for _ in range(1, goal_handle.request.order):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                self.get_logger().info("Goal canceled")
                return Fibonacci.Result()
            feedback.sequence.append(feedback.sequence[-1] + feedback.sequence[-2])
            self.get_logger().info(f"Publishing feedback: {feedback.sequence}")
            goal_handle.publish_feedback(feedback)
            await pause(self, PERIOD, self._group)
        goal_handle.succeed()
        result = Fibonacci.Result(sequence=feedback.sequence)
        self.get_logger().info(f"Returning result: {result.sequence}")
        return result
