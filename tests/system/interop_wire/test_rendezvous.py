"""Without a router: a rmw_zenoh in client mode joins at the rendezvous port of its domain, and reaches all nodes."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.std_msgs.msg import String
from robolink.networks.request import FIRST_PORT
from robolink.qos import DurabilityPolicy, QoSProfile
from tests.support.interop import Robot, robot, until
from tests.support.ros2_peer import ADD_TWO_INTS, LATCHED, STRING, Peer, free_port, packed_ints, packed_string
from tests.system.interop_wire.calls import add, replies_to, serve_sums, sum_of, until_heard

pytestmark = pytest.mark.processes

KEPT = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@pytest.fixture(params=["holds the port", "came later"])
def node(request: pytest.FixtureRequest, domain: int) -> Iterator[Robot]:
    """A node of the process at the rendezvous port, or of another one; there is no router."""
    nowhere = free_port()
    with robot(nowhere, domain, "first") as first, robot(nowhere, domain, "second") as second:
        yield first if request.param == "holds the port" else second


@pytest.fixture
def peer(node: Robot, domain: int) -> Iterator[Peer]:
    made = Peer(FIRST_PORT + domain, domain, mode="client")
    yield made
    made.close()


def test_topics_both_ways(node: Robot, peer: Peer) -> None:
    stranger, got = peer.node("stranger"), list[str]()
    node.create_subscription(String, "to_robolink", lambda message: got.append(message.data), 10)
    publisher = node.create_publisher(String, "to_ros", KEPT)
    publisher.publish(String(data="kept"))
    mouth = stranger.publisher("/to_robolink", STRING)
    until_heard(node, lambda: mouth.put(packed_string("world")), got)
    assert got[0] == "world"
    ear = stranger.subscription("/to_ros", STRING, LATCHED)
    assert ear.next().payload == packed_string("kept")
    publisher.publish(String(data="hello"))
    assert ear.take_until(packed_string("hello"))[-1].sender[0] == 2


def test_services_both_ways(node: Robot, peer: Peer) -> None:
    serve_sums(node)
    stranger = peer.node("stranger")
    (reply,) = replies_to(stranger.client("/add", ADD_TWO_INTS), node, packed_ints(2, 40))
    assert reply.payload == packed_ints(42)
    stranger.service("/sum", ADD_TWO_INTS, add)
    client = node.create_client(AddTwoInts, "sum")
    assert node.while_spinning(lambda: client.wait_for_service(30.0))
    assert node.while_spinning(lambda: sum_of(client, 1, 2)) == 3


def test_each_sees_all_others(node: Robot, peer: Peer) -> None:
    peer.node("stranger")
    until(lambda: set(node.get_node_names()) == {"first", "second", "stranger"})

    def names() -> set[str]:
        return {token.split("/")[8] for token in peer.tokens() if "/NN/" in token}

    until(lambda: names() == {"first", "second"}, lambda: str(peer.tokens()))
