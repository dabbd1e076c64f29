"""A peer of bare Zenoh calls, made as rmw_zenoh makes them, and robolink's nodes are one system, on bad days too."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.std_msgs.msg import String
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport.zenoh import ZenohTransport
from tests.support.interop import PATIENCE, Robot, robot, robot_on, until
from tests.support.ros2_peer import (
    ADD_TWO_INTS,
    LATCHED,
    SESSION,
    STRING,
    TWIST,
    Peer,
    PeerSubscription,
    Received,
    free_port,
    gid_of,
    packed_ints,
    packed_string,
    packed_twist,
    router,
)
from tests.system.interop_wire.calls import add, announced, replies_to, serve_sums, sum_of, until_heard

pytestmark = pytest.mark.processes

KEPT = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def heard(publisher: Publisher[Any], message: Any, ear: PeerSubscription) -> Received:
    """Publish until the peer hears it; what it heard. Two sessions need an instant to get to know each other."""

    def arrived() -> bool:
        publisher.publish(message)
        return bool(ear.arrived.qsize())

    until(arrived)
    return ear.next()


# ---------------------------------------------------------------- ways to join


@pytest.fixture(params=["this machine's network", "a client of the router", "rmw_zenoh's settings"])
def joined(request: pytest.FixtureRequest, port: int, domain: int, tmp_path: Path) -> Iterator[Robot]:
    if request.param == "this machine's network":
        with robot(port, domain) as made:
            yield made
        return
    path = tmp_path / "session.json5"
    path.write_text(json.dumps(SESSION | {"connect": {"endpoints": [f"tcp/localhost:{port}"]}}))
    variable, value = ("ROBOLINK_NETWORK", f"tcp/127.0.0.1:{port}")
    if request.param == "rmw_zenoh's settings":
        variable, value = ("ZENOH_SESSION_CONFIG_URI", str(path))
    with robot_on(ZenohTransport(domain, environ={variable: value}), domain) as made:
        yield made


def test_each_way_to_join(joined: Robot, peer: Peer) -> None:
    stranger, got = peer.node("stranger"), list[str]()
    joined.create_subscription(String, "to_robolink", lambda message: got.append(message.data), 10)
    publisher = joined.create_publisher(String, "to_ros", 10)
    ear, mouth = stranger.subscription("/to_ros", STRING), stranger.publisher("/to_robolink", STRING)
    assert heard(publisher, String(data="hello"), ear).payload == packed_string("hello")
    until_heard(joined, lambda: mouth.put(packed_string("world")), got)
    assert got[0] == "world"
    until(lambda: "/stranger" in joined.get_fully_qualified_node_names())
    announced(peer, "/NN/%/%/robot")


def test_a_router_elsewhere_is_told_as_to_rmw_zenoh(port: int, domain: int, peer: Peer) -> None:
    """To several processes: none of them holds the rendezvous port then."""
    environ = {"ZENOH_CONFIG_OVERRIDE": f'connect/endpoints=["tcp/localhost:{port}"]'}
    ear, got = peer.node("stranger").subscription("/chatter", STRING), list[str]()
    with robot_on(ZenohTransport(domain, environ=environ), domain) as first:
        first.create_subscription(String, "chatter", lambda message: got.append(message.data), 10)
        with robot_on(ZenohTransport(domain, environ=environ), domain, "second") as second:
            publisher = second.create_publisher(String, "chatter", 10)
            until_heard(first, lambda: publisher.publish(String(data="hello")), got)
            assert heard(publisher, String(data="hello"), ear).payload == packed_string("hello")


def test_the_router_may_come_last_and_go_again(domain: int) -> None:
    port = free_port()
    peer = Peer(port, domain)
    try:
        with robot(port, domain) as node:
            ear = peer.node("stranger").subscription("/chatter", STRING)
            publisher = node.create_publisher(String, "chatter", 10)
            with router(port):
                first = heard(publisher, String(data="at last"), ear)
            for number in range(3):  # the router was killed
                publisher.publish(String(data=str(number)))
            texts = [packed_string(str(number)) for number in range(3)]
            assert [each.payload for each in ear.take_until(texts[-1])][-3:] == texts
            assert first.payload == packed_string("at last")
    finally:
        peer.close()


# ---------------------------------------------------------------- messages


def test_what_robolink_publishes(node: Robot, peer: Peer) -> None:
    began = time.time_ns()
    ear = peer.node("stranger").subscription("/cmd_vel", TWIST)
    publisher = node.create_publisher(Twist, "cmd_vel", 10)
    twist = Twist()
    twist.linear.x, twist.angular.z = 0.3, -1e300
    received = [heard(publisher, twist, ear)]
    for _ in range(3):
        publisher.publish(twist)
    publisher.publish(Twist())
    received += ear.take_until(packed_twist(0, 0, 0, 0, 0, 0))[:-1]
    assert len(received) >= 4
    assert {each.payload for each in received} == {packed_twist(0.3, 0, 0, 0, 0, -1e300)}
    numbers, stamps, gids = zip(*(each.sender for each in received), strict=True)
    assert list(numbers) == list(range(numbers[0], numbers[0] + len(numbers)))
    assert began <= stamps[0] <= sorted(stamps)[-1] <= time.time_ns()
    assert list(stamps) == sorted(stamps)
    assert set(gids) == {gid_of(announced(peer, "/MP/", "/%cmd_vel/"))}


def test_the_first_message_is_number_one(node: Robot, peer: Peer) -> None:
    ear = peer.node("stranger").subscription("/kept", STRING, LATCHED)
    publisher = node.create_publisher(String, "kept", KEPT)
    publisher.publish(String(data="x"))
    assert ear.next().sender[0] == 1


@pytest.mark.parametrize("qos", ["::,10:,:,:,,", "2::,5:,:,:,,", "1:2:1,10:,:,:,,"])
def test_what_robolink_hears(node: Robot, peer: Peer, qos: str) -> None:
    """A best-effort publisher reaches a reliable subscription: on this wire no QoS keeps two ends apart."""
    got: list[tuple[Twist, Any]] = []
    node.create_subscription(Twist, "/cmd_vel", lambda message, info: got.append((message, info)), 10)
    mouth = peer.node("stranger").publisher("/cmd_vel", TWIST, qos)
    until_heard(node, lambda: mouth.put(packed_twist(0.25, 0, 0, 0, 0, -2), timestamp=1234567890123456789), got)
    message, info = got[0]
    assert (message.linear.x, message.angular.z) == (0.25, -2)
    assert info["source_timestamp"] == 1234567890123456789
    assert info["publication_sequence_number"] >= 1
    assert abs(info["received_timestamp"] - time.time_ns()) < 60e9


def test_big_endian(node: Robot, peer: Peer) -> None:
    got: list[str] = []
    node.create_subscription(String, "chatter", lambda message: got.append(message.data), 10)
    mouth = peer.node("stranger").publisher("/chatter", STRING)
    until_heard(node, lambda: mouth.put(b"\0\0\0\0\0\0\0\3hi\0"), got)
    assert got[0] == "hi"


def test_names_in_namespaces(port: int, domain: int, peer: Peer) -> None:
    with robot(port, domain, "driver", "/fleet/r2d2") as node:
        publisher = node.create_publisher(String, "~/status", 10)
        ear = peer.node("watcher", "/fleet").subscription("/fleet/r2d2/driver/status", STRING)
        assert heard(publisher, String(data="ok"), ear).payload == packed_string("ok")
        assert ear.key == f"{domain}/fleet/r2d2/driver/status/std_msgs::msg::dds_::String_/{STRING.hash}"
        until(lambda: ("watcher", "/fleet") in node.get_node_names_and_namespaces())
        until(lambda: node.get_subscriber_names_and_types_by_node("watcher", "/fleet") != [])
        assert node.get_subscriber_names_and_types_by_node("watcher", "/fleet") == [
            ("/fleet/r2d2/driver/status", ["std_msgs/msg/String"])
        ]


# ---------------------------------------------------------------- latched messages


def test_late_joiners_get_what_robolink_keeps(node: Robot, peer: Peer) -> None:
    publisher = node.create_publisher(String, "map", KEPT)
    witness = peer.node("early").subscription("/map", STRING)
    heard(publisher, String(data="first"), witness)
    for number in range(5):
        publisher.publish(String(data=str(number)))
    live = witness.take_until(packed_string("4"))[-3:]
    ear = peer.node("late").subscription("/map", STRING, LATCHED)
    received = [ear.next() for _ in range(3)]
    assert [each.payload for each in received] == [packed_string(str(number)) for number in (2, 3, 4)]
    assert received == live  # attachments, too
    publisher.publish(String(data="and on"))
    assert ear.next().payload == packed_string("and on")


def test_robolink_gets_what_peers_keep(node: Robot, peer: Peer) -> None:
    early, late = list[str](), list[tuple[str, Any]]()
    node.create_subscription(String, "map", lambda message: early.append(message.data), 10)
    mouth = peer.node("stranger").publisher("/map", STRING, LATCHED)
    until_heard(node, lambda: mouth.put(packed_string("first")), early)
    for number in range(5):
        mouth.put(packed_string(str(number)), timestamp=number)
    node.spin_until(lambda: early[-1] == "4")
    node.create_subscription(String, "map", lambda message, info: late.append((message.data, info)), KEPT)
    node.spin_until(lambda: len(late) == 3)
    assert [text for text, _ in late] == ["2", "3", "4"]
    assert [info["source_timestamp"] for _, info in late] == [2, 3, 4]
    mouth.put(packed_string("and on"))
    node.spin_until(lambda: len(late) == 4)
    assert late[-1][0] == "and on"


# ---------------------------------------------------------------- services


def test_robolink_calls(node: Robot, peer: Peer) -> None:
    service = peer.node("adder").service("/add", ADD_TWO_INTS, add)
    client = node.create_client(AddTwoInts, "add")
    assert client.wait_for_service(PATIENCE)
    assert sum_of(client, 40, 2) == 42
    first = service.requests[0].sequence
    futures = [client.call_async(AddTwoInts.Request(a=number, b=-(2**40))) for number in range(3)]
    node.spin_until(lambda: all(each.done() for each in futures))
    answers: list[Any] = [each.result() for each in futures]
    assert [each.sum for each in answers] == [number - 2**40 for number in range(3)]
    assert service.requests[0].payload == packed_ints(40, 2)
    assert sorted(each.sequence for each in service.requests) == [first + number for number in range(4)]
    assert {each.gid for each in service.requests} == {gid_of(announced(peer, "/SC/", "/%add/"))}


def test_robolink_serves(node: Robot, peer: Peer) -> None:
    serve_sums(node)
    client = peer.node("asker").client("/add", ADD_TWO_INTS)
    first = replies_to(client, node, packed_ints(0, 0))[0].sender[0]
    for number in (1, 2):
        began = time.time_ns()
        (reply,) = node.while_spinning(lambda: client.call(packed_ints(40, 2)))
        assert reply.payload == packed_ints(42)
        sequence, stamp, gid = reply.sender
        assert (sequence, gid) == (first + number, client.gid)
        assert began <= stamp <= time.time_ns()
    until(lambda: node.count_clients("/add") == 1)


def hashes(*names: str) -> dict[str, str]:
    table: dict[str, str] = json.loads((Path(__file__).parents[2] / "data" / "type_hashes.json").read_text())
    return {name: table[name] for name in names}


# ---------------------------------------------------------------- Humble


def test_messages_to_and_from_humble(node: Robot, peer: Peer) -> None:
    stranger, got = peer.node("old"), list[str]()
    node.create_subscription(String, "to_robolink", lambda message: got.append(message.data), 10)
    publisher = node.create_publisher(String, "to_ros", 10)
    ear = stranger.subscription("/to_ros", STRING.for_humble)
    mouth = stranger.publisher("/to_robolink", STRING.for_humble)
    assert heard(publisher, String(data="hello"), ear).payload == packed_string("hello")
    until_heard(node, lambda: mouth.put(packed_string("world")), got)
    assert got[0] == "world"
    assert ear.key.endswith("/TypeHashNotSupported")


def test_humble_and_jazzy_at_once(node: Robot, peer: Peer) -> None:
    """Each hears every message once."""
    old, new = peer.node("old"), peer.node("new")
    publisher, got = node.create_publisher(String, "chatter", 10), list[str]()
    node.create_subscription(String, "chatter", lambda message: got.append(message.data), 10)
    ears = [old.subscription("/chatter", STRING.for_humble), new.subscription("/chatter", STRING)]
    for ear in ears:
        heard(publisher, String(data="first"), ear)
    for number in range(3):
        publisher.publish(String(data=str(number)))
    texts = [packed_string(str(number)) for number in range(3)]
    for ear in ears:
        payloads = [each.payload for each in ear.take_until(texts[-1])]
        assert [each for each in payloads if each in texts] == texts
    node.spin_until(lambda: got[-1:] == ["2"])
    assert got[-3:] == ["0", "1", "2"]


def test_latched_messages_of_humble(node: Robot, peer: Peer) -> None:
    mouth = peer.node("old").publisher("/map", STRING.for_humble, LATCHED)
    mouth.put(packed_string("theirs"))
    got: list[str] = []
    node.create_subscription(String, "map", lambda message: got.append(message.data), KEPT)
    publisher = node.create_publisher(String, "ours", KEPT)
    publisher.publish(String(data="ours"))
    node.spin_until(lambda: got == ["theirs"])
    ear = peer.node("late").subscription("/ours", STRING.for_humble, LATCHED)
    until(lambda: publisher.get_subscription_count() == 1)
    publisher.publish(String(data="more"))
    ear.take_until(packed_string("more"))


def test_robolink_calls_humble(node: Robot, peer: Peer) -> None:
    peer.node("adder").service("/add", ADD_TWO_INTS.for_humble, add)
    client = node.create_client(AddTwoInts, "add")
    assert client.wait_for_service(PATIENCE)
    assert sum_of(client, 40, 2) == 42


def test_humble_calls_robolink(node: Robot, peer: Peer) -> None:
    _, asked = serve_sums(node)
    client = peer.node("asker").client("/add", ADD_TWO_INTS.for_humble)
    replies = replies_to(client, node, packed_ints(40, 2))
    assert [each.payload for each in replies] == [packed_ints(42)]
    assert replies[0].sender[2] == client.gid
    assert asked == [40]
