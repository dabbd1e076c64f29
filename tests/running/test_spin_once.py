"""`spin_once` in a loop: the node is given back after each call, although its entities stay where they are."""

from __future__ import annotations

import gc
import threading
import time
import weakref
from collections.abc import Iterator

import pytest

import robolink as rclpy
from robolink import Context, Node
from robolink.exceptions import NotInitializedException
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.guard_condition import GuardCondition
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.transport.memory import Bus, MemoryTransport
from robolink.utilities import set_default_context
from robolink.wait_for_message import wait_for_message
from tests.support.spins import numbers, parked_node, spin_for, spin_once_and_again


@pytest.fixture
def default(virtual: Context) -> Iterator[Context]:
    """Make the default context one in memory and in virtual time."""
    set_default_context(virtual)
    yield virtual
    set_default_context(None)


@pytest.fixture
def node(default: Context) -> Node:
    return parked_node()


def send(node: Node, topic: str, *data: int) -> None:
    publisher = node.create_publisher(Int32, topic, 100)
    for each in data:
        publisher.publish(Int32(data=each))
    node.destroy_publisher(publisher)


# What a program sees between two calls


def test_a_node_belongs_to_the_executor_only_while_it_is_spun(node: Node) -> None:
    shared, seen = rclpy.get_global_executor(), list[tuple[Executor | None, bool]]()
    node.create_timer(0.1, lambda: seen.append((node.executor, node in shared.get_nodes())))
    for _ in range(2):
        rclpy.spin_once(node)
        assert (node.executor, shared.get_nodes(), shared.spinning) == (None, [], False)
    assert seen == [(shared, True)] * 2


@pytest.mark.parametrize("act", ["spin_once", "spin_until_future_complete", "wait_for_ready_callbacks", "spin a node"])
def test_no_other_spin_of_the_executor_runs_its_callbacks(node: Node, act: str) -> None:
    other, shared, got = rclpy.create_node("other"), rclpy.get_global_executor(), numbers(node, "topic")
    node.create_timer(0.0, lambda: got.append(-1)).cancel()
    send(node, "topic", 1, 2)
    rclpy.spin_once(node)
    if act == "spin_once":
        shared.spin_once(timeout_sec=0.1)
    elif act == "spin_until_future_complete":
        spin_for(shared, 0.1)
    elif act == "wait_for_ready_callbacks":
        with pytest.raises(rclpy.executors.TimeoutException):
            shared.wait_for_ready_callbacks(timeout_sec=0.1)
    else:
        rclpy.spin_once(other, timeout_sec=0.1)
    send(node, "topic", 3)
    assert got == [1]
    spin_once_and_again(node)
    assert got == [1, 2, 3]


def test_two_nodes_by_turns_keep_what_is_theirs(default: Context) -> None:
    nodes = [rclpy.create_node(name) for name in ("one", "two")]
    got = [numbers(each, "topic") for each in nodes]
    send(nodes[0], "topic", 1, 2, 3)
    for step in range(3):
        rclpy.spin_once(nodes[0])
        assert got == [[1, 2, 3][: step + 1], [1, 2, 3][:step]]
        rclpy.spin_once(nodes[1])
    assert got == [[1, 2, 3]] * 2


@pytest.mark.parametrize("way", ["add_node", "executor", "spin_once"])
def test_another_executor_takes_the_node_over_at_once(node: Node, way: str) -> None:
    got, ticks, other = numbers(node, "topic"), list[int](), SingleThreadedExecutor()
    node.create_timer(1.0, lambda: ticks.append(1))
    send(node, "topic", 0, 1, 2)
    rclpy.spin_once(node)
    send(node, "topic", 3)
    if way == "add_node":
        assert other.add_node(node)
    elif way == "executor":
        node.executor = other
    if way == "spin_once":
        for _ in range(4):
            rclpy.spin_once(node, executor=other, timeout_sec=1.0)
        assert node.executor is None
    else:
        assert (node.executor, other.get_nodes()) == (other, [node])
        spin_for(rclpy.get_global_executor(), 0.1)
        assert got == [0]
        spin_for(other, 1.0)
    assert (got, ticks) == ([0, 1, 2, 3], [1])


