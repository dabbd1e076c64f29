"""Fairness of an executor: a flood, or a slow callback, beside a heartbeat and a service of the same node."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import HistoryPolicy, QoSProfile
from tests.support.spins import spin_until

KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


class Loop:
    """Nodes whose callbacks write down what they are called with."""

    def __init__(self, executor: SingleThreadedExecutor) -> None:
        self.node, self.executor = Node("node", context=executor.context), executor
        executor.add_node(self.node)
        self.order: list[Any] = []

    def hear(self, topic: str, qos: QoSProfile | int) -> tuple[Any, Callable[[int], None]]:
        """Subscribe to a topic; return the subscription, and a function that publishes a number."""
        publisher = self.node.create_publisher(Int32, topic, 10)
        subscription = self.node.create_subscription(
            Int32, topic, lambda message: self.order.append((topic, message.data)), qos
        )
        return subscription, lambda number: publisher.publish(Int32(data=number))

    def until(self, count: int) -> list[Any]:
        """Spin until so many callbacks have run; return what they were called with."""
        spin_until(self.executor, lambda: len(self.order) >= count)
        return self.order


@pytest.fixture
def loop(executor: SingleThreadedExecutor) -> Loop:
    return Loop(executor)


def test_without_overload_callbacks_run_in_the_order_of_arrival(loop: Loop) -> None:
    _, flood = loop.hear("flood", 10)
    _, beat = loop.hear("beat", 10)
    for number in range(10):
        flood(number)
    beat(0)
    assert loop.until(11) == [*(("flood", number) for number in range(10)), ("beat", 0)]


@pytest.mark.parametrize("qos", [10, KEEP_ALL], ids=["KEEP_LAST", "KEEP_ALL"])
def test_a_topic_that_is_too_fast_runs_once_for_each_turn_of_the_others(loop: Loop, qos: QoSProfile | int) -> None:
    subscription, flood = loop.hear("flood", qos)
    _, beat = loop.hear("beat", 10)
    for number in range(200):
        flood(number)
    beat(0)
    beat(1)
    assert loop.until(1)[0][0] == "flood"
    assert [topic for topic, _ in loop.until(4)][1:] == ["beat", "beat", "flood"]
    beat(2)
    flood(200)
    assert [topic for topic, _ in loop.until(6)][4:] in (["beat", "flood"], ["flood", "beat"])
    kept = 11 if qos == 10 else 201  # ten waited when the first was taken, and one came later
    assert [number for topic, number in loop.until(kept + 3) if topic == "flood"] == list(range(201 - kept, 201))
    assert not subscription.mailbox.waiting


def test_nothing_that_waits_is_forgotten_when_a_node_moves(loop: Loop, virtual: Context) -> None:
    subscription, flood = loop.hear("flood", 10)
    _, beat = loop.hear("beat", 10)
    for number in range(15):
        flood(number)
    beat(0)
    loop.until(3)
    with SingleThreadedExecutor(context=virtual) as another:
        another.add_node(loop.node)
        flood(15)
        spin_until(another, lambda: not subscription.mailbox.waiting)
        flood(16)
        spin_until(another, lambda: ("flood", 16) in loop.order)
    assert [number for topic, number in loop.order if topic == "flood"] == list(range(5, 17))


def test_a_service_answers_beside_a_slow_subscription(loop: Loop) -> None:
    _, flood = loop.hear("flood", 10)

    def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        loop.order.append(("ask", 0))
        return response

    loop.node.create_service(Trigger, "ask", answer)
    client = loop.node.create_client(Trigger, "ask")
    for number in range(15):
        flood(number)
    client.call_async(Trigger.Request())
    assert ("ask", 0) in loop.until(3)


def test_after_the_overload_the_order_is_that_of_arrival_again(loop: Loop) -> None:
    _, flood = loop.hear("flood", 10)
    _, beat = loop.hear("beat", 10)
    for number in range(20):
        flood(number)
    loop.until(10)
    loop.order.clear()
    for number in range(3):
        flood(number)
    beat(0)
    assert loop.until(4) == [("flood", 0), ("flood", 1), ("flood", 2), ("beat", 0)]
