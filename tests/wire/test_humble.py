"""Peers of Humble, whose keys and tokens have no type hash: they are met on their own key, each message once."""

from __future__ import annotations

import queue
from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context, Node
from robolink.exceptions import TransportError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import decode, encode
from robolink.qos import DurabilityPolicy
from robolink.transport import Sample, base
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    pack_attachment,
    parse_token,
    unpack_attachment,
)
from tests.support.humble_peer import DATA, LATCHED, Peer, spinning
from tests.support.spins import done, spin_until
from tests.support.transports import PATIENCE

pytestmark = pytest.mark.unlike_dds("Humble's keys are of rmw_zenoh: DDS has one topic for all")


def test_the_real_token_and_attachment_name_the_same_publisher(bus: Bus, context: Context) -> None:
    token = (DATA / "liveliness-token-real-humble.txt").read_text().strip()
    attachment = unpack_attachment(bytes.fromhex((DATA / "attachment-real-humble.hex").read_text()))
    node = Node("node", context=context)
    handle = MemoryTransport(bus=bus).announce(token)
    (info,) = node.get_publishers_info_by_topic("/chatter")
    assert (info.node_name, info.node_namespace, info.topic_type) == ("_ros2cli_712", "/", "std_msgs/msg/String")
    assert (info.qos_profile.durability, info.qos_profile.depth) == (DurabilityPolicy.TRANSIENT_LOCAL, 1)
    assert bytes(info.endpoint_gid) == attachment.gid
    assert str(info.topic_type_hash) == "INVALID"
    assert context.graph.endpoint_of(attachment.gid) == parse_token(token)
    handle.close()
    assert context.graph.endpoint_of(attachment.gid) is None
    assert node.get_publishers_info_by_topic("/chatter") == []


@pytest.mark.parametrize("first", ["peer", "node"])
def test_it_is_heard(peer: Peer, make_context: Callable[..., Context], first: str) -> None:
    got: list[int] = []
    if first == "peer":
        peer.advertise(LATCHED)
        peer.put(1, 2)
    node, executor = spinning(make_context())
    subscription = node.create_subscription(Int32, "topic", lambda message: got.append(message.data), LATCHED)
    if first == "node":
        peer.advertise(LATCHED)
        peer.put(1, 2)
    spin_until(executor, lambda: got[-1:] == [2])
    assert got == [1, 2]
    assert subscription.get_publisher_count() == 1
    peer.put(3)
    spin_until(executor, lambda: got == [1, 2, 3])
    assert subscription.malformed == 0


@pytest.mark.parametrize("first", ["peer", "node"])
def test_it_hears(peer: Peer, make_context: Callable[..., Context], first: str) -> None:
    """Also what was published before it came, where that is kept."""
    if first == "peer":
        peer.subscribe(LATCHED)
    node, executor = spinning(make_context())
    publisher = node.create_publisher(Int32, "topic", LATCHED)
    for number in range(5):
        publisher.publish(Int32(data=number))
    if first == "node":
        peer.subscribe(LATCHED)
    spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    publisher.publish(Int32(data=5))
    got = peer.received(1)
    while got[-1] != 5:
        got += peer.received(1)
    assert got[-4:] == [2, 3, 4, 5]
    assert got == sorted(set(got))


