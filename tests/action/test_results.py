"""What is told of a goal: its result for a while, its status, its feedback, and to whoever waits when one side ends."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robolink import Future, Node
from robolink.action import ActionClient, ActionServer
from robolink.action.client import ClientGoalHandle
from robolink.action.server import ServerGoalHandle
from robolink.exceptions import ServiceError
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.qos import qos_profile_action_status_default
from tests.support.goals import ABORTED, SUCCEEDED, Waiting, accepted, fibonacci, numbered
from tests.support.spins import done, spin_for, spin_until

# --- What is kept, and what the status topic says -------------------------------------------------------------------


def test_a_result_is_kept_for_a_while(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    server = serve(result_timeout=5.0)
    first = accepted(executor, client)
    spin_for(executor, 2.0)
    second = accepted(executor, client)
    spin_for(executor, 2.0)
    assert done(executor, first.get_result_async()).status == SUCCEEDED
    spin_for(executor, 2.0)
    assert done(executor, first.get_result_async()).status == GoalStatus.STATUS_UNKNOWN
    assert "unknown, or expired" in log_lines[-1].message
    assert done(executor, second.get_result_async()).status == SUCCEEDED
    spin_for(executor, 2.0)
    assert not server._goal_handles


def test_the_while_begins_at_the_end_of_a_goal(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting, result_timeout=5)
    handle = accepted(executor, client)
    spin_for(executor, 60.0)
    waiting.futures[0].set_result(ServerGoalHandle.abort)
    spin_for(executor, 4.0)
    assert done(executor, handle.get_result_async()).status == ABORTED
    spin_for(executor, 2.0)
    assert waiting.handles[0].status == GoalStatus.STATUS_UNKNOWN
    waiting.handles[0].succeed()  # nothing happens any more
    waiting.handles[0].publish_feedback(Fibonacci.Feedback())


@pytest.mark.parametrize(("timeout", "kept"), [(-1, True), (0, False)])
def test_a_result_may_be_kept_for_ever_or_not_at_all(
    timeout: float,
    kept: bool,
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
) -> None:
    server = serve(result_timeout=timeout)
    handle = accepted(executor, client)
    spin_for(executor, 3600.0)
    assert bool(server._goal_handles) is kept
    expected = SUCCEEDED if kept else GoalStatus.STATUS_UNKNOWN
    assert done(executor, handle.get_result_async()).status == expected


def test_late_comers_learn_of_the_goals(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    handles = [accepted(executor, client, 1), accepted(executor, client, 2)]
    spin_for(executor, 1.0)
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    spin_for(executor, 1.0)
    late = Node("late", context=executor.context)
    executor.add_node(late)
    heard: list[GoalStatusArray] = []
    topic = "fibonacci/_action/status"
    late.create_subscription(GoalStatusArray, topic, heard.append, qos_profile_action_status_default)
    spin_for(executor, 1.0)
    told = [(each.goal_info.goal_id, each.status) for each in heard[-1].status_list]
    assert told == [(handles[0].goal_id, SUCCEEDED), (handles[1].goal_id, GoalStatus.STATUS_EXECUTING)]


def test_an_id_is_used_once(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    handle = accepted(executor, client, goal_uuid=numbered(1))
    assert not done(executor, client.send_goal_async(Fibonacci.Goal(), goal_uuid=numbered(1))).accepted
    assert handle == ClientGoalHandle(client, numbered(1), handle._goal_response)
    assert "id=" + "01" * 16 in repr(handle)


# --- Feedback -------------------------------------------------------------------------------------------------------


def test_a_goal_is_accepted_before_its_feedback_comes_and_that_comes_before_its_result(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    serve()
    told: list[str] = []

    def on_accepted(future: Future[ClientGoalHandle]) -> None:
        told.append("accepted")
        handle = future.result()
        assert handle is not None
        handle.get_result_async().add_done_callback(lambda _: told.append("result"))

    node.create_timer(1.0, lambda: None)  # other things are ready, too
    goal = client.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=lambda _: told.append("feedback"))
    goal.add_done_callback(on_accepted)
    spin_for(executor, 5.0)
    assert told == ["accepted", "feedback", "feedback", "result"]


def test_feedback_goes_to_the_goal_that_it_is_about(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    heard: dict[int, list[int]] = {1: [], 2: []}

    def hear(number: int) -> Callable[[Any], None]:
        return lambda message: heard[number].extend(message.feedback.sequence)

    handle = accepted(executor, client, 1, feedback_callback=hear(1))
    accepted(executor, client, 2, feedback_callback=hear(2))
    accepted(executor, client, 3)
    for number, goal in enumerate(waiting.handles, 1):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    spin_for(executor, 1.0)
    assert heard == {1: [1], 2: [2]}
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    assert done(executor, handle.get_result_async()).status == SUCCEEDED
    with pytest.raises(TypeError, match=r"Expected .*Feedback"):
        waiting.handles[1].publish_feedback(Fibonacci.Result())


def test_feedback_and_results_of_strangers_harm_nobody(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    node: Node,
    log_lines: list[Record],
) -> None:
    serve()
    feedback = node.create_publisher(Fibonacci.Impl.FeedbackMessage, "fibonacci/_action/feedback", 10)
    feedback.publish(Fibonacci.Impl.FeedbackMessage(goal_id=numbered(7)))
    feedback.publish(b"\x00\x01\x00\x00\x01")
    status = node.create_publisher(GoalStatusArray, "fibonacci/_action/status", 10)
    nobody = GoalStatus(goal_info=GoalInfo(goal_id=numbered(7)), status=99)
    status.publish(GoalStatusArray(status_list=[nobody, nobody]))
    status.publish(b"")
    spin_for(executor, 0.1)
    heard: list[Any] = []
    handle = accepted(executor, client, 2, feedback_callback=heard.append)
    assert done(executor, handle.get_result_async()).status == SUCCEEDED
    assert len(heard) == 1
    assert sum("dropped a message" in each.message for each in log_lines) == 2


@pytest.mark.parametrize("part", ["send_goal", "cancel_goal", "get_result"])
def test_requests_that_cannot_be_read_are_refused(
    part: str, executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    serve()
    raw = getattr(client, {"send_goal": "_goal", "cancel_goal": "_cancel", "get_result": "_result"}[part] + "_client")
    answers: list[Any] = []
    node.context.transport.call(raw._key(), b"\x00\x01\x00\x00\xff\xff", raw._endpoint.attachment(), answers.append)
    spin_for(executor, 1.0)
    assert answers == [None]
    assert done(executor, accepted(executor, client).get_result_async()).status == SUCCEEDED


# --- The end of one side --------------------------------------------------------------------------------------------


def test_whoever_waits_is_told_when_the_server_goes(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    server = serve(waiting)
    handle = accepted(executor, client)
    future = handle.get_result_async()
    spin_for(executor, 1.0)
    server.destroy()
    server.destroy()
    spin_until(executor, future.done)
    with pytest.raises(ServiceError, match=r"action /fibonacci, goal [0-9a-f]{32}: no result: .*went away"):
        future.result()
    assert handle.status == GoalStatus.STATUS_UNKNOWN
    assert not waiting.handles[0].is_active
    waiting.futures[0].set_result(ServerGoalHandle.succeed)  # whoever executes it may go on, for nobody
    spin_for(executor, 1.0)
    assert isinstance(spun_to_its_end(executor, handle.cancel_goal_async()), ServiceError)


def spun_to_its_end(executor: SingleThreadedExecutor, future: Future[Any]) -> BaseException | None:
    spin_until(executor, future.done)
    return future.exception()


def test_a_server_goes_on_without_its_client(
    executor: SingleThreadedExecutor, serve: Callable[..., ActionServer], waiting: Waiting, node: Node
) -> None:
    server = serve(waiting, result_timeout=5)
    client = ActionClient(node, Fibonacci, "fibonacci")
    handle = accepted(executor, client)
    future = handle.get_result_async()
    spin_for(executor, 1.0)
    node.destroy_node()
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    spin_for(executor, 1.0)
    assert not future.done()
    assert waiting.handles[0].status == SUCCEEDED
    spin_for(executor, 10.0)
    assert not server._goal_handles


def test_a_goal_that_nobody_serves_stays_open_and_that_is_told(
    executor: SingleThreadedExecutor, client: ActionClient, log_lines: list[Record]
) -> None:
    assert not client.wait_for_server(timeout_sec=5.0)
    assert executor.context.time.now() == 5 * 10**9
    future = client.send_goal_async(Fibonacci.Goal(), feedback_callback=print)
    spin_for(executor, 1.0)
    assert not future.done()
    assert "/fibonacci: nobody serves this action" in log_lines[-1].message
    assert not client._feedback_callbacks
    with pytest.raises(ServiceError, match="nobody serves"):
        client.send_goal(Fibonacci.Goal())


def test_a_server_counts_when_all_of_it_is_there(
    client: ActionClient, serve: Callable[..., ActionServer], server_node: Node
) -> None:
    for part in ("SendGoal", "GetResult"):
        service = getattr(Fibonacci.Impl, f"{part}Service")
        name = {"SendGoal": "send_goal", "GetResult": "get_result"}[part]
        server_node.create_service(service, f"fibonacci/_action/{name}", print)
    assert not client.server_is_ready()
    serve()
    assert client.server_is_ready()
    assert client.wait_for_server()


def test_a_goal_may_be_given_up_before_it_is_answered(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    future = client.send_goal_async(Fibonacci.Goal())
    future.cancel()
    spin_for(executor, 1.0)
    assert (future.cancelled(), future.done()) == (True, False)


def test_wrong_arguments(client: ActionClient, serve: Callable[..., ActionServer], node: Node) -> None:
    server = serve()
    for send in (client.send_goal, client.send_goal_async):
        with pytest.raises(TypeError, match=r"Expected .*Fibonacci_Goal|Expected .*Goal"):
            send(Fibonacci.Result())
        wrongs: list[Any] = [b"0123456789abcdef", "1", [0] * 16]
        for wrong in wrongs:
            with pytest.raises(TypeError, match=r"goal_uuid: expected a unique_identifier_msgs\.msg\.UUID"):
                send(Fibonacci.Goal(), goal_uuid=wrong)
    for ask in (client._cancel_goal_async, client._get_result_async):
        with pytest.raises(TypeError, match="Expected type ClientGoalHandle"):
            ask(UUID())  # type: ignore[arg-type] # what is tested
    with pytest.raises(TypeError, match="must be callable"):
        server.register_execute_callback(None)  # type: ignore[arg-type] # what is tested
    with pytest.raises(ValueError, match="not an action class"):
        ActionClient(node, Fibonacci.Goal, "fibonacci")
    with pytest.raises(ValueError, match="topic name"):
        ActionServer(node, Fibonacci, "fibonacci!", fibonacci)


def test_what_an_execution_sends_at_once_has_come_when_the_goal_is_accepted(
    executor: SingleThreadedExecutor, serve: Callable[..., ActionServer], node: Node
) -> None:
    """For whoever subscribes and calls by itself, as rclpy's own tests do: executions are tasks, which come first."""
    serve()
    impl, heard = Fibonacci.Impl, list[Any]()
    node.create_subscription(impl.FeedbackMessage, "fibonacci/_action/feedback", heard.append, 10)
    asking = node.create_client(impl.SendGoalService, "fibonacci/_action/send_goal")
    request = impl.SendGoalService.Request(goal_id=numbered(3), goal=Fibonacci.Goal(order=3))
    assert done(executor, asking.call_async(request)).accepted
    assert heard
