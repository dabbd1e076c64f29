"""Large messages between nodes: what was sent stays as it was, whoever changes, keeps or sends whatever afterwards."""

from __future__ import annotations

import threading
from array import array
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.sensor_msgs.msg import Image
from robolink.message.numbers import VIEW_FROM
from robolink.qos import DurabilityPolicy, QoSProfile
from tests.support.spins import spin_until
from tests.support.transports import Network

SIZE = 2 * VIEW_FROM
LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture
def executor(net: Network) -> Iterator[SingleThreadedExecutor]:
    """Make an executor of two nodes, `sender` and `receiver`, which share a session."""
    context = Context(transport=net.session())
    context.init(args=[])
    executor = SingleThreadedExecutor(context=context)
    for name in ("sender", "receiver"):
        executor.add_node(Node(name, context=context))
    yield executor
    executor.shutdown()
    context.try_shutdown()


def nodes(executor: SingleThreadedExecutor) -> Any:
    return executor.get_nodes()


def image(number: int, size: int = SIZE) -> Any:
    return Image(width=number, data=array("B", [number % 256]) * size)


def is_whole(got: Any) -> bool:
    return bool(got.data == array("B", [got.width % 256]) * len(got.data))


@pytest.mark.parametrize("qos", [QoSProfile(depth=100), LATCHED], ids=["volatile", "latched"])
def test_a_publisher_may_change_and_send_the_same_message_again(
    executor: SingleThreadedExecutor, qos: QoSProfile
) -> None:
    sender, receiver = nodes(executor)
    got: list[Any] = []
    receiver.create_subscription(Image, "camera", got.append, qos)
    out, message = sender.create_publisher(Image, "camera", qos), image(0)
    for number in range(20):
        message.width = number
        message.data[:] = array("B", [number]) * SIZE
        out.publish(message)
    spin_until(executor, lambda: len(got) == 20)
    assert [each.width for each in got] == list(range(20))
    assert all(is_whole(each) for each in got)


def test_two_subscriptions_get_data_of_their_own(executor: SingleThreadedExecutor) -> None:
    sender, receiver = nodes(executor)
    got: list[Any] = []
    for _ in range(2):
        receiver.create_subscription(Image, "camera", got.append, 10)
    sender.create_publisher(Image, "camera", 10).publish(image(5))
    spin_until(executor, lambda: len(got) == 2)
    got[0].data[0] = 99
    assert got[1].data[0] == 5


def test_a_message_that_is_passed_on_and_changed_leaves_the_one_sent(executor: SingleThreadedExecutor) -> None:
    sender, receiver = nodes(executor)
    got: list[Any] = []
    out = receiver.create_publisher(Image, "changed", 10)

    def on_image(message: Any) -> None:
        out.publish(message)
        message.data[0] = 99
        out.publish(message)

    receiver.create_subscription(Image, "camera", on_image, 10)
    sender.create_subscription(Image, "changed", got.append, 10)
    sender.create_publisher(Image, "camera", 10).publish(image(5))
    spin_until(executor, lambda: len(got) == 2)
    assert [each.data[0] for each in got] == [5, 99]


def test_threads_that_publish_at_once_send_whole_messages(executor: SingleThreadedExecutor) -> None:
    sender, receiver = nodes(executor)
    got: list[Any] = []
    receiver.create_subscription(Image, "camera", got.append, 100)
    outs = [sender.create_publisher(Image, "camera", 100) for _ in range(2)]

    def send(first: int) -> None:
        for number in range(first, first + 10):
            outs[number % 2].publish(image(number))

    threads = [threading.Thread(target=send, args=(10 * each,)) for each in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    spin_until(executor, lambda: len(got) == 40)
    assert sorted(each.width for each in got) == list(range(40))
    assert all(is_whole(each) for each in got)


@given(st.lists(st.tuples(st.integers(0, 255), st.integers(VIEW_FROM - 100, SIZE), st.booleans()), max_size=8))
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_what_a_program_keeps_stays_as_it_was(
    executor: SingleThreadedExecutor, sent: list[tuple[int, int, bool]]
) -> None:
    sender, receiver = nodes(executor)
    kept: list[Any] = []

    def on_image(message: Any) -> None:
        if message.height:
            assert is_whole(message)  # looked at now; the others later
        kept.append(message)

    subscription = receiver.create_subscription(Image, "camera", on_image, 10)
    out = sender.create_publisher(Image, "camera", 10)
    for number, size, looked_at in sent:
        message = image(number, size)
        message.height = int(looked_at)
        out.publish(message)
    spin_until(executor, lambda: len(kept) == len(sent))
    assert [(each.width, len(each.data)) for each in kept] == [(number, size) for number, size, _ in sent]
    assert all(is_whole(each) for each in kept)
    receiver.destroy_subscription(subscription)
    sender.destroy_publisher(out)
