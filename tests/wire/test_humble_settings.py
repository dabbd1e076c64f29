"""Two who speak Humble's dialect: each message once, on nodes that move or go; and ROBOLINK_ROS_DISTRO."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from robolink import Context, Node
from robolink.executors import SingleThreadedExecutor
from robolink.graph.graph import Graph
from robolink.graph.humble import MOST_REMEMBERED, Copies, CopyError, DistroError, is_requested
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    format_token,
    pack_attachment,
)
from tests.support.humble_peer import DATA, LATCHED, Peer, spinning
from tests.support.spins import spin_for, spin_until
from tests.support.transports import PATIENCE

pytestmark = pytest.mark.unlike_dds("Humble's keys are of rmw_zenoh: DDS has one topic for all")


@pytest.mark.parametrize("order", ["publisher", "subscription"])
def test_between_two_who_speak_both_each_message_comes_once(
    peer: Peer, make_context: Callable[..., Context], order: str, log_lines: list[Record]
) -> None:
    got: list[int] = []
    sender, receiver = spinning(make_context(), "sender"), spinning(make_context(), "receiver")

    def subscribe() -> None:
        receiver[0].create_subscription(Int32, "topic", lambda message: got.append(message.data), LATCHED)

    if order == "subscription":
        subscribe()
    publisher = sender[0].create_publisher(Int32, "topic", LATCHED)
    publisher.publish(Int32(data=1))
    if order == "publisher":
        subscribe()
    spin_until(receiver[1], lambda: got == [1])
    peer.subscribe(LATCHED)
    assert peer.received(1) == [1]
    peer.announce(EndpointKind.PUBLISHER, LATCHED)  # now the subscription receives from both keys
    spin_until(receiver[1], lambda: next(iter(receiver[0].subscriptions)).get_publisher_count() == 2)
    for number in range(2, 5):  # as many as the subscription keeps
        publisher.publish(Int32(data=number))
    spin_until(receiver[1], lambda: got[-1] == 4)
    spin_for(receiver[1], 0.1)
    assert got == [1, 2, 3, 4]
    assert peer.received(3) == [2, 3, 4]
    assert log_lines == []


def test_a_copy_whose_sender_is_not_known_yet_is_recognized() -> None:
    copies = Copies(lambda gid: None)
    sent = pack_attachment(1, 2, b"*" * 16)
    assert not copies.comes_twice(sent)
    copies.check(sent)
    with pytest.raises(CopyError):
        copies.check(sent)
    for number in range(MOST_REMEMBERED):
        copies.check(pack_attachment(number, 3, b"+" * 16))
    copies.check(sent)  # it remembers so many and no more


def test_a_node_that_moves_to_another_executor_still_hears(bus: Bus, context: Context) -> None:
    peer, got = Peer(MemoryTransport(bus=bus)), list[int]()
    node = Node("node", context=context)
    node.create_subscription(Int32, "topic", lambda message: got.append(message.data), 10)
    peer.advertise()
    peer.put(1)
    for number in (2, 3):
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        peer.put(number)
        spin_until(executor, lambda last=number: got[-1:] == [last])  # type: ignore[misc]
        executor.shutdown()
    assert got == [1, 2, 3]


def test_a_destroyed_subscription_and_publisher_leave_humbles_key(bus: Bus, context: Context) -> None:
    node, peer = Node("node", context=context), Peer(MemoryTransport(bus=bus))
    publisher = node.create_publisher(Int32, "topic", 10)
    subscription = node.create_subscription(Int32, "topic", lambda _: None, 10)
    peer.subscribe().advertise()
    key = peer.key(EndpointKind.SUBSCRIPTION)
    assert (len(bus.subscriptions[key]), len(bus.outlets[key])) == (2, 2)
    node.destroy_publisher(publisher)
    node.destroy_subscription(subscription)
    assert (len(bus.subscriptions[key]), len(bus.outlets[key])) == (1, 1)


def test_another_type_is_left_alone(bus: Bus, context: Context) -> None:
    node, peer = Node("node", context=context), Peer(MemoryTransport(bus=bus))
    node.create_publisher(String, "topic", 10)
    peer.announce(EndpointKind.SUBSCRIPTION)
    assert [key for key in bus.outlets if key.endswith(NO_HASH)] == []


def test_everything_is_as_humble_says_it_when_asked_for(bus: Bus, make_context: Callable[..., Context]) -> None:
    context = make_context("humble")
    node = Node("talker", context=context)
    node.create_publisher(String, "chatter", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    assert {each.type_hash for each in context.graph.endpoints(*EndpointKind)} == {NO_HASH}
    assert not [name for name, _ in node.get_service_names_and_types() if "type_description" in name]
    (golden,) = (DATA / "liveliness-token-real-humble.txt").read_text().split()
    (own,) = context.graph.endpoints(EndpointKind.PUBLISHER, name="/chatter")
    text = format_token(own).split("/")
    assert [*text[:2], *text[5:8], *text[9:]] == [
        *golden.split("/")[:2],
        *golden.split("/")[5:8],
        *golden.split("/")[9:],
    ]


def test_one_that_speaks_humble_and_one_that_does_not_understand_each_other(
    make_context: Callable[..., Context], log_lines: list[Record]
) -> None:
    old, new = spinning(make_context("humble"), "old"), spinning(make_context(), "new")
    got: list[int] = []
    old[0].create_service(SetBool, "switch", lambda request, response: SetBool.Response(message="old"))
    old[0].create_subscription(Int32, "topic", lambda message: got.append(message.data), LATCHED)
    new[0].create_publisher(Int32, "topic", LATCHED).publish(Int32(data=1))
    spin_until(old[1], lambda: got == [1])
    client = new[0].create_client(SetBool, "switch")
    assert client.wait_for_service(PATIENCE)
    future = client.call_async(SetBool.Request())
    thread = threading.Thread(target=new[1].spin_until_future_complete, args=(future, PATIENCE))
    thread.start()
    spin_until(old[1], future.done)
    thread.join(PATIENCE)
    assert future.result().message == "old"  # type: ignore[union-attr]
    assert log_lines == []


@pytest.mark.parametrize(
    ("value", "humble"), [("", False), ("humble", True), (" Humble ", True), ("jazzy", False), ("rolling", False)]
)
def test_the_variable(value: str, humble: bool) -> None:
    assert is_requested({"ROBOLINK_ROS_DISTRO": value}) is humble
    assert is_requested({}) is False


def test_an_unknown_distribution_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOLINK_ROS_DISTRO", "humbel")
    with pytest.raises(DistroError, match=r"no distribution 'humbel' \(did you mean 'humble'\?\): humble, iron"):
        Context().init([])


def test_the_graph_finds_an_endpoint_by_its_gid(bus: Bus, context: Context) -> None:
    graph = Graph(MemoryTransport(bus=bus), 0)
    node = Node("node", context=context)
    publisher = node.create_publisher(Int32, "topic", 10)
    found = graph.endpoint_of(publisher._endpoint.gid)
    assert found is not None
    assert (found.full_node_name, found.name) == ("/node", "/topic")
