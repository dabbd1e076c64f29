"""Publishers and subscriptions: delivery, depth, latched topics, bad payloads, bad messages, bounded memory."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.exceptions import EncodeError, InvalidHandle
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.message import decode, encode
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.subscription import MessageInfo, Subscription
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import pack_attachment
from tests.support.programs import Program
from tests.support.spins import numbers, spin_for, spin_until

PATIENCE = 30.0
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
KEEP_ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


def publish(node: Node, values: list[int], qos: QoSProfile | int = 10) -> None:
    publisher = node.create_publisher(Int32, "topic", qos)
    for value in values:
        publisher.publish(Int32(data=value))


def test_a_message_reaches_every_subscription_but_not_its_sender(node: Node, executor: SingleThreadedExecutor) -> None:
    other = Node("other", context=executor.context)
    executor.add_node(other)
    got: list[Twist] = []
    for each in (node, node, other):
        each.create_subscription(Twist, "cmd_vel", got.append, 10)
    sent = Twist()
    sent.linear.x = 0.3
    publisher = node.create_publisher(Twist, "cmd_vel", 10)
    publisher.publish(sent)
    sent.linear.x = 99.0
    assert got == []
    spin_for(executor, 0.1)
    assert [each.linear.x for each in got] == [0.3, 0.3, 0.3]
    assert len({id(each) for each in got}) == 3


def test_a_received_message_can_be_changed_and_sent_on(node: Node, executor: SingleThreadedExecutor) -> None:
    onward = node.create_publisher(Int32, "topic", 10)

    def on_number(message: Int32) -> None:
        if message.data < 5:
            message.data += 1
            onward.publish(message)

    got = numbers(node, "topic")
    node.create_subscription(Int32, "topic", on_number, 10)
    onward.publish(Int32(data=2))
    spin_for(executor, 0.1)
    assert got == [2, 3, 4, 5]


@pytest.mark.parametrize("depth", [1, 3, 10])
def test_a_slow_subscriber_sees_the_last_ones(node: Node, executor: SingleThreadedExecutor, depth: int) -> None:
    got: list[int] = []
    subscription = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), depth)
    publish(node, list(range(8)))
    spin_for(executor, 0.1)
    assert got == list(range(8))[-depth:]
    assert subscription.dropped == max(0, 8 - depth)


def test_keep_all_keeps_all_while_a_callback_is_slow(node: Node, executor: SingleThreadedExecutor) -> None:
    got: list[int] = []

    def slow(message: Int32) -> None:
        got.append(message.data)
        if len(got) == 1:
            publish(node, list(range(1, 500)))

    subscription = node.create_subscription(Int32, "topic", slow, KEEP_ALL)
    publish(node, [0])
    spin_for(executor, 0.1)
    assert got == list(range(500))
    assert subscription.dropped == 0


def test_no_depth_is_the_systems_depth(node: Node, executor: SingleThreadedExecutor) -> None:
    with pytest.warns(UserWarning, match="zero depth"):
        subscription = node.create_subscription(Int32, "topic", lambda _: None, 0)
    publish(node, list(range(100)))
    executor.inbox.sweep()
    assert len(subscription.mailbox) == 42


def test_a_latched_topic_reaches_who_comes_late(node: Node, executor: SingleThreadedExecutor) -> None:
    publish(node, [1, 2, 3, 4], LATCHED)
    got: list[int] = []
    node.create_subscription(Int32, "topic", lambda message: got.append(message.data), LATCHED)
    volatile = numbers(node, "topic")
    spin_for(executor, 0.1)
    assert (got, volatile) == ([2, 3, 4], [])


def test_a_callback_may_take_what_is_known_about_the_message(node: Node, executor: SingleThreadedExecutor) -> None:
    infos: list[MessageInfo] = []
    subscription = node.create_subscription(Int32, "topic", lambda _, info: infos.append(info), 10)
    executor.context.time.sleep(5)
    publish(node, [1, 2])
    executor.context.time.sleep(7)
    spin_for(executor, 0.1)
    assert subscription._callback_type is Subscription.CallbackType.WithMessageInfo
    assert [info["publication_sequence_number"] for info in infos] == [1, 2]
    assert [info["source_timestamp"] for info in infos] == [5, 5]
    assert [info["received_timestamp"] for info in infos] == [12, 12]


def test_a_callback_must_take_one_or_two_arguments(node: Node) -> None:
    with pytest.raises(RuntimeError, match=r"/topic: a callback takes the message, .* takes neither"):
        node.create_subscription(Int32, "topic", lambda: None, 10)
    assert list(node.subscriptions) == []
    assert node.count_subscribers("topic") == 0


def test_raw_bytes_both_ways(node: Node, executor: SingleThreadedExecutor) -> None:
    got: list[Any] = []
    node.create_subscription(Int32, "topic", got.append, 10, raw=True)
    node.create_subscription(Int32, "topic", got.append, 10)
    node.create_publisher(Int32, "topic", 10).publish(encode(Int32(data=7)))
    spin_for(executor, 0.1)
    assert decode(Int32, got[0]) == got[1] == Int32(data=7)


def test_coroutine_callbacks_wait_without_blocking_others(node: Node, executor: SingleThreadedExecutor) -> None:
    trace: list[str] = []
    pause = executor.create_future()

    async def on_number(message: Int32) -> None:
        trace.append(f"begin {message.data}")
        await pause
        trace.append(f"end {message.data}")

    node.create_subscription(Int32, "topic", on_number, 10)
    publish(node, [1, 2])
    spin_for(executor, 0.05)
    assert trace == ["begin 1"]
    pause.set_result(None)
    spin_for(executor, 0.05)
    assert trace == ["begin 1", "end 1", "begin 2", "end 2"]


# What does not fit


def test_a_wrong_field_is_named(node: Node) -> None:
    publisher = node.create_publisher(Twist, "cmd_vel", 10)
    message = Twist()
    message.linear.x = "fast"  # type: ignore[assignment] # what is tested
    with pytest.raises(EncodeError, match=r"Twist\.linear\.x: expected float64, got 'fast'"):
        publisher.publish(message)


@pytest.mark.parametrize("wrong", [String(), None, 3, Int32])
def test_a_message_of_another_type_is_refused(node: Node, wrong: Any) -> None:
    with pytest.raises(TypeError, match=r"Expected .*Int32.*, got"):
        node.create_publisher(Int32, "topic", 10).publish(wrong)


@pytest.mark.parametrize("wrong", ["ten", None, 1.5, True])
def test_a_qos_is_a_profile_or_a_number(node: Node, wrong: Any) -> None:
    with pytest.raises(TypeError, match="Expected QoSProfile or int"):
        node.create_publisher(Int32, "topic", wrong)
    with pytest.raises(ValueError, match="greater than or equal to zero"):
        node.create_publisher(Int32, "topic", -1)


def test_a_malformed_payload_is_counted_and_told_once(
    node: Node, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    got: list[str] = []
    subscription = node.create_subscription(String, "topic", lambda message: got.append(message.data), 10)
    publisher = node.create_publisher(String, "topic", 10)
    for payload in (b"", b"\x00", encode(String(data="fine")), b"\x00\x01\x00\x00\xff\xff\xff\x7f"):
        publisher.publish(payload)
    spin_for(executor, 0.1)
    assert got == ["fine"]
    assert subscription.malformed == 3
    warnings = [each for each in log_lines if each.severity.name == "WARN"]
    assert len(warnings) == 1
    assert (warnings[0].name, warnings[0].message.split(":")[0]) == ("node", "/topic")
    assert "std_msgs/msg/String" in warnings[0].message


@pytest.mark.parametrize("attachment", [b"", b"nonsense", b"\x00" * 34])
def test_a_message_without_ros_2_attachment_is_dropped_and_told_once(
    bus: Bus, node: Node, executor: SingleThreadedExecutor, log_lines: list[Record], attachment: bytes
) -> None:
    """As rmw_zenoh does it, so that what works here works with a real robot."""
    got = numbers(node, "topic")
    (subscription,) = (each for each in node.subscriptions if each.topic_name == "/topic")
    outlet = MemoryTransport(bus=bus).advertise(subscription._endpoint.key, QoSProfile(depth=10))
    for data, sent in enumerate([attachment, attachment, pack_attachment(1, 2, b"*" * 16)]):
        outlet.put(encode(Int32(data=data)), sent)
    spin_for(executor, 0.1)
    assert got == [2]
    assert subscription.malformed == 2
    (warning,) = (each.message for each in log_lines if each.severity.name == "WARN")
    assert (
        f"/topic: dropped a message whose attachment is not ROS 2's: an attachment has 33 bytes, got {len(attachment)}"
        in warning
    )


def test_what_was_destroyed_is_of_no_use(node: Node) -> None:
    publisher = node.create_publisher(Int32, "topic", 10)
    assert node.destroy_publisher(publisher)
    assert not node.destroy_publisher(publisher)
    publisher.destroy()
    with pytest.raises(InvalidHandle, match="/topic has been destroyed"):
        publisher.publish(Int32())
    subscription = node.create_subscription(Int32, "topic", lambda _: None, 10)
    assert node.destroy_subscription(subscription)
    assert not node.destroy_subscription(subscription)


def test_entities_are_context_managers(node: Node) -> None:
    with (
        node.create_publisher(Int32, "topic", 10) as publisher,
        node.create_subscription(Int32, "topic", lambda _: None, 10) as subscription,
    ):
        assert (publisher.topic_name, subscription.topic_name) == ("/topic", "/topic")
        assert (publisher.logger_name, subscription.logger_name) == ("node", "node")
        assert publisher.wait_for_all_acked()
        publisher.assert_liveliness()
    assert node.count_publishers("topic") == node.count_subscribers("topic") == 0


# Over the network


@pytest.fixture
def networked(domain: int) -> Any:
    context = Context()
    context.init([], domain_id=domain)
    with context:
        yield context


@pytest.mark.parametrize("spun", [False, True])
def test_memory_stays_bounded_while_nobody_spins(networked: Context, spun: bool) -> None:
    node = Node("node", context=networked)
    if spun:
        SingleThreadedExecutor(context=networked).add_node(node)
    subscription = node.create_subscription(Int32, "topic", lambda _: None, 5)
    publish(node, list(range(1000)))
    inbox = networked.inbox if node.executor is None else node.executor.inbox
    deadline = time.monotonic() + PATIENCE
    while subscription.dropped < 995 and time.monotonic() < deadline:
        time.sleep(0.001)
    assert (subscription.dropped, len(subscription.mailbox)) == (995, 5)
    assert inbox._queue.qsize() < 5  # one notice for all of them, and calls to look around


def test_a_message_wakes_a_thread_that_spins(networked: Context) -> None:
    node, got = Node("node", context=networked), threading.Event()
    node.create_subscription(Int32, "topic", lambda _: got.set(), 10)
    executor = SingleThreadedExecutor(context=networked)
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    publish(node, [1])
    assert got.wait(PATIENCE)
    executor.shutdown()
    thread.join(PATIENCE)


MAP = """
    import robolink as rclpy
    from robolink.interfaces.std_msgs.msg import String
    from robolink.qos import DurabilityPolicy, QoSProfile

    rclpy.init()
    node = rclpy.create_node("map_server")
    publisher = node.create_publisher(String, "map", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    publisher.publish(String(data="old"))
    publisher.publish(String(data="a room"))
    node.create_subscription(String, "echo", lambda message: print(message.data), 10)
    print("ready")
    rclpy.spin(node)
"""


@pytest.mark.processes
def test_another_process_is_heard_and_hears(tmp_path: Path, domain: int, networked: Context) -> None:
    with Program(tmp_path, MAP, domain) as program:
        assert program.line() == "ready"
        node, got = Node("late", context=networked), list[str]()
        publisher = node.create_publisher(String, "echo", 10)
        node.create_subscription(String, "map", lambda message: got.append(message.data), LATCHED)
        with SingleThreadedExecutor(context=networked) as executor:
            executor.add_node(node)
            spin_until(executor, lambda: bool(got) and publisher.get_subscription_count() == 1)
        assert got == ["a room"]
        publisher.publish(String(data="hello"))
        assert program.line() == "hello"
