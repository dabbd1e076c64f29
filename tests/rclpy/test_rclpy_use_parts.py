"""What public programs use of actions, lifecycle nodes, tf2 and parameter clients does as in rclpy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.client import ClientGoalHandle
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.duration import Duration
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.std_msgs.msg import Int32
from robolink.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from robolink.parameter import Parameter
from robolink.parameter_client import AsyncParameterClient
from robolink.tf2 import Buffer, LookupException, TransformBroadcaster, TransformListener
from robolink.time import Time
from tests.support.rclpy_use import shows
from tests.support.spins import done, spin_for


@pytest.fixture
def node(executor: SingleThreadedExecutor) -> Node:
    made = Node("robot", context=executor.context)
    executor.add_node(made)
    return made


# --- actions ----------------------------------------------------------------------------------------------------------


def count_up(goal: ServerGoalHandle) -> Fibonacci.Result:
    """Succeed after as many feedbacks as the goal's order."""
    for number in range(goal.request.order):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
    goal.succeed()
    return Fibonacci.Result(sequence=range(goal.request.order))


def sent(executor: SingleThreadedExecutor, client: ActionClient, order: int, **kwargs: Any) -> ClientGoalHandle:
    handle: ClientGoalHandle = done(executor, client.send_goal_async(Fibonacci.Goal(order=order), **kwargs))
    return handle


@shows("ActionClient.send_goal_async", "ActionClient.server_is_ready", "ActionClient.wait_for_server")
@shows("wait_for_server(timeout_sec=)", "send_goal_async(feedback_callback=)", "ClientGoalHandle.accepted")
@shows("ClientGoalHandle.get_result_async", "ClientGoalHandle.stamp", "ClientGoalHandle.status")
@shows("ClientGoalHandle.goal_id", "ServerGoalHandle.request", "ServerGoalHandle.publish_feedback")
@shows("ServerGoalHandle.succeed", "ActionServer(node=)", "ActionServer(action_type=)", "ActionServer(action_name=)")
@shows("ActionServer(execute_callback=)", "ActionServer(callback_group=)", "ActionClient(action_type=)")
@shows("ActionClient(action_name=)", "ActionClient(callback_group=)", "ActionServer.destroy", "ActionClient.destroy")
def test_a_goal_succeeds(executor: SingleThreadedExecutor, node: Node) -> None:
    client = ActionClient(node, action_type=Fibonacci, action_name="count", callback_group=ReentrantCallbackGroup())
    assert not client.server_is_ready()
    assert not client.wait_for_server(timeout_sec=0.1)
    server = ActionServer(
        node=node,
        action_type=Fibonacci,
        action_name="count",
        execute_callback=count_up,
        callback_group=ReentrantCallbackGroup(),
    )
    assert client.wait_for_server(timeout_sec=1.0)
    heard: list[int] = []
    executor.context.time.sleep(5_000_000_000)
    handle = sent(executor, client, 3, feedback_callback=lambda each: heard.extend(each.feedback.sequence))
    assert (handle.accepted, len(handle.goal_id.uuid), handle.stamp.sec) == (True, 16, 5)
    answer = done(executor, handle.get_result_async())
    assert (answer.status, list(answer.result.sequence), heard) == (GoalStatus.STATUS_SUCCEEDED, [0, 1, 2], [0, 1, 2])
    spin_for(executor, 0.1)
    assert handle.status == GoalStatus.STATUS_SUCCEEDED
    server.destroy()
    assert not client.server_is_ready()
    client.destroy()


