"""Nodes that come and go, between executors and threads, in the middle of the traffic: nothing lost, nothing stuck."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator

import pytest

from robolink import Context, Node
from robolink.exceptions import ExternalShutdownException
from robolink.executors import Executor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from tests.support.spins import numbers, spin_for

PATIENCE = 30.0


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


def test_adding_twice_and_removing_a_stranger_do_nothing(node: Node, executor: SingleThreadedExecutor) -> None:
    assert not executor.add_node(node)
    assert executor.get_nodes() == [node]
    other = SingleThreadedExecutor(context=executor.context)
    other.remove_node(node)
    assert node.executor is executor


@pytest.mark.parametrize("way", ["add_node", "executor"])
def test_a_node_moves_with_all_that_waits(node: Node, executor: SingleThreadedExecutor, way: str) -> None:
    other = SingleThreadedExecutor(context=executor.context)
    got, publisher = numbers(node, "topic"), node.create_publisher(Int32, "topic", 10)
    ticks: list[int] = []
    node.create_timer(1.0, lambda: ticks.append(1))
    for number in range(3):
        publisher.publish(Int32(data=number))
    executor.spin_once()
    if way == "add_node":
        assert other.add_node(node)
    else:
        node.executor = other
    publisher.publish(Int32(data=3))
    assert (node.executor, executor.get_nodes(), other.get_nodes()) == (other, [], [node])
    spin_for(executor, 0.1)
    assert got == [0]
    spin_for(other, 1.5)
    assert (got, ticks) == ([0, 1, 2, 3], [1])


def test_what_is_ready_keeps_its_turn_while_the_node_is_away(node: Node, executor: SingleThreadedExecutor) -> None:
    """A program that spins once and again takes its node in and out each time: nobody may starve by that."""
    trace: list[str] = []
    publisher = node.create_publisher(Int32, "busy", 5)
    node.create_subscription(Int32, "busy", lambda _: trace.append("busy"), 5)
    node.create_subscription(Int32, "seldom", lambda _: trace.append("seldom"), 5)
    node.create_timer(0.1, lambda: trace.append("timer"))
    node.create_publisher(Int32, "seldom", 5).publish(Int32())
    for _ in range(20):
        publisher.publish(Int32())
        publisher.publish(Int32())
        executor.context.time.sleep(10**8)
        executor.add_node(node)
        executor.spin_once()
        executor.remove_node(node)
    assert {"busy", "seldom", "timer"} == set(trace)
    assert trace.count("timer") >= 3


@pytest.fixture
def hasty() -> Iterator[None]:
    """Threads give way to each other all the time."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def send(node: Node, count: int) -> None:
    publisher = node.create_publisher(Int32, "topic", 10)
    for number in range(count):
        publisher.publish(Int32(data=number))


@pytest.mark.usefixtures("hasty")
def test_no_message_is_lost_while_a_node_moves_between_threads(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    node, talker = Node("listener", context=context), Node("talker", context=context)
    got = numbers(node, "topic", depth=100_000)
    threads = [threading.Thread(target=spin_quietly, args=(each,)) for each in executors]
    sender = threading.Thread(target=send, args=(talker, 20_000))
    for thread in [*threads, sender]:
        thread.start()
    moves = 0
    while sender.is_alive() or moves < 10:
        executors[moves % 2].add_node(node)
        moves += 1
    deadline = time.monotonic() + PATIENCE
    while len(got) < 20_000 and time.monotonic() < deadline:
        time.sleep(0.001)
    assert sorted(got) == list(range(20_000))
    for each in executors:
        each.shutdown()
    for thread in threads:
        thread.join(PATIENCE)


def spin_quietly(executor: Executor) -> None:
    try:
        executor.spin()
    except ExternalShutdownException:
        return


@pytest.mark.usefixtures("hasty")
def test_two_threads_may_swap_nodes_between_executors(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    nodes = [Node(f"node_{index}", context=context) for index in range(2)]
    for node in nodes:
        numbers(node, "topic")
        node.create_timer(0.001, lambda: None)

    def swap(index: int) -> None:
        for step in range(500):
            executors[(index + step) % 2].add_node(nodes[index])
            executors[step % 2].spin_once(timeout_sec=0)

    threads = [threading.Thread(target=swap, args=(index,), daemon=True) for index in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE)
    assert not any(thread.is_alive() for thread in threads)
    assert sum(len(each.get_nodes()) for each in executors) == 2


def test_two_executors_share_a_context(context: Context) -> None:
    executors = [SingleThreadedExecutor(context=context) for _ in range(2)]
    nodes = [Node(f"node_{index}", context=context) for index in range(2)]
    got = [numbers(node, f"to_{index}", depth=1000) for index, node in enumerate(nodes)]
    ran_in: list[set[int]] = [set(), set()]
    for index, (node, each) in enumerate(zip(nodes, executors, strict=True)):
        to_other = node.create_publisher(Int32, f"to_{1 - index}", 1000)
        node.create_timer(0.0005, lambda p=to_other: p.publish(Int32()))
        node.create_timer(0.0005, lambda seen=ran_in[index]: seen.add(threading.get_ident()))
        each.add_node(node)
    threads = [threading.Thread(target=spin_quietly, args=(each,)) for each in executors]
    for thread in threads:
        thread.start()
    deadline = time.monotonic() + PATIENCE
    while min(map(len, got)) < 50 and time.monotonic() < deadline:
        time.sleep(0.001)
    context.shutdown()
    for thread in threads:
        thread.join(PATIENCE)
    assert min(map(len, got)) >= 50
    assert ran_in == [{thread.ident} for thread in threads]


def test_a_destroyed_subscription_gets_nothing_more(node: Node, executor: SingleThreadedExecutor) -> None:
    got: list[int] = []

    def once(message: Int32) -> None:
        got.append(message.data)
        assert node.destroy_subscription(subscription)

    subscription = node.create_subscription(Int32, "topic", once, 10)
    send(node, 5)
    spin_for(executor, 0.1)
    assert got == [0]


def test_a_node_may_be_destroyed_in_its_own_callback(node: Node, executor: SingleThreadedExecutor) -> None:
    other = Node("other", context=executor.context)
    executor.add_node(other)
    trace: list[str] = []
    got = numbers(node, "topic")

    def last_act() -> None:
        trace.append("node")
        send(node, 3)
        node.destroy_node()

    node.create_timer(0.1, last_act)
    other.create_timer(0.15, lambda: trace.append("other"))
    spin_for(executor, 0.5)
    assert trace == ["node", "other", "other", "other"]
    assert got == []
    assert executor.get_nodes() == [other]
