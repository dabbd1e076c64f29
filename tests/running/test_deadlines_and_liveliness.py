"""Deadlines and liveliness: what ROS 2 counts over DDS, in virtual time, with faults, and between sessions."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from robolink import Context, Node, logging
from robolink.duration import Duration
from robolink.event_handler import (
    PublisherEventCallbacks,
    QoSLivelinessChangedInfo,
    QoSLivelinessLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSRequestedDeadlineMissedInfo,
    SubscriptionEventCallbacks,
)
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.publisher import Publisher
from robolink.qos import HistoryPolicy, LivelinessPolicy, QoSProfile
from robolink.subscription import Subscription
from robolink.testing import System
from tests.support.spins import spin_for, spin_until
from tests.support.transports import Network

Log = list[tuple[float, Any]]
AUTOMATIC, MANUAL = LivelinessPolicy.AUTOMATIC, LivelinessPolicy.MANUAL_BY_TOPIC


def within(seconds: float, **more: Any) -> QoSProfile:
    """Profile with a deadline of so many seconds."""
    return QoSProfile(depth=10, deadline=Duration(seconds=seconds), **more)


def leased(seconds: float, liveliness: LivelinessPolicy = MANUAL) -> QoSProfile:
    """Profile with a lease of so many seconds."""
    return QoSProfile(depth=10, liveliness=liveliness, liveliness_lease_duration=Duration(seconds=seconds))


@pytest.fixture
def tested() -> Iterator[System]:
    logging.set_console_handler(None)
    with System(seed=7) as made:
        yield made


@pytest.fixture
def node(virtual: Context, executor: SingleThreadedExecutor) -> Node:
    made = Node("node", context=virtual)
    executor.add_node(made)
    return made


def noting(node: Node, log: Log) -> Callable[[Any], None]:
    """Callback that notes an event, and when it is called, in seconds."""
    return lambda info: log.append((round(node.context.time.now() / 1e9, 3), info))


def publisher(node: Node, qos: QoSProfile, log: Log) -> Publisher[Int32]:
    note = noting(node, log)
    events = PublisherEventCallbacks(deadline=note, liveliness=note)
    return node.create_publisher(Int32, "topic", qos, event_callbacks=events)


def subscription(node: Node, qos: QoSProfile, log: Log) -> Subscription[Int32]:
    note = noting(node, log)
    events = SubscriptionEventCallbacks(deadline=note, liveliness=note)
    return node.create_subscription(Int32, "topic", lambda message: None, qos, event_callbacks=events)


def changed(alive: int, not_alive: int, alive_change: int, not_alive_change: int) -> QoSLivelinessChangedInfo:
    return QoSLivelinessChangedInfo(alive, not_alive, alive_change, not_alive_change)


# Deadlines


def test_a_deadline_begins_with_the_first_message_and_is_missed_each_period(
    node: Node, executor: SingleThreadedExecutor
) -> None:
    offered: Log = []
    requested: Log = []
    subscription(node, within(0.3), requested)
    sender = publisher(node, within(0.3), offered)
    spin_for(executor, 1.0)
    assert offered == requested == []
    sender.publish(Int32())
    spin_for(executor, 1.0)
    assert offered == [(t, QoSOfferedDeadlineMissedInfo(i, 1)) for i, t in enumerate((1.3, 1.6, 1.9), 1)]
    assert requested == [(t, QoSRequestedDeadlineMissedInfo(i, 1)) for i, t in enumerate((1.3, 1.6, 1.9), 1)]
    sender.publish(Int32())
    spin_for(executor, 0.29)
    assert len(offered) == len(requested) == 3


def test_what_was_missed_while_nothing_spun_is_counted_once(node: Node, executor: SingleThreadedExecutor) -> None:
    log: Log = []
    sender = publisher(node, within(0.3), log)
    sender.publish(Int32())
    spin_for(executor, 0.1)
    node.context.time.sleep(1_000_000_000)
    spin_for(executor, 0.15)
    assert [info for _, info in log] == [QoSOfferedDeadlineMissedInfo(3, 3), QoSOfferedDeadlineMissedInfo(4, 1)]


def test_a_period_as_long_as_the_deadline_meets_it(node: Node, executor: SingleThreadedExecutor) -> None:
    log: Log = []
    subscription(node, within(0.1), log)
    sender = publisher(node, within(0.1), log)
    node.create_timer(0.1, lambda: sender.publish(Int32()))
    spin_for(executor, 10.0)
    assert log == []


def test_each_end_has_the_deadline_of_its_own_profile(node: Node, executor: SingleThreadedExecutor) -> None:
    offered: Log = []
    requested: Log = []
    subscription(node, within(0.4), requested)
    publisher(node, within(0.2), offered).publish(Int32())
    spin_for(executor, 1.5)
    assert (len(offered), len(requested)) == (7, 3)


def test_a_message_of_any_publisher_meets_a_subscriptions_deadline(
    node: Node, executor: SingleThreadedExecutor
) -> None:
    log: Log = []
    subscription(node, within(0.3), log)
    for delay in (0.2, 0.3):
        other = node.create_publisher(Int32, "topic", 10)
        node.create_timer(delay, lambda other=other: other.publish(Int32()))
    spin_for(executor, 3.0)
    assert log == []


@pytest.mark.parametrize("history", [HistoryPolicy.KEEP_LAST, HistoryPolicy.KEEP_ALL])
def test_messages_meet_the_deadline_as_they_arrive_whatever_the_program_does(
    node: Node, executor: SingleThreadedExecutor, history: HistoryPolicy
) -> None:
    log: Log = []
    subscription(node, within(0.3, history=history), log)
    sender = node.create_publisher(Int32, "topic", 10)
    for _ in range(20):  # nothing spins meanwhile
        sender.publish(Int32())
        node.context.time.sleep(200_000_000)
    spin_for(executor, 0.05)
    assert log == []


def test_a_node_that_moves_to_another_executor_loses_none(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node, log = Node("node", context=virtual), Log()
    executor.add_node(node)
    publisher(node, within(0.3), log).publish(Int32())
    spin_for(executor, 0.7)
    with SingleThreadedExecutor(context=virtual) as other:
        other.add_node(node)
        spin_for(other, 0.6)
    assert [info for _, info in log] == [QoSOfferedDeadlineMissedInfo(i, 1) for i in range(1, 5)]


def test_a_destroyed_publisher_misses_nothing(node: Node, executor: SingleThreadedExecutor) -> None:
    log: Log = []
    sender = publisher(node, within(0.3), log)
    sender.publish(Int32())
    spin_for(executor, 0.1)
    node.destroy_publisher(sender)
    spin_for(executor, 2.0)
    assert log == []


def test_without_deadline_and_lease_there_are_no_events(node: Node, executor: SingleThreadedExecutor) -> None:
    log: Log = []
    subscription(node, QoSProfile(depth=10), log)
    publisher(node, QoSProfile(depth=10, liveliness=MANUAL), log).publish(Int32())
    spin_for(executor, 100.0)
    assert log == []


def lossy(system: System) -> Log:
    """A sensor at 10 Hz on a network that loses a third, and the deadlines that are missed at the other end in 30 s."""
    log = Log()

    class Sensor(Node):
        def __init__(self) -> None:
            super().__init__("sensor")
            sender = publisher(self, within(0.15), log)
            self.create_timer(0.1, lambda: sender.publish(Int32()))

    class Watcher(Node):
        def __init__(self) -> None:
            super().__init__("watcher")
            subscription(self, within(0.15), log)

    system.faults.lose("topic", 0.3)
    system.start(Watcher)
    system.start(Sensor)
    system.run(30.0)
    return log


def test_a_lossy_network_misses_deadlines_the_same_ones_each_time(tested: System) -> None:
    log = lossy(tested)
    with System(seed=7) as again:
        assert lossy(again) == log
    assert {type(info) for _, info in log} == {QoSRequestedDeadlineMissedInfo}
    assert 50 < log[-1][1].total_count < 150
    with System(seed=8) as other:
        assert lossy(other) != log


# Liveliness


def test_a_manual_publisher_is_alive_until_its_lease_ends(node: Node, executor: SingleThreadedExecutor) -> None:
    lost: Log = []
    seen: Log = []
    subscription(node, leased(0.4), seen)
    sender = publisher(node, leased(0.4), lost)
    spin_for(executor, 1.0)
    assert lost == seen == []
    sender.publish(Int32())
    spin_for(executor, 1.0)
    assert lost == [(1.4, QoSLivelinessLostInfo(1, 1))]
    assert seen == [(1.0, changed(1, 0, 1, 0)), (1.4, changed(0, 1, -1, 1))]
    for _ in range(6):
        sender.assert_liveliness()
        spin_for(executor, 0.2)
    assert (len(lost), len(seen)) == (1, 3)
    spin_for(executor, 1.0)
    assert lost[1:] == [(3.4, QoSLivelinessLostInfo(2, 1))]
    assert [info for _, info in seen[2:]] == [changed(1, 0, 1, -1), changed(0, 1, -1, 1)]


def test_who_goes_is_taken_from_the_count_that_it_was_in(node: Node, executor: SingleThreadedExecutor) -> None:
    seen: Log = []
    subscription(node, leased(0.4), seen)
    one, other = (publisher(node, leased(0.4), []) for _ in range(2))
    one.publish(Int32())
    other.publish(Int32())
    spin_for(executor, 0.3)
    one.publish(Int32())
    spin_for(executor, 0.2)
    assert [info for _, info in seen] == [changed(2, 0, 2, 0), changed(1, 1, -1, 1)]
    node.destroy_publisher(other)
    spin_for(executor, 0.01)
    node.destroy_publisher(one)
    spin_for(executor, 0.01)
    assert [info for _, info in seen[2:]] == [changed(1, 0, 0, -1), changed(0, 0, -1, 0)]


def test_an_automatic_publisher_is_alive_while_it_is_there(node: Node, executor: SingleThreadedExecutor) -> None:
    lost: Log = []
    seen: Log = []
    subscription(node, leased(0.4, AUTOMATIC), seen)
    sender = publisher(node, leased(0.4, AUTOMATIC), lost)
    spin_for(executor, 5.0)
    sender.assert_liveliness()
    node.destroy_publisher(sender)
    spin_for(executor, 1.0)
    assert lost == []
    assert [info for _, info in seen] == [changed(1, 0, 1, 0), changed(0, 0, -1, 0)]


def test_the_lease_is_that_of_the_subscription(node: Node, executor: SingleThreadedExecutor) -> None:
    lost: Log = []
    seen: Log = []
    subscription(node, leased(0.6, AUTOMATIC), seen)
    publisher(node, leased(0.3), lost).publish(Int32())
    spin_for(executor, 2.0)
    assert [time for time, _ in lost] == [0.3]
    assert [time for time, _ in seen] == [0.0, 0.6]


def between(net: Network, act: Callable[[Publisher[Int32]], object]) -> list[Any]:
    """What a subscription is told of a publisher in another session that acts once and is destroyed then."""
    seen: Log = []
    near, far = (Context(transport=net.session()) for _ in range(2))
    with near, far:
        node, executor = Node("near", context=near), SingleThreadedExecutor(context=near)
        executor.add_node(node)
        reader = subscription(node, leased(0.2), seen)
        other = Node("far", context=far)
        sender = publisher(other, leased(0.2), [])
        spin_until(executor, lambda: reader.get_publisher_count() == 1 and sender.get_subscription_count() == 1)
        act(sender)
        spin_until(executor, lambda: len(seen) >= 2)
        other.destroy_node()
        spin_until(executor, lambda: len(seen) >= 3)
    return [info for _, info in seen]


ONCE = [changed(1, 0, 1, 0), changed(0, 1, -1, 1), changed(0, 0, 0, -1)]


def test_messages_assert_liveliness_between_sessions(net: Network) -> None:
    assert between(net, lambda sender: sender.publish(Int32())) == ONCE


@pytest.mark.unlike_dds("an assertion without a message does not leave a session")
def test_an_assertion_without_a_message_is_heard_between_sessions(net: Network) -> None:
    assert between(net, lambda sender: sender.assert_liveliness()) == ONCE
