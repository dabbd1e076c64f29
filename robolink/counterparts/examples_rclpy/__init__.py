"""Counterparts of the packages examples_rclpy_minimal_*: the smallest programs with topics, services and actions."""

from __future__ import annotations

import contextlib
from typing import Any

import robolink
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.client import Client
from robolink.counterparts.program import pause, wrapped_int64
from robolink.exceptions import ExternalShutdownException
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class MinimalPublisher(Node):
    """A node that publishes a count. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_publisher", **options)
        self.count = 0
        self.topic = self.create_publisher(String, "topic", 10)
        self.create_timer(0.5, self.on_timer)

    def on_timer(self) -> None:
        """Publish the next count."""
        message = String(data=f"Hello World: {self.count}")
        self.topic.publish(message)
        self.get_logger().info(f'Publishing: "{message.data}"')
        self.count += 1


class MinimalSubscriber(Node):
    """A node that logs what it hears. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_subscriber", **options)
        self.create_subscription(String, "topic", self.on_message, 10)

    def on_message(self, message: String) -> None:
        """Log a message."""
        self.get_logger().info(f'I heard: "{message.data}"')


class MinimalService(Node):
    """A node that adds two numbers on request. `options` are those of `Node`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("minimal_service", **options)
        self.create_service(AddTwoInts, "add_two_ints", self.on_request)

    def on_request(self, request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        """Add; a sum beyond 64 bits wraps, as in C++."""
        response.sum = wrapped_int64(request.a + request.b)
        self.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        return response


def run_client(args: list[str] | None = None) -> None:
    """Ask for a sum once the service is there."""
    with robolink.init(args=args), contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        node = Node("minimal_client")
        client: Client = node.create_client(AddTwoInts, "add_two_ints")
        while not client.wait_for_service(timeout_sec=1.0):
            node.get_logger().info("service not available, waiting again...")
        request = AddTwoInts.Request(a=41, b=1)
        future = client.call_async(request)
        robolink.spin_until_future_complete(node, future)
        result = future.result()
        if result is not None:
            sum_ = f"{request.a} + {request.b} = {result.sum}"
            node.get_logger().info(f"Result of add_two_ints: for {sum_}")


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


def run_action_client(args: list[str] | None = None) -> None:
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
