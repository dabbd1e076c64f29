"""Actions in callbacks that block and in callers that wait."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context, Future, Node
from robolink.action import ActionClient, ActionServer, GoalResponse
from robolink.action.client import LATELY, ClientGoalHandle
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.exceptions import ServiceError
from robolink.executors import MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.goals import CANCELED, PATIENCE, SUCCEEDED, Waiting, accept, accepted, fibonacci
from tests.support.spins import done, spin_for, spin_until

# --- Callbacks that block -------------------------------------------------------------------------------------------


def test_a_blocking_callback_is_cancelled_where_there_are_several_threads(context: Context) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    began = threading.Event()
    heard: list[Any] = []

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        turns = 0
        while not handle.is_cancel_requested:
            handle.publish_feedback(Fibonacci.Feedback(sequence=[turns]))
            began.set()
            turns += 1
            assert not threading.Event().wait(0.005)
        handle.canceled()
        return Fibonacci.Result(sequence=[turns])

    group = ReentrantCallbackGroup()
    ActionServer(server_node, Fibonacci, "fibonacci", execute, callback_group=group, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    with MultiThreadedExecutor(4, context=context) as several, SingleThreadedExecutor(context=context) as executor:
        several.add_node(server_node)
        executor.add_node(node)
        thread = threading.Thread(target=several.spin)
        thread.start()
        handle = accepted(executor, client, feedback_callback=heard.append)
        future = handle.get_result_async()
        assert began.wait(PATIENCE)
        spin_until(executor, lambda: len(heard) > 1, PATIENCE)
        assert len(done(executor, handle.cancel_goal_async()).goals_canceling) == 1
        answer = done(executor, future)
        several.shutdown()
        thread.join(PATIENCE)
    assert answer.status == CANCELED
    assert answer.result.sequence[0] >= 2


def test_a_blocking_callback_in_one_thread_still_tells_how_far_it_is(context: Context) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    go_on = threading.Event()
    heard: list[Any] = []

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.publish_feedback(Fibonacci.Feedback(sequence=[1]))
        assert go_on.wait(PATIENCE)
        handle.succeed()
        return Fibonacci.Result()

    ActionServer(server_node, Fibonacci, "fibonacci", execute, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    with SingleThreadedExecutor(context=context) as server, SingleThreadedExecutor(context=context) as executor:
        server.add_node(server_node)
        executor.add_node(node)
        thread = threading.Thread(target=server.spin)
        thread.start()
        handle = accepted(executor, client, feedback_callback=heard.append)
        spin_until(executor, lambda: bool(heard), PATIENCE)
        wish = handle.cancel_goal_async()  # is read only afterwards
        go_on.set()
        assert done(executor, handle.get_result_async()).status == SUCCEEDED
        assert done(executor, wish).return_code == CancelGoal.Response.ERROR_GOAL_TERMINATED
        server.shutdown()
        thread.join(PATIENCE)


# --- Waiting for a goal ---------------------------------------------------------------------------------------------


def feedback_of_a_goal(executor: MultiThreadedExecutor, client: ActionClient) -> list[int]:
    heard: list[int] = []
    handle = accepted(executor, client, feedback_callback=lambda each: heard.append(each.feedback.sequence[0]))
    assert done(executor, handle.get_result_async()).status == SUCCEEDED
    spin_until(executor, lambda: len(heard) == 5, PATIENCE)
    return heard


def test_all_feedback_comes_where_there_are_several_threads(context: Context) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        for turn in range(5):  # they wait for each other, and the result overtakes them
            handle.publish_feedback(Fibonacci.Feedback(sequence=[turn]))
        handle.succeed()
        return Fibonacci.Result()

    ActionServer(server_node, Fibonacci, "fibonacci", execute)
    client = ActionClient(node, Fibonacci, "fibonacci")
    with MultiThreadedExecutor(4, context=context) as executor:
        executor.add_node(server_node)
        executor.add_node(node)
        for _ in range(2 * LATELY):
            assert feedback_of_a_goal(executor, client) == [0, 1, 2, 3, 4]
    assert len(client._feedback_callbacks) == LATELY  # those of the last few goals, which may still get some


def test_a_goal_may_be_sent_and_waited_for_from_another_thread(context: Context, spun: SingleThreadedExecutor) -> None:
    server_node, node = Node("server", context=context), Node("node", context=context)
    spun.add_node(server_node)
    spun.add_node(node)
    ActionServer(server_node, Fibonacci, "fibonacci", fibonacci, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert client.wait_for_server(PATIENCE)
    heard: list[int] = []
    answer = client.send_goal(
        Fibonacci.Goal(order=6), feedback_callback=lambda each: heard.append(each.feedback.sequence[-1])
    )
    assert list(answer.result.sequence) == [0, 1, 1, 2, 3, 5, 8]
    for _ in range(int(PATIENCE / 0.01)):
        if len(heard) == 5:
            break
        threading.Event().wait(0.01)
    assert heard == [1, 2, 3, 5, 8]


def test_a_callback_may_wait_for_a_goal_that_its_own_executor_serves(
    executor: SingleThreadedExecutor, node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(node, Fibonacci, "fibonacci")
    got: list[Any] = []
    heard: list[int] = []

    def ask() -> None:
        timer.cancel()
        got.append(client.send_goal(Fibonacci.Goal(order=3), feedback_callback=lambda _: heard.append(len(got))))

    timer = node.create_timer(1.0, ask)
    spin_for(executor, 5.0)
    assert list(got[0].result.sequence) == [0, 1, 1, 2]
    assert heard == [1, 1]  # the callback's own group is busy until it ends


def test_feedback_comes_while_a_callback_waits_if_its_group_lets_it(
    executor: SingleThreadedExecutor, node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(node, Fibonacci, "fibonacci", callback_group=ReentrantCallbackGroup())
    got: list[Any] = []
    heard: list[int] = []

    def ask() -> None:
        timer.cancel()
        got.append(client.send_goal(Fibonacci.Goal(order=3), feedback_callback=lambda _: heard.append(len(got))))

    timer = node.create_timer(1.0, ask)
    spin_for(executor, 5.0)
    assert (len(got), heard) == (1, [0, 0])


def test_a_goal_that_only_the_waiting_callback_could_serve_is_refused_at_once(
    executor: SingleThreadedExecutor, server_node: Node, serve: Callable[..., ActionServer]
) -> None:
    serve()
    client = ActionClient(server_node, Fibonacci, "fibonacci")
    problems: list[str] = []

    def ask() -> None:
        with pytest.raises(ServiceError) as refused:
            client.send_goal(Fibonacci.Goal(order=3))
        problems.append(str(refused.value))

    server_node.create_timer(1.0, ask)
    spin_for(executor, 1.5)
    assert "is served only by the callback group that this call keeps busy" in problems[0]


def test_a_rejected_goal_has_no_result_to_wait_for(context: Context, spun: SingleThreadedExecutor) -> None:
    node = Node("node", context=context)
    spun.add_node(node)
    ActionServer(node, Fibonacci, "fibonacci", fibonacci, goal_callback=lambda _: GoalResponse.REJECT)
    answer = ActionClient(node, Fibonacci, "fibonacci").send_goal(Fibonacci.Goal())
    assert answer.status == GoalStatus.STATUS_UNKNOWN


def test_a_goal_handle_waits_too(context: Context, spun: SingleThreadedExecutor, waiting: Waiting) -> None:
    node = Node("node", context=context)
    spun.add_node(node)
    ActionServer(node, Fibonacci, "fibonacci", waiting, cancel_callback=accept)
    client = ActionClient(node, Fibonacci, "fibonacci")
    arrived: Any = []
    there = threading.Event()

    def note(future: Future[ClientGoalHandle]) -> None:
        arrived.append(future.result())
        there.set()

    client.send_goal_async(Fibonacci.Goal(order=2)).add_done_callback(note)
    assert there.wait(PATIENCE)
    assert len(arrived[0].cancel_goal().goals_canceling) == 1
    waiting.futures[0].set_result(ServerGoalHandle.canceled)
    assert arrived[0].get_result().status == CANCELED


def test_what_is_sent_after_the_result_is_no_feedback(context: Context) -> None:
    """As in rclpy; what was sent before and comes late is."""
    server_node, node = Node("server", context=context), Node("node", context=context)
    ActionServer(server_node, Fibonacci, "fibonacci", fibonacci)
    client = ActionClient(node, Fibonacci, "fibonacci")
    late = node.create_publisher(Fibonacci.Impl.FeedbackMessage, "fibonacci/_action/feedback", 10)
    heard: list[int] = []
    sent: list[Any] = []
    node.create_subscription(Fibonacci.Impl.FeedbackMessage, "fibonacci/_action/feedback", sent.append, 10)
    with SingleThreadedExecutor(context=context) as executor:
        executor.add_node(server_node)
        executor.add_node(node)
        handle = accepted(executor, client, feedback_callback=lambda each: heard.append(len(each.feedback.sequence)))
        assert done(executor, handle.get_result_async()).status == SUCCEEDED
        spin_until(executor, lambda: len(heard) == len(sent), PATIENCE)
        before = len(heard)
        late.publish(Fibonacci.Impl.FeedbackMessage(goal_id=handle.goal_id))
        spin_until(executor, lambda: len(sent) > before, PATIENCE)  # the client, who listened first, had it before
    assert len(heard) == before