@shows("ActionServer(goal_callback=)", "ActionServer(cancel_callback=)", "ActionServer(handle_accepted_callback=)")
@shows("ServerGoalHandle.execute", "ServerGoalHandle.is_active", "ServerGoalHandle.status", "ServerGoalHandle.goal_id")
@shows("ServerGoalHandle.is_cancel_requested", "ServerGoalHandle.canceled", "ServerGoalHandle.abort")
@shows("ServerGoalHandle.destroy", "ClientGoalHandle.cancel_goal_async")
def test_goals_are_refused_deferred_cancelled_and_aborted(executor: SingleThreadedExecutor, node: Node) -> None:
    deferred: list[ServerGoalHandle] = []

    def execute(goal: ServerGoalHandle) -> Fibonacci.Result:
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return Fibonacci.Result(sequence=[7])

    ActionServer(
        node,
        Fibonacci,
        "count",
        execute,
        goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 10 else GoalResponse.REJECT,
        cancel_callback=lambda goal: CancelResponse.ACCEPT,
        handle_accepted_callback=deferred.append,
    )
    client = ActionClient(node, Fibonacci, "count")
    assert not sent(executor, client, 10).accepted
    cancelled, aborted = sent(executor, client, 3), sent(executor, client, 4)
    assert [each.is_active for each in deferred] == [True, True]
    assert deferred[0].goal_id == cancelled.goal_id
    assert deferred[0].status == GoalStatus.STATUS_ACCEPTED
    assert len(done(executor, cancelled.cancel_goal_async()).goals_canceling) == 1
    for each in deferred:
        each.execute()
    answers = [done(executor, each.get_result_async()) for each in (cancelled, aborted)]
    assert [each.status for each in answers] == [GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED]
    assert [each.is_active for each in deferred] == [False, False]
    deferred[0].destroy()


@shows("ActionClient.send_goal", "ClientGoalHandle.cancel_goal")
def test_goals_can_be_waited_for(executor: SingleThreadedExecutor, node: Node) -> None:
    ActionServer(node, Fibonacci, "count", count_up, callback_group=ReentrantCallbackGroup())
    client = ActionClient(node, Fibonacci, "count", callback_group=ReentrantCallbackGroup())
    found: list[Any] = []

    def ask() -> None:
        timer.cancel()
        found.append(client.send_goal(Fibonacci.Goal(order=2)))

    timer = node.create_timer(0.1, ask)
    spin_for(executor, 1.0)
    assert [list(each.result.sequence) for each in found] == [[0, 1]]
    handle = sent(executor, client, 1)
    node.create_timer(0.1, lambda: found.append(handle.cancel_goal()))
    spin_for(executor, 0.15)
    assert len(found[1].goals_canceling) == 0


# --- lifecycle --------------------------------------------------------------------------------------------------------


class Camera(LifecycleNode):
    """Writes down what it is told, and publishes all the time."""

    def __init__(self, context: Context) -> None:
        super().__init__("camera", context=context)
        self.told: list[str] = []
        self.fails = False

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"configure in {state.label}")
        self.images = self.create_lifecycle_publisher(Int32, "images", 10)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"activate in {state.label}")
        if self.fails:
            raise ValueError("no camera")
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"deactivate in {state.label}")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"cleanup in {state.label}")
        assert self.destroy_lifecycle_publisher(self.images)
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"shutdown in {state.label}")
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        self.told.append(f"error in {state.label}")
        return TransitionCallbackReturn.SUCCESS


@shows("LifecycleNodeMixin.on_configure", "LifecycleNodeMixin.on_activate", "LifecycleNodeMixin.on_deactivate")
@shows("LifecycleNodeMixin.on_cleanup", "LifecycleNodeMixin.on_shutdown", "LifecycleNodeMixin.on_error")
@shows("LifecycleNodeMixin.create_lifecycle_publisher", "LifecycleNodeMixin.destroy_lifecycle_publisher")
def test_a_lifecycle_node_publishes_while_it_is_active(executor: SingleThreadedExecutor, node: Node) -> None:
    camera, got = Camera(executor.context), []
    executor.add_node(camera)
    node.create_subscription(Int32, "images", lambda each: got.append(each.data), 10)
    assert camera.trigger_configure() == TransitionCallbackReturn.SUCCESS
    camera.images.publish(Int32(data=1))
    camera.trigger_activate()
    camera.images.publish(Int32(data=2))
    camera.trigger_deactivate()
    camera.images.publish(Int32(data=3))
    camera.trigger_cleanup()
    spin_for(executor, 0.1)
    assert got == [2]
    camera.fails = True
    camera.trigger_configure()
    assert camera.trigger_activate() == TransitionCallbackReturn.ERROR
    camera.trigger_shutdown()
    assert camera.told == [
        "configure in unconfigured",
        "activate in inactive",
        "deactivate in active",
        "cleanup in inactive",
        "configure in unconfigured",
        "activate in inactive",
        "error in inactive",
        "shutdown in unconfigured",
    ]