def test_the_executor_itself_takes_it_back(node: Node) -> None:
    shared, got = rclpy.get_global_executor(), numbers(node, "topic")
    assert shared.add_node(node)
    assert not shared.add_node(node)
    send(node, "topic", 1)
    shared.spin_once()
    assert (node.executor, got) == (shared, [1])
    send(node, "topic", 2)
    rclpy.spin_once(node)
    assert (node.executor, got) == (shared, [1, 2])


def test_removing_it_from_the_executor_does_no_harm(node: Node) -> None:
    got = numbers(node, "topic")
    rclpy.get_global_executor().remove_node(node)
    send(node, "topic", 1)
    rclpy.spin_once(node)
    assert got == [1]


def test_entities_come_and_go_between_two_calls(node: Node) -> None:
    first, ticks = numbers(node, "topic"), list[int]()
    spin_once_and_again(node, 1)
    second, gone = numbers(node, "topic"), node.create_subscription(Int32, "topic", pytest.fail, 10)
    timer, stopped = node.create_timer(0.1, lambda: ticks.append(1)), node.create_timer(0.1, pytest.fail)
    send(node, "topic", 1)
    node.destroy_subscription(gone)
    node.destroy_timer(stopped)
    spin_once_and_again(node)
    assert (first, second) == ([1], [1])
    rclpy.spin_once(node)
    timer.cancel()
    rclpy.spin_once(node, timeout_sec=1.0)
    assert ticks == [1]


def test_rounds_go_on_from_call_to_call(node: Node) -> None:
    got: list[tuple[str, int]] = []
    for topic in ("one", "two"):
        node.create_subscription(Int32, topic, lambda message, name=topic: got.append((name, message.data)), 10)
    rclpy.spin_once(node, timeout_sec=0)
    sent = [("two", 0), ("one", 1), ("two", 2), ("two", 3), ("one", 4)]
    for topic, number in sent:
        send(node, topic, number)
    spin_once_and_again(node)
    assert got == [("one", 1), ("two", 0), ("one", 4), ("two", 2), ("two", 3)]


