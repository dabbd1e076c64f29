"""A mirror between memory and DDS on a network that is faked: what each side gets, and what DDS is shown."""

from __future__ import annotations

import functools
from collections.abc import Iterator
from typing import Any, NamedTuple

import pytest

from robolink.dds import transport as dds_transport
from robolink.dds.mirror import Mirror
from robolink.dds.transport import DdsTransport
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import type_hash
from robolink.qos import QoSProfile
from robolink.transport.base import Transport
from robolink.transport.memory import Bus, MemoryTransport
from robolink.wire import (
    RUNNING,
    BridgeToken,
    DataKey,
    EndpointKind,
    EndpointToken,
    Mark,
    NodeToken,
    bridge_pattern,
    format_bridge,
    format_key,
    format_token,
    gid_of,
    graph_pattern,
    mark_data,
    pack_attachment,
    parse_token,
)
from tests.support.fake_rtps import FakeNetwork
from tests.support.transports import Caller, Desk, Ear, latched, until

PUBLISHER, SUBSCRIPTION = EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION
TYPES = {
    PUBLISHER: ("std_msgs/msg/String", type_hash(String)),
    SUBSCRIPTION: ("std_msgs/msg/String", type_hash(String)),
    EndpointKind.SERVICE: ("std_srvs/srv/SetBool", type_hash(SetBool)),
    EndpointKind.CLIENT: ("std_srvs/srv/SetBool", type_hash(SetBool)),
}
PLAIN = QoSProfile(depth=10)


class Scene(NamedTuple):
    """A session on each side, and the mirror's own on DDS."""

    here: Transport
    there: DdsTransport
    own: DdsTransport
    fake: FakeNetwork


@pytest.fixture
def scene(monkeypatch: pytest.MonkeyPatch) -> Iterator[Scene]:
    monkeypatch.setattr(dds_transport, "FIRST", 0.02)
    monkeypatch.setattr(dds_transport, "PATIENCE", 0.1)
    fake, bus = FakeNetwork(), Bus()
    opens: Any = fake.open
    sessions = [MemoryTransport(bus=bus), MemoryTransport(bus=bus), DdsTransport(opens), DdsTransport(opens)]
    a, here, b, there = sessions
    assert isinstance(b, DdsTransport)
    assert isinstance(there, DdsTransport)
    mirror = Mirror(a, b)
    mirror.start()
    yield Scene(here, there, b, fake)
    mirror.close()
    for each in sessions:
        each.close()
    fake.close()


class Node:
    """A node of a session, with what it has."""

    def __init__(self, session: Transport, name: str) -> None:
        self.session, self.name = session, name
        self._handles = [session.announce(format_token(NodeToken(0, session.session_id, name, "/", "/", name)))]

    def _token(self, kind: EndpointKind, topic: str, qos: QoSProfile) -> tuple[str, str]:
        type_name, text = TYPES[kind]
        number = f"{self.name}.{len(self._handles)}"
        session = self.session.session_id
        token = EndpointToken(0, session, self.name, number, kind, "/", "/", self.name, topic, type_name, text, qos)
        return format_token(token), format_key(DataKey(0, topic, type_name, text))

    def publishes(self, qos: QoSProfile = PLAIN) -> Any:
        """Return a function that publishes, as who came last: declared first, then announced."""
        token, key = self._token(PUBLISHER, "/talk", qos)
        outlet = self.session.advertise(key, qos)
        self._handles += [outlet, self.session.announce(token)]
        numbers = iter(range(1, 1000))
        return lambda payload: outlet.put(payload, pack_attachment(next(numbers), 5, gid_of(token)))

    def hears(self, qos: QoSProfile = PLAIN) -> Ear:
        token, key = self._token(SUBSCRIPTION, "/talk", qos)
        ear = Ear(self.session, key, qos)
        self._handles += [ear.handle, self.session.announce(token)]
        return ear

    def serves(self) -> Desk:
        token, key = self._token(EndpointKind.SERVICE, "/set", PLAIN)
        desk = Desk(self.session, key)
        self._handles += [desk.handle, self.session.announce(token)]
        return desk

    def calls(self) -> Any:
        """Return a function that calls."""
        token, key = self._token(EndpointKind.CLIENT, "/set", PLAIN)
        self._handles.append(self.session.announce(token))
        return lambda payload: Caller(self.session, payload, key, pack_attachment(3, 5, gid_of(token)))

    def ends(self) -> None:
        for each in reversed(self._handles):
            each.close()


@pytest.fixture(params=["to DDS", "from DDS"])
def ends(scene: Scene, request: pytest.FixtureRequest) -> tuple[Transport, Transport]:
    """The side that gives, and the one that takes."""
    return (scene.here, scene.there) if request.param == "to DDS" else (scene.there, scene.here)


def sees(session: Transport, name: str, count: int) -> bool:
    """Whether a session sees so many ends of a node of the other side."""
    found = [parse_token(each) for each in session.tokens(graph_pattern(0))]
    return sum(isinstance(each, EndpointToken) and each.node_name == name for each in found) == count