# --- tf2 --------------------------------------------------------------------------------------------------------------


@shows("message.sendTransform", "message.lookup_transform", "message.lookup_transform_async")
@shows("lookup_transform(target_frame=)", "lookup_transform(source_frame=)", "lookup_transform(timeout=)")
@shows("lookup_transform(target_time=)", "lookup_transform(source_time=)", "lookup_transform(fixed_frame=)")
def test_a_transform_is_sent_heard_and_looked_up(executor: SingleThreadedExecutor, node: Node) -> None:
    buffer = Buffer()
    listener = TransformListener(buffer, node)
    with pytest.raises(LookupException):
        buffer.lookup_transform("map", "robot", Time())
    coming = buffer.lookup_transform_async("map", "robot", Time())
    task = executor.create_task(coming)
    transform = TransformStamped(child_frame_id="robot")
    transform.header.frame_id = "map"
    transform.transform.translation.x = 2.0
    TransformBroadcaster(node).sendTransform(transform)
    assert done(executor, task).transform.translation.x == 2.0
    found = buffer.lookup_transform(target_frame="robot", source_frame="map", time=Time(), timeout=Duration(seconds=1))
    assert found.transform.translation.x == -2.0
    full = buffer.lookup_transform_full(
        target_frame="robot", target_time=Time(), source_frame="robot", source_time=Time(), fixed_frame="map"
    )
    assert full.transform.translation.x == 0.0
    listener.unregister()


@shows("message.registerCallback")
def test_a_filter_tells_its_callbacks(executor: SingleThreadedExecutor, node: Node) -> None:
    from robolink.companions.message_filters import Subscriber

    got: list[Any] = []
    Subscriber(node, Int32, "number").registerCallback(got.append)
    node.create_publisher(Int32, "number", 10).publish(Int32(data=7))
    spin_for(executor, 0.1)
    assert got == [Int32(data=7)]


# --- parameters of other nodes ----------------------------------------------------------------------------------------


@shows("AsyncParameterClient.set_parameters", "AsyncParameterClient.get_parameters")
@shows("AsyncParameterClient.wait_for_services", "AsyncParameterClient.list_parameters")
@shows("AsyncParameterClient.delete_parameters", "AsyncParameterClient.load_parameter_file")
def test_another_nodes_parameters(executor: SingleThreadedExecutor, node: Node, tmp_path: Path) -> None:
    other = Node("other", context=executor.context, allow_undeclared_parameters=True)
    executor.add_node(other)
    client = AsyncParameterClient(node, "other")
    assert client.wait_for_services(timeout_sec=1.0)
    (result,) = done(executor, client.set_parameters([Parameter("speed", value=0.5)])).results
    assert result.successful
    (value,) = done(executor, client.get_parameters(["speed"])).values
    assert value.double_value == 0.5
    file = tmp_path / "parameters.yaml"
    file.write_text("/other:\n  ros__parameters:\n    turn: 1.0\n")
    done(executor, client.load_parameter_file(str(file)))
    assert {"speed", "turn"} <= {*done(executor, client.list_parameters([], 10)).result.names}
    done(executor, client.delete_parameters(["speed"]))
    assert not other.has_parameter("speed")