def test_a_message_that_was_refused_for_its_size_is_not_kept_for_one_that_comes_late(
    bus: Bus, virtual: Context, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(base, "LARGEST_PAYLOAD", 100_000)
    node, peer = Node("node", context=virtual), Peer(MemoryTransport(bus=bus))
    publisher = node.create_publisher(Int32, "topic", LATCHED)
    publisher.publish(Int32(data=1))
    with pytest.raises(TransportError, match="100,001 bytes"):
        publisher.publish(bytes(100_001))
    peer.subscribe(LATCHED)
    publisher.publish(Int32(data=2))
    assert peer.received(2) == [1, 2]


def test_one_that_only_listens_from_now_on_hears_too(peer: Peer, make_context: Callable[..., Context]) -> None:
    node, executor = spinning(make_context())
    publisher = node.create_publisher(Int32, "topic", 10)
    publisher.publish(Int32(data=1))
    peer.subscribe()
    spin_until(executor, lambda: publisher.get_subscription_count() == 1)

    def heard() -> bool:
        publisher.publish(Int32(data=2))
        return not peer.arrived.empty()

    spin_until(executor, heard)
    assert peer.received(1) == [2]


def answer_to(peer: Peer, executor: SingleThreadedExecutor, attachment: bytes) -> Sample:
    """Call the peer's service with `true` until it is answered: Zenoh needs an instant to know who serves."""
    answers: queue.SimpleQueue[Any] = queue.SimpleQueue()
    found: list[Sample] = []

    def answered() -> bool:
        peer.session.call(peer.key(EndpointKind.CLIENT), encode(SetBool.Request(data=True)), attachment, answers.put)
        spin_until(executor, lambda: not answers.empty())
        arrived = answers.get()
        found.extend([] if arrived is None else [peer.session.read(arrived)])
        return bool(found)

    spin_until(executor, answered)
    return found[0]


def test_a_service_answers_it(peer: Peer, make_context: Callable[..., Context]) -> None:
    node, executor = spinning(make_context())
    node.create_service(SetBool, "topic", lambda request, _: SetBool.Response(success=request.data))
    peer.announce(EndpointKind.CLIENT)
    payload, attachment = answer_to(peer, executor, pack_attachment(7, 5, peer.gid))
    assert decode(SetBool.Response, payload).success
    answer = unpack_attachment(attachment)
    assert (answer.sequence, answer.gid) == (7, peer.gid)


@pytest.mark.parametrize("first", ["peer", "node"])
def test_a_client_that_calls_at_once_is_answered(peer: Peer, make_context: Callable[..., Context], first: str) -> None:
    """Whatever of Humble is seen before, such as the /rosout of the client's node, makes all services ready for it."""
    rosout = Peer(peer.session, "/rosout")
    if first == "peer":
        rosout.announce(EndpointKind.PUBLISHER)
    node, executor = spinning(make_context())
    if first == "peer":
        spin_until(executor, lambda: node.count_publishers("/rosout") == 2)
    service = node.create_service(SetBool, "topic", lambda request, _: SetBool.Response(success=request.data))
    if first == "node":
        rosout.announce(EndpointKind.PUBLISHER)
    spin_until(executor, lambda: bool(service._endpoint.humble_key))
    payload, _ = answer_to(peer, executor, pack_attachment(7, 5, b"c" * 16))
    assert decode(SetBool.Response, payload).success


def test_without_humble_nothing_is_served_twice(bus: Bus, context: Context) -> None:
    Node("node", context=context).create_service(SetBool, "topic", lambda request, response: response)
    assert not [key for key in bus.servers if key.endswith(NO_HASH)]


def test_a_destroyed_service_leaves_humbles_key(bus: Bus, context: Context) -> None:
    node = Node("node", context=context)
    kept = [node.create_service(SetBool, name, lambda request, response: response) for name in ("topic", "other")]
    node.destroy_service(kept.pop(0))
    Peer(MemoryTransport(bus=bus), "/elsewhere").announce(EndpointKind.PUBLISHER)
    served = [key for key, servers in bus.servers.items() if servers and key.endswith(NO_HASH)]
    assert [key for key in served if "SetBool" in key] == [f"0/other/std_srvs::srv::dds_::SetBool_/{NO_HASH}"]
    node.destroy_service(kept.pop())
    assert not [key for key, servers in bus.servers.items() if servers and "SetBool" in key]


def test_its_service_is_called(peer: Peer, make_context: Callable[..., Context]) -> None:
    node, executor = spinning(make_context())
    client = node.create_client(SetBool, "topic")
    asked: queue.SimpleQueue[Any] = queue.SimpleQueue()
    peer.session.serve(peer.key(EndpointKind.SERVICE), asked.put)
    peer.announce(EndpointKind.SERVICE)
    assert client.wait_for_service(PATIENCE)
    future = client.call_async(SetBool.Request(data=True))
    query = peer.session.accept(asked.get(timeout=PATIENCE))
    assert decode(SetBool.Request, query.payload).data
    sender = unpack_attachment(query.attachment)
    query.reply(encode(SetBool.Response(message="from humble")), pack_attachment(sender.sequence, 9, sender.gid))
    query.close()
    assert done(executor, future).message == "from humble"
    peer.handle.close()
    spin_until(executor, lambda: not client.service_is_ready())


def test_of_two_servers_the_one_with_a_hash_is_asked(bus: Bus, context: Context) -> None:
    node, executor = spinning(context)
    Peer(MemoryTransport(bus=bus)).announce(EndpointKind.SERVICE)
    node.create_service(SetBool, "topic", lambda request, _: SetBool.Response(message="ours"))
    client = node.create_client(SetBool, "topic")
    assert done(executor, client.call_async(SetBool.Request())).message == "ours"
