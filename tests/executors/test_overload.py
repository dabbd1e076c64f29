"""Rounds of an executor: who has a turn beside a flood or a slow callback, in which order, as in rclpy."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node
from robolink.callback_groups import MutuallyExclusiveCallbackGroup
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.host import Host
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

    def serve(self, name: str) -> None:
        """Answer requests, and write them down."""

        def answer(request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            self.order.append((name, 0))
            return response

        self.node.create_service(Trigger, name, answer)

    def until(self, count: int) -> list[Any]:
        """Spin until so many callbacks have run; return what they were called with."""
        spin_until(self.executor, lambda: len(self.order) >= count)
        return self.order


@pytest.fixture
def loop(executor: SingleThreadedExecutor) -> Loop:
    return Loop(executor)


# Who has a turn, and when


def test_each_kind_has_its_turn_in_rclpys_order(loop: Loop) -> None:
    node, order = loop.node, loop.order
    loop.serve("service")
    node.create_client(Trigger, "service").call_async(Trigger.Request()).add_done_callback(
        lambda _: order.append("reply")
    )
    guard = node.create_guard_condition(lambda: order.append("guard"))
    _, second = loop.hear("second", 10)
    _, third = loop.hear("third", 10)
    node.create_timer(0.1, lambda: order.append("timer"))
    for number in range(2):
        third(number)
        second(number)
    guard.trigger()
    loop.executor.context.time.sleep(150_000_000)
    loop.executor.create_task(lambda: order.append("task"))
    expected = [
        "task",
        "timer",
        ("second", 0),
        ("third", 0),
        "guard",
        ("service", 0),
        ("second", 1),
        ("third", 1),
        "reply",
    ]
    assert loop.until(len(expected)) == expected


def test_the_older_node_has_its_turns_first(loop: Loop) -> None:
    other = Loop(loop.executor)
    other.order = loop.order
    _, theirs = other.hear("theirs", 10)
    _, ours = loop.hear("ours", 10)
    theirs(0)
    ours(0)
    assert loop.until(2) == [("ours", 0), ("theirs", 0)]


def test_a_task_that_begins_another_keeps_nobody_waiting(loop: Loop) -> None:
    _, send = loop.hear("topic", 10)

    def again(left: int) -> None:
        loop.order.append(left)
        if left:
            loop.executor.create_task(again, left - 1)

    loop.executor.create_task(again, 3)
    send(0)
    send(1)
    assert loop.until(6) == [3, ("topic", 0), 2, ("topic", 1), 1, 0]


@pytest.mark.parametrize("qos", [10, KEEP_ALL], ids=["KEEP_LAST", "KEEP_ALL"])
def test_a_topic_that_is_too_fast_runs_once_for_each_turn_of_the_others(loop: Loop, qos: QoSProfile | int) -> None:
    subscription, flood = loop.hear("flood", qos)
    _, beat = loop.hear("beat", 10)
    for number in range(200):
        flood(number)
    beat(0)
    beat(1)
    assert [topic for topic, _ in loop.until(5)] == ["flood", "beat", "flood", "beat", "flood"]
    beat(2)
    flood(200)
    assert [topic for topic, _ in loop.until(7)][5:] == ["flood", "beat"]
    first = 190 if qos == 10 else 0  # ten waited, and the newest found room
    kept = list(range(first, 201))
    assert [number for topic, number in loop.until(len(kept) + 3) if topic == "flood"] == kept
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


def test_who_waits_for_a_busy_group_has_its_turn_in_order_when_that_is_free(loop: Loop) -> None:
    group = MutuallyExclusiveCallbackGroup()

    async def slow() -> None:
        loop.order.append("slow")
        await opens

    opens = loop.executor.create_future()
    timer = loop.node.create_timer(0.1, slow, group)
    loop.until(1)
    timer.cancel()
    publisher = loop.node.create_publisher(Int32, "topic", 10)
    loop.node.create_subscription(Int32, "topic", lambda _: loop.order.append("message"), 10, callback_group=group)
    publisher.publish(Int32())
    loop.executor.spin_once(timeout_sec=0)
    loop.node.create_timer(0.1, lambda: loop.order.append("timer"), group)
    loop.executor.spin_once(timeout_sec=0.1)
    assert loop.order == ["slow"]
    opens.set_result(None)
    assert loop.until(3) == ["slow", "timer", "message"]


# A backlog


class Backlog(Node):
    """Has a slow callback and 40 messages that wait for it, a timer, a service and a second topic.

    `nap` is what its slow callback does for 0.05 s.
    """

    def __init__(self, nap: Callable[[float], object], context: Context | None = None) -> None:
        super().__init__("backlog", context=context)
        self.nap, self.order = nap, list[str]()
        self.ticks, self.begin = list[float](), 0.0
        for topic, callback in (("slow", self.on_slow), ("quick", self.on_quick)):
            self.create_subscription(Int32, topic, callback, 50)
        self.create_service(Trigger, "ask", self.on_ask)
        self.asker = self.create_client(Trigger, "ask")
        self.slow, self.quick = (self.create_publisher(Int32, topic, 50) for topic in ("slow", "quick"))
        self.create_timer(0.1, self.on_tick)

    def fill(self) -> None:
        """Send it all to itself."""
        for _ in range(40):
            self.slow.publish(Int32())
        self.quick.publish(Int32())
        self.asker.call_async(Trigger.Request())
        self.begin = self.now()

    def now(self) -> float:
        """Return the seconds of its clock."""
        return self.get_clock().now().nanoseconds / 1e9

    def on_slow(self, _: Int32) -> None:
        self.nap(0.05)
        self.order.append("slow")

    def on_quick(self, _: Int32) -> None:
        self.order.append("quick")

    def on_ask(self, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        self.order.append("ask")
        return response

    def on_tick(self) -> None:
        self.ticks.append(self.now() - self.begin)

    def check(self) -> None:
        """Assert what the real rclpy does, after 1.55 s."""
        assert self.ticks[0] < 0.3
        assert 12 <= len(self.ticks) <= 16
        assert self.order.index("quick") <= 2
        assert self.order.index("ask") <= 3
        assert self.order.count("slow") >= 25


@pytest.fixture(params=["single", "threads", "once"])
def spin(request: pytest.FixtureRequest, context: Context) -> Iterator[Callable[[Node, float], None]]:
    """Return a function that spins a node for so many seconds, with one executor or another, in real time."""
    made = (
        MultiThreadedExecutor(4, context=context)
        if request.param == "threads"
        else SingleThreadedExecutor(context=context)
    )

    def act(node: Node, seconds: float) -> None:
        made.add_node(node)
        end = time.monotonic() + seconds
        if request.param == "once":
            while (left := end - time.monotonic()) > 0:
                made.spin_once(timeout_sec=left)
        else:
            made.spin_until_future_complete(made.create_future(), seconds)

    yield act
    made.shutdown()


@pytest.mark.slow
def test_a_backlog_keeps_nobody_waiting(spin: Callable[[Node, float], None], context: Context) -> None:
    node = Backlog(time.sleep, context)
    node.fill()
    spin(node, 1.55)
    node.check()


@pytest.mark.parametrize("kind", [SingleThreadedExecutor, MultiThreadedExecutor])
def test_a_backlog_keeps_nobody_waiting_in_virtual_time(virtual: Context, kind: Callable[..., Executor]) -> None:
    node = Backlog(lambda seconds: virtual.time.sleep(int(seconds * 1e9)), virtual)
    with kind(context=virtual) as executor:
        executor.add_node(node)
        node.fill()
        spin_until(executor, lambda: node.now() - node.begin >= 1.55)
    node.check()


def test_a_backlog_keeps_nobody_waiting_in_a_host() -> None:
    class Sleeping(Backlog):
        def __init__(self) -> None:
            super().__init__(time.sleep)

    with Host() as host:
        node = host.start_node(Sleeping)
        node.fill()
        host.run(1.55)
        node.check()


def test_timers_of_one_moment_come_before_what_the_first_of_them_sends() -> None:
    class Two(Node):
        def __init__(self) -> None:
            super().__init__("two")
            self.order: list[str] = []
            publisher = self.create_publisher(Int32, "topic", 10)
            self.create_subscription(Int32, "topic", lambda _: self.order.append("message"), 10)
            self.publisher = publisher
            self.create_timer(0.1, self.first)
            self.create_timer(0.1, lambda: self.order.append("two"))

        def first(self) -> None:
            self.order.append("one")
            self.publisher.publish(Int32())

    with Host() as host:
        node = host.start_node(Two)
        host.run(0.25)
        assert node.order == ["one", "two", "message"] * 2
