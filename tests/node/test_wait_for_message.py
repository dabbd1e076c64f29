"""Waiting for one message: with nobody spinning, beside somebody who spins, within a callback, and in vain."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.wait_for_message import wait_for_message

PATIENCE = 30.0
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def publish_when_wanted(node: Node, context: Context) -> threading.Thread:
    """Publish 7, then 8, once somebody subscribes."""
    publisher = node.create_publisher(Int32, "topic", 10)

    def publish() -> None:
        assert context.graph.wait_for(lambda: publisher.get_subscription_count() > 0, PATIENCE)
        for number in (7, 8):
            publisher.publish(Int32(data=number))

    thread = threading.Thread(target=publish)
    thread.start()
    return thread


@pytest.mark.parametrize("spun", [False, True])
def test_the_first_message_is_what_comes(context: Context, spun: bool) -> None:
    node, talker = Node("node", context=context), Node("talker", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin if spun else lambda: None)
    spinner.start()
    thread = publish_when_wanted(talker, context)
    found, message = wait_for_message(Int32, node, "topic", qos_profile=10, time_to_wait=PATIENCE)
    thread.join(PATIENCE)
    executor.shutdown()
    spinner.join(PATIENCE)
    assert found
    assert message == Int32(data=7)
    assert list(node.subscriptions) == []


def test_in_a_callback(virtual: Context, executor: SingleThreadedExecutor) -> None:
    node, found = Node("node", context=virtual), list[object]()
    node.create_publisher(Int32, "kept", LATCHED).publish(Int32(data=3))
    executor.add_node(node)
    node.create_guard_condition(
        lambda: found.append(wait_for_message(Int32, node, "kept", qos_profile=LATCHED))
    ).trigger()
    executor.spin_once()
    assert found == [(True, Int32(data=3))]


def test_in_vain(virtual: Context) -> None:
    node = Node("node", context=virtual)
    assert wait_for_message(Int32, node, "topic", time_to_wait=3600.0) == (False, None)
    assert virtual.time.now() == 3600 * 10**9


@pytest.mark.parametrize("end", [Context.shutdown, Context.interrupt])
def test_the_end_of_the_context_ends_it(context: Context, end: Callable[[Context], object]) -> None:
    node = Node("node", context=context)

    def end_it() -> None:
        assert context.graph.wait_for(lambda: node.count_subscribers("topic") == 1, PATIENCE)
        end(context)

    thread = threading.Thread(target=end_it)
    thread.start()
    assert wait_for_message(Int32, node, "topic") == (False, None)
    thread.join(PATIENCE)