def test_a_timer_that_is_late_is_called_once(node: Node, default: Context) -> None:
    ticks: list[int] = []
    node.create_timer(0.1, lambda: ticks.append(default.time.now() // 10**6))
    rclpy.spin_once(node)
    default.time.sleep(450 * 10**6)
    for _ in range(3):
        rclpy.spin_once(node)
    assert ticks == [100, 550, 600, 700]


def test_a_guard_condition_is_triggered_between_two_calls(node: Node) -> None:
    calls: list[int] = []
    guard: GuardCondition = node.create_guard_condition(lambda: calls.append(1))
    for _ in range(2):
        guard.trigger()
        guard.trigger()
        spin_once_and_again(node)
    assert calls == [1, 1]


def test_an_answer_comes_while_the_node_is_spun_once_and_again(node: Node) -> None:
    node.create_service(Trigger, "go", lambda _, response: response)
    client = node.create_client(Trigger, "go")
    rclpy.spin_once(node, timeout_sec=0)
    answer = client.call_async(Trigger.Request())
    while not answer.done():
        rclpy.spin_once(node, timeout_sec=1.0)
    assert answer.result() == Trigger.Response()


def test_a_message_is_waited_for_between_two_calls(node: Node) -> None:
    got = numbers(node, "topic")
    send(node, "topic", 1)
    talker = Node("talker")
    publisher = talker.create_publisher(Int32, "other", 1)

    def answer() -> None:
        while not publisher.get_subscription_count():
            time.sleep(0.001)
        publisher.publish(Int32(data=7))

    threading.Thread(target=answer, daemon=True).start()
    assert wait_for_message(Int32, node, "other") == (True, Int32(data=7))
    assert got == []
    spin_once_and_again(node)
    assert got == [1]


# Ends


def test_a_callback_that_raises_leaves_the_node_given_back(node: Node) -> None:
    ticks: list[int] = []

    def tick() -> None:
        ticks.append(1)
        raise ValueError("tick")

    node.create_timer(0.1, tick)
    for _ in range(2):
        with pytest.raises(ValueError, match="tick"):
            rclpy.spin_once(node)
        assert node.executor is None
    assert ticks == [1, 1]


@pytest.mark.parametrize("how", ["between", "in a callback"])
def test_a_destroyed_node_is_done(node: Node, how: str) -> None:
    other = rclpy.create_node("other")
    got, ends = numbers(node, "topic"), numbers(other, "topic")
    send(node, "topic", 1)
    if how == "between":
        node.destroy_node()
    else:
        node.create_timer(0.0, node.destroy_node)
        spin_once_and_again(node)
        got.clear()
    send(other, "topic", 2)
    rclpy.spin_once(other)
    rclpy.spin_once(other)
    assert (got, ends, node.executor) == ([], [1, 2], None)


def test_a_node_that_a_callback_moves_is_not_taken_back(node: Node) -> None:
    other = SingleThreadedExecutor()
    node.create_timer(0.1, lambda: other.add_node(node))
    rclpy.spin_once(node)
    assert (node.executor, other.get_nodes()) == (other, [node])


def test_a_node_that_nobody_holds_is_collected_and_silent(default: Context) -> None:
    other, node = rclpy.create_node("other"), rclpy.create_node("node")
    got, ticks = list[int](), list[int]()
    kept = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), 10)
    timer = node.create_timer(0.1, lambda: ticks.append(1))
    rclpy.spin_once(node)
    seen = weakref.ref(node)
    del node
    gc.collect()
    assert seen() is None
    send(other, "topic", 1)
    rclpy.spin_once(other, timeout_sec=1.0)
    assert (got, ticks) == ([], [1])
    assert kept.executor is None
    assert timer.executor is None


def test_an_executor_that_nobody_holds_is_collected(node: Node) -> None:
    executor = SingleThreadedExecutor()
    seen = weakref.ref(executor)
    rclpy.spin_once(node, executor=executor, timeout_sec=0)
    rclpy.spin_once(node, timeout_sec=0)
    del executor
    gc.collect()
    assert seen() is None


def test_shutdown_and_init_again() -> None:
    for _ in range(2):
        set_default_context(Context(transport=MemoryTransport(bus=Bus())))
        rclpy.init(args=[])
        node = rclpy.create_node("node")
        got = numbers(node, "topic")
        send(node, "topic", 1)
        rclpy.spin_once(node)
        assert got == [1]
        rclpy.shutdown()
        assert node.executor is None
    set_default_context(None)


def test_a_spin_after_the_context_has_ended_raises(node: Node, default: Context) -> None:
    default.shutdown()
    with pytest.raises(NotInitializedException):
        rclpy.spin_once(node)


# Other executors


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_an_executor_of_ones_own_gives_it_back_too(node: Node, kind: type[Executor]) -> None:
    got = numbers(node, "topic")
    with kind() as executor:
        for number in range(3):
            send(node, "topic", number)
            rclpy.spin_once(node, executor=executor)
            assert (node.executor, executor.get_nodes()) == (None, [])
    assert got == [0, 1, 2]


def test_a_class_of_ones_own_is_told_of_each_node(node: Node) -> None:
    told: list[str] = []

    class Told(SingleThreadedExecutor):
        def add_node(self, node: Node) -> bool:  # type: ignore[override]
            told.append("add")
            return super().add_node(node)

        def remove_node(self, node: Node) -> None:  # type: ignore[override]
            told.append("remove")
            super().remove_node(node)

    executor = Told()
    for _ in range(2):
        rclpy.spin_once(node, executor=executor, timeout_sec=0)
    assert told == ["add", "remove"] * 2
