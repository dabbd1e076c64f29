"""Losses that nodes tell on /diagnostics: one that loses nothing has no part in it, and one that does is heard."""

from __future__ import annotations

from robolink import Context, Node
from robolink.event_handler import SubscriptionEventCallbacks
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from robolink.interfaces.std_msgs.msg import Int32
from robolink.node_parts.losses import Losses, losses_in
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.transport.zenoh import ZenohTransport
from tests.support.spins import spin_for, spin_until

LATCHED = QoSProfile(history=HistoryPolicy.KEEP_ALL, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_a_burst_beyond_the_depth_is_told_once_and_then_that_it_is_over(
    virtual: Context, executor: SingleThreadedExecutor
) -> None:
    node, other = Node("slow", context=virtual, namespace="lab"), Node("monitor", context=virtual)
    executor.add_node(node)
    executor.add_node(other)
    heard: list[DiagnosticArray] = []
    other.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    subscription = node.create_subscription(Int32, "/count", lambda message: None, 5)
    publisher = other.create_publisher(Int32, "/count", 10)
    for number in range(12):
        publisher.publish(Int32(data=number))
    spin_for(executor, 5.0)
    statuses = [each.status[0] for each in heard]
    assert [(each.level, each.message) for each in statuses] == [
        (DiagnosticStatus.WARN, "7 lost since the last report, 7 in all"),
        (DiagnosticStatus.OK, "7 lost before, none now"),
    ]
    assert statuses[0].name == "lab/slow: messages of /count"
    assert losses_in(heard[0]) == {subscription.gid: Losses(dropped=7)}


def test_who_comes_later_hears_what_was_lost(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = Node("slow", context=virtual)
    executor.add_node(node)
    publisher = node.create_publisher(Int32, "/count", 10)
    subscription = node.create_subscription(Int32, "/count", lambda message: None, 1)
    for _ in range(2):
        for number in range(3):
            publisher.publish(Int32(data=number))
        spin_for(executor, 5.0)
    heard: list[DiagnosticArray] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, LATCHED)
    spin_for(executor, 1.0)
    assert [losses_in(each) for each in heard] == [{subscription.gid: Losses(dropped=4)}]


def test_all_that_is_missing_of_a_keep_all_subscription_is_told(
    virtual: Context, executor: SingleThreadedExecutor
) -> None:
    node = Node("slow", context=virtual)
    executor.add_node(node)
    publisher = node.create_publisher(Int32, "/count", 10)
    subscription = node.create_subscription(
        Int32, "/count", lambda message: None, QoSProfile(history=HistoryPolicy.KEEP_ALL)
    )
    heard: list[DiagnosticArray] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    publisher.publish(Int32())
    for _ in range(3):
        publisher._attachment()
    publisher.publish(Int32())
    spin_for(executor, 1.0)
    assert losses_in(heard[0]) == {subscription.gid: Losses(lost=3)}


def test_a_node_that_loses_nothing_publishes_nothing(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node = Node("quick", context=virtual)
    executor.add_node(node)
    publisher = node.create_publisher(Int32, "/count", 10)
    node.create_subscription(Int32, "/count", lambda message: None, 5)
    for number in range(20):
        publisher.publish(Int32(data=number))
        spin_for(executor, 0.1)
    assert node.count_publishers("/diagnostics") == 0


def test_a_node_that_moves_to_another_executor_goes_on_to_tell(
    virtual: Context, executor: SingleThreadedExecutor
) -> None:
    node = Node("slow", context=virtual)
    executor.add_node(node)
    publisher = node.create_publisher(Int32, "/count", 10)
    node.create_subscription(Int32, "/count", lambda message: None, 1)
    heard: list[DiagnosticArray] = []
    node.create_subscription(DiagnosticArray, "/diagnostics", heard.append, 10)
    publisher.publish(Int32())
    publisher.publish(Int32())
    spin_for(executor, 0.1)
    with SingleThreadedExecutor(context=virtual) as another:
        another.add_node(node)
        publisher.publish(Int32())
        publisher.publish(Int32())
        spin_for(another, 5.0)
    assert [each.status[0].message for each in heard][-1] == "2 lost before, none now"


def test_a_destroyed_node_tells_nothing_more(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node, other = Node("slow", context=virtual), Node("monitor", context=virtual)
    executor.add_node(node)
    executor.add_node(other)
    publisher = other.create_publisher(Int32, "/count", 10)
    node.create_subscription(Int32, "/count", lambda message: None, 1)
    publisher.publish(Int32())
    publisher.publish(Int32())
    spin_for(executor, 5.0)
    assert other.count_publishers("/diagnostics") == 1
    publisher.publish(Int32())
    publisher.publish(Int32())
    node.destroy_node()
    spin_for(executor, 5.0)
    assert other.count_publishers("/diagnostics") == 0


def test_what_did_not_arrive_is_counted_apart_from_what_was_dropped(
    virtual: Context, executor: SingleThreadedExecutor
) -> None:
    node = Node("slow", context=virtual)
    executor.add_node(node)
    publisher = node.create_publisher(Int32, "/count", 10)
    watched = SubscriptionEventCallbacks(message_lost=lambda info: None)
    subscription = node.create_subscription(Int32, "/count", lambda message: None, 3, event_callbacks=watched)
    for missing in (0, 4, 2):
        for _ in range(5):
            publisher.publish(Int32())
        spin_for(executor, 1.0)
        for _ in range(missing):
            publisher._attachment()
    publisher.publish(Int32())
    spin_for(executor, 1.0)
    assert (subscription.lost, subscription.dropped) == (6, 6)


def test_what_is_lost_in_a_network_is_counted_for_any_depth(domain: int) -> None:
    context = Context(transport=ZenohTransport(domain, environ={}))
    context.init([], domain_id=domain)
    with context:
        node, got = Node("hears", context=context), list[int]()
        subscription = node.create_subscription(Int32, "/count", lambda message: got.append(message.data), 10)
        publisher = Node("says", context=context).create_publisher(Int32, "/count", 10)
        publisher.publish(Int32(data=1))
        for _ in range(3):
            publisher._attachment()
        publisher.publish(Int32(data=2))
        with SingleThreadedExecutor(context=context) as executor:
            executor.add_node(node)
            spin_until(executor, lambda: got == [1, 2])
        assert (subscription.lost, subscription.dropped) == (3, 0)


def test_diagnostics_of_others_are_passed_over() -> None:
    values = [KeyValue(key="subscription", value="front"), KeyValue(key="lost", value="many")]
    foreign = [DiagnosticStatus(name="battery"), DiagnosticStatus(name="laser", values=values)]
    assert losses_in(DiagnosticArray(status=foreign)) == {}