def test_messages_arrive_once_from_whoever_publishes(ends: tuple[Transport, Transport]) -> None:
    giving, taking = ends
    ear = Node(taking, "listener").hears()
    until(lambda: sees(giving, "listener", 1))
    for number in range(3):  # each publishes at once when it has come
        Node(giving, f"talker{number}").publishes()(b"text%d" % number)
    assert sorted(ear.take(3)) == [b"text0", b"text1", b"text2"]
    assert ear.arrived.empty()


def test_latched_messages_reach_who_comes_late_once(ends: tuple[Transport, Transport]) -> None:
    giving, taking = ends
    say = Node(giving, "map").publishes(latched(1))
    say(b"old")
    say(b"map1")
    first = Node(taking, "first")
    assert first.hears(latched(1)).next() == b"map1"
    second = Node(taking, "second")
    assert second.hears(latched(1)).next() == b"map1"
    until(lambda: sees(giving, "first", 1) and sees(giving, "second", 1))  # else they are not seen to go
    for each in (first, second):
        each.ends()
    until(lambda: sees(giving, "first", 0) and sees(giving, "second", 0))
    say(b"map2")
    late = Node(taking, "late").hears(latched(1))
    assert late.next() == b"map2"
    say(b"map3")
    assert late.next() == b"map3"


def test_calls_are_answered(ends: tuple[Transport, Transport]) -> None:
    serving, calling = ends
    desk = Node(serving, "server").serves()
    call = Node(calling, "client").calls()
    until(lambda: sees(calling, "server", 1) and sees(serving, "client", 1))
    asked = call(b"request")
    query = desk.next()
    assert query.payload == b"request"
    query.reply(b"answer", query.attachment)
    query.close()
    (reply,) = asked.replies()
    assert reply.payload == b"answer"


def test_dds_is_shown_each_end_once_and_under_its_node(scene: Scene) -> None:
    nodes = [Node(scene.here, f"node{number}") for number in range(3)]
    for each in nodes:
        each.hears()
        each.hears(QoSProfile(depth=2))
        each.publishes()
        each.serves()
        each.calls()
    Node(scene.there, "other").publishes()
    for each in nodes:
        until(functools.partial(sees, scene.there, each.name, 5))
    endpoints = [each for each in scene.there._participant.endpoints() if each.topic == "rt/talk"]
    assert sum(each.is_writer for each in endpoints) == 3
    assert sum(not each.is_writer for each in endpoints) == 6
    nodes[0].ends()  # whichever of them feeds the mirror
    until(lambda: sees(scene.there, "node0", 0))
    until(lambda: sum(not each.is_writer for each in _of_talk(scene)) == 4)
    for each in nodes[1:]:
        each.ends()
    until(lambda: not _of_talk(scene))


def _of_talk(scene: Scene) -> list[Any]:
    own = scene.own._participant.guid[:12]
    return [e for e in scene.there._participant.endpoints() if e.topic == "rt/talk" and e.guid[:12] == own]


def test_nothing_is_left_of_what_has_gone(scene: Scene) -> None:
    for number in range(3):
        here, there = Node(scene.here, f"here{number}"), Node(scene.there, f"there{number}")
        for each in (here, there):
            each.hears(), each.publishes(), each.serves(), each.calls()
        until(functools.partial(sees, scene.there, here.name, 4))
        until(functools.partial(sees, scene.here, there.name, 4))
        here.ends()
        there.ends()
        until(functools.partial(sees, scene.there, here.name, 0))
        until(functools.partial(sees, scene.here, there.name, 0))
    services, topics = scene.own._services, scene.own._topics
    until(lambda: not any((services._servers, services._handles, services._clients, services._others)))
    until(lambda: not any((topics.publications, topics.readings, _of_talk(scene))))


def test_a_bridge_among_the_participants_has_a_token_as_on_zenoh(scene: Scene) -> None:
    bridge = scene.fake.open(user_data=b"enclave=/;" + mark_data(Mark("12ab", "robot")))
    token = format_bridge(BridgeToken(0, bridge.guid[:12].hex(), "zenoh", "robot", RUNNING, "12ab"))
    until(lambda: scene.there.tokens(bridge_pattern(0)) == [token])
    bridge.close()
    until(lambda: not scene.there.tokens(bridge_pattern(0)))


def test_a_caller_without_a_token_is_answered(ends: tuple[Transport, Transport]) -> None:
    serving, calling = ends
    desk = Node(serving, "server").serves()
    until(lambda: sees(calling, "server", 1))
    key = format_key(DataKey(0, "/set", *TYPES[EndpointKind.SERVICE]))
    for number in range(2):
        asked = Caller(calling, b"request", key, pack_attachment(number, 5, b"chosen at random"))
        query = desk.next()
        query.reply(b"answer", query.attachment)
        query.close()
        (reply,) = asked.replies()
        assert reply.payload == b"answer"
