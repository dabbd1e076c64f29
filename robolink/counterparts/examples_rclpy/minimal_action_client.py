"""Ask the action /fibonacci for ten numbers, and log what comes."""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.action import ActionClient
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.node import Node


def main(args: list[str] | None = None) -> None:
    """Send a goal, and wait for its result."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node("minimal_action_client")
        goal = _accepted(node)
        if goal is None:
            return
        future = goal.get_result_async()
        robolink.spin_until_future_complete(node, future)
        answer: Any = future.result()
        if answer.status == GoalStatus.STATUS_SUCCEEDED:
            node.get_logger().info(f"Goal succeeded! Result: {list(answer.result.sequence)}")
        else:
            node.get_logger().info(f"Goal failed with status: {answer.status}")


def _accepted(node: Node) -> Any:
    """Send the goal; return its handle, None if it is rejected."""
    logger = node.get_logger()
    client = ActionClient(node, Fibonacci, "fibonacci")
    logger.info("Waiting for action server...")
    client.wait_for_server()
    logger.info("Sending goal request...")

    def on_feedback(message: Any) -> None:
        logger.info(f"Received feedback: {list(message.feedback.sequence)}")

    future = client.send_goal_async(Fibonacci.Goal(order=10), feedback_callback=on_feedback)
    robolink.spin_until_future_complete(node, future)
    goal = future.result()
    if goal is None or not goal.accepted:
        logger.info("Goal rejected :(")
        return None
    logger.info("Goal accepted :)")
    return goal


if __name__ == "__main__":
    main()
