"""Peers of Humble, whose keys and tokens have no type hash: they are met on their own key, each message once."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink import Context, Node
from robolink.exceptions import TransportError
from robolink.executors import SingleThreadedExecutor
from robolink.graph import Graph
from robolink.humble import MOST_REMEMBERED, Copies, CopyError, DistroError, is_asked_for
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import Int32, String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import decode, encode
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport import Sample, Transport, base
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import (
    NO_HASH,
    EndpointKind,
    EndpointToken,
    format_token,
    gid_of,
    pack_attachment,
    parse_token,
    unpack_attachment,
)
from tests.spins import done, spin_for, spin_until
from tests.transports import PATIENCE, Network

DATA = Path(__file__).parent / "data" / "wire"
PLAIN = QoSProfile(depth=10)
LATCHED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TYPES = {
    EndpointKind.PUBLISHER: "std_msgs/msg/Int32",
    EndpointKind.SUBSCRIPTION: "std_msgs/msg/Int32",
    EndpointKind.SERVICE: "std_srvs/srv/SetBool",
    EndpointKind.CLIENT: "std_srvs/srv/SetBool",
}


class Peer:
    """A node of Humble, made of bare calls of a transport."""

    def __init__(self, session: Transport, name: str = "/topic") -> None:
        self.session, self.name = session, name
        self.arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.sequence = 0

    def announce(self, kind: EndpointKind, qos: QoSProfile = PLAIN) -> EndpointToken:
        number = str(list(EndpointKind).index(kind) + 1)
        token = EndpointToken(
            0, self.session.session_id, "0", number, kind, "/", "/", "old", self.name, TYPES[kind], NO_HASH, qos
        )
        self.handle = self.session.announce(format_token(token))
        self.gid = gid_of(format_token(token))
        return token

    def key(self, kind: EndpointKind) -> str:
        package, part, name = TYPES[kind].split("/")
        return f"0{self.name}/{package}::{part}::dds_::{name}_/{NO_HASH}"

    def advertise(self, qos: QoSProfile = PLAIN) -> Peer:
        self.outlet = self.session.advertise(self.key(EndpointKind.PUBLISHER), qos)
        self.announce(EndpointKind.PUBLISHER, qos)
        return self

    def put(self, *numbers: int) -> None:
        for number in numbers:
            self.sequence += 1
            self.outlet.put(encode(Int32(data=number)), pack_attachment(self.sequence, 5, self.gid))

    def subscribe(self, qos: QoSProfile = PLAIN) -> Peer:
        self.session.subscribe(self.key(EndpointKind.SUBSCRIPTION), qos, self.arrived.put)
        self.announce(EndpointKind.SUBSCRIPTION, qos)
        return self

    def received(self, count: int) -> list[int]:
        """The next numbers, each from a sender that the attachment names."""
        samples = [self.session.read(self.arrived.get(timeout=PATIENCE)) for _ in range(count)]
        assert len({unpack_attachment(each.attachment).gid for each in samples}) == 1
        return [decode(Int32, each.payload).data for each in samples]


@pytest.fixture
def peer(net: Network) -> Peer:
    return Peer(net.session())


@pytest.fixture
def make_context(net: Network, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., Context]]:
    """Make contexts of one network, which talk as Humble does where that is asked for."""
    made: list[Context] = []

    def make(distro: str = "") -> Context:
        monkeypatch.setenv("ROBOLINK_ROS_DISTRO", distro)
        context = Context(transport=net.session())
        context.init([], domain_id=0)
        made.append(context)
        return context

    yield make
    for context in made:
        context.try_shutdown()


def spinning(context: Context, name: str = "node") -> tuple[Node, SingleThreadedExecutor]:
    node, executor = Node(name, context=context), SingleThreadedExecutor(context=context)
    executor.add_node(node)
    return node, executor


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


# ROBOLINK_ROS_DISTRO=humble


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
    assert is_asked_for({"ROBOLINK_ROS_DISTRO": value}) is humble
    assert is_asked_for({}) is False


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
