"""The parked node of an executor: what it keeps between two spins, beside other threads, and what a spin costs."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

import robolink as rclpy
from robolink import Context, Future, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.utilities import set_default_context
from tests.support.spins import counted_calls, numbers, parked_node, spin_once_and_again

PATIENCE = 30.0


@pytest.fixture
def default(context: Context) -> Iterator[Context]:
    """Make the default context one in memory."""
    set_default_context(context)
    yield context
    set_default_context(None)


@pytest.fixture
def node(default: Context) -> Node:
    return parked_node()


# What waits


def test_what_comes_between_two_calls_is_bounded_by_the_depth(node: Node) -> None:
    publisher = Node("talker").create_publisher(Int32, "topic", 10)
    got: list[int] = []
    subscription = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), 3)
    rclpy.spin_once(node, timeout_sec=0)
    for number in range(1000):
        publisher.publish(Int32(data=number))
    deadline = time.monotonic() + PATIENCE
    while subscription.dropped < 997 and time.monotonic() < deadline:
        time.sleep(0.01)
    assert subscription.dropped == 997
    spin_once_and_again(node)
    assert got == [997, 998, 999]


# Threads


@pytest.mark.slow
@pytest.mark.parametrize("rival", ["spins another node once and again", "spins the executor", "moves the node"])
def test_nothing_is_lost_beside_another_thread(node: Node, rival: str) -> None:
    other, ends = Node("other"), threading.Event()
    got, publisher = numbers(node, "topic", depth=100_000), Node("talker").create_publisher(Int32, "topic", 10)
    executors = [SingleThreadedExecutor(), rclpy.get_global_executor()]

    def act() -> None:
        while not ends.is_set():
            if rival == "moves the node":
                for executor in executors:
                    executor.add_node(node)
                    executor.remove_node(node)
            elif rival == "spins the executor":
                executors[1].spin_once(timeout_sec=0.001)
            else:
                rclpy.spin_once(other, timeout_sec=0.001)

    thread = threading.Thread(target=act)
    thread.start()
    count, deadline = 0, time.monotonic() + PATIENCE
    while len(got) < 3000 and time.monotonic() < deadline:
        if count < 3000:
            publisher.publish(Int32(data=count))
            count += 1
        rclpy.spin_once(node, timeout_sec=0)
    ends.set()
    thread.join(PATIENCE)
    assert sorted(got) == list(range(3000))
    assert not thread.is_alive()


# Cost


def test_a_call_costs_the_same_whatever_the_node_has(node: Node) -> None:
    def cost() -> int:
        spin_once_and_again(node, 2)
        with counted_calls() as calls:
            rclpy.spin_once(node, timeout_sec=0)
        return len(calls)

    before = cost()
    for index in range(20):
        node.create_subscription(Int32, f"topic_{index}", lambda _: None, 10)
        node.create_service(Trigger, f"service_{index}", lambda _, response: response)
    assert cost() == before < 60


def test_a_call_costs_the_same_however_much_waits(node: Node) -> None:
    got, cost = numbers(node, "topic", depth=5000), list[int]()
    publisher = node.create_publisher(Int32, "topic", 10)
    for count in (3, 2000):
        for number in range(count):
            publisher.publish(Int32(data=number))
        rclpy.spin_once(node)
        with counted_calls() as calls:
            rclpy.spin_once(node)
        cost.append(len(calls))
    assert len(got) == 4
    assert cost[0] == cost[1]


def test_only_a_node_that_is_spun_again_and_again_is_parked(node: Node) -> None:
    """Of two by turns each would drive the other one out, which costs more than to remove it at once."""
    other, parked = rclpy.create_node("other"), list[tuple[bool, bool]]()
    for each in (node, other, node, other, other, other, node, node):
        rclpy.spin_once(each, timeout_sec=0)
        parked.append((node._is_parked_, other._is_parked_))
    assert parked == [(True, False), *[(False, False)] * 3, *[(False, True)] * 2, (False, False), (True, False)]


def test_a_future_is_spun_for_at_the_same_cost(node: Node) -> None:
    rclpy.spin_until_future_complete(node, Future(), timeout_sec=0)
    with counted_calls() as calls:
        rclpy.spin_until_future_complete(node, Future(), timeout_sec=0)
    assert len(calls) < 80


def test_a_node_parked_while_another_thread_parks_its_own_stays_itself(node: Node) -> None:
    """The other thread comes just before the lock: what was read before it is no longer true then."""
    other = Node("other")
    executor = rclpy.get_global_executor()
    assert isinstance(executor, SingleThreadedExecutor)
    nodes, queue = executor._nodes_, executor._queue_
    for each in (other, node):
        executor.add_node(each)
    nodes.park(other)
    executor.add_node(other)

    class Overtaken:
        def __enter__(self) -> None:
            nodes._queue = queue
            nodes.park(other)
            queue.lock.__enter__()

        def __exit__(self, *_: object) -> None:
            queue.lock.release()

    nodes._queue = SimpleNamespace(lock=Overtaken())  # type: ignore[assignment]
    nodes.park(node)
    parked = nodes.parked and nodes.parked()
    assert [each._is_parked_ for each in (node, other)] == [parked is node, parked is other]
