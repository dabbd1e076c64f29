"""examples_rclpy_minimal_*: the smallest programs, with the lines of ROS's."""

from __future__ import annotations

from robolink.action import ActionClient
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.testing import System


def test_publisher_and_subscriber(system: System) -> None:
    system.start("examples_rclpy_minimal_subscriber subscriber_lambda")
    system.start("examples_rclpy_minimal_publisher publisher_local_function")
    system.expect_log('Publishing: "Hello World: 3"', within=2.1)
    system.expect_log('I heard: "Hello World: 3"')


def test_service_and_client(system: System) -> None:
    system.start("examples_rclpy_minimal_client client_async_member_function")
    system.expect_log("service not available, waiting again...")
    system.start("examples_rclpy_minimal_service service_member_function")
    system.expect_log("Incoming request\na: 41 b: 1")
    system.expect_log("Result of add_two_ints: for 41 + 1 = 42")


def test_action_server_and_client(system: System) -> None:
    system.start("examples_rclpy_minimal_action_server server")
    system.start("examples_rclpy_minimal_action_client client")
    for line in ("Sending goal request...", "Goal accepted :)", "Received feedback: [0, 1, 1]"):
        system.expect_log(line)
    system.expect_log("Goal succeeded! Result: [0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55]", within=12.0)


def test_goals_are_cancelled_or_rejected(system: System) -> None:
    system.start("examples_rclpy_minimal_action_server server")
    client = ActionClient(system.node, Fibonacci, "fibonacci")
    goal = system.result(client.send_goal_async(Fibonacci.Goal(order=20)))
    system.run(2.0)
    result = goal.get_result_async()
    system.result(goal.cancel_goal_async())
    assert system.result(result).status == GoalStatus.STATUS_CANCELED
    system.expect_log("Goal canceled")
    assert not system.result(client.send_goal_async(Fibonacci.Goal(order=1000))).accepted
    assert list(
        system.result(system.result(client.send_goal_async(Fibonacci.Goal())).get_result_async()).result.sequence
    ) == [0, 1]
