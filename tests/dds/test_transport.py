"""DdsTransport over a network in memory: what others see of it on DDS, and what it makes of what they have."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import Any

import pytest

from robolink.dds import entities, names
from robolink.dds import transport as dds_transport
from robolink.dds.entities import NodeEntities, ParticipantEntities
from robolink.dds.names import enclave_data
from robolink.dds.transport import DdsTransport
from robolink.duration import Duration
from robolink.interfaces.std_srvs.srv import SetBool
from robolink.message import type_hash
from robolink.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from robolink.rtps import Qos
from robolink.wire import (
    NO_HASH,
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    format_key,
    gid_of,
    pack_attachment,
    unpack_attachment,
)
from tests.support.dds_others import (
    DEPTH_3,
    HASH,
    PLACE,
    SERVICE_HASH,
    SET_BOOL,
    STRING,
    TALK,
    Other,
    kinds,
    node_token,
    open_session,
    seen_tokens,
    token,
)
from tests.support.fake_rtps import FakeNetwork, FakeWriter
from tests.support.transports import GRAPH, Ear, latched, until

# ---------------------------------------------------------------- what others see


def test_a_publisher_is_announced_as_it_is(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    qos = QoSProfile(
        depth=5,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        deadline=Duration(seconds=2.5),
        lifespan=Duration(seconds=10),
        liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
        liveliness_lease_duration=Duration(seconds=1),
    )
    ours.announce(token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH, qos))
    until(lambda: "rt/talk" in other.seen)
    endpoint = other.seen["rt/talk"]
    assert (endpoint.is_writer, endpoint.type_name) == (True, "std_msgs::msg::dds_::String_")
    assert endpoint.qos == Qos(False, True, 5, 2.5, 10.0, 2, 1.0)
    assert endpoint.user_data == f"typehash={HASH};".encode()


def test_a_node_is_listed_with_all_that_it_has_in_few_messages(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    until(lambda: bool(other.listed))
    before = len(other.listed)
    ours.announce(node_token(ours))
    handles = [
        ours.announce(token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH)),
        ours.announce(token(ours, EndpointKind.SUBSCRIPTION, "/hear", STRING, HASH)),
        ours.announce(token(ours, EndpointKind.SERVICE, "/set", SET_BOOL, SERVICE_HASH)),
        ours.announce(token(ours, EndpointKind.CLIENT, "/get", SET_BOOL, SERVICE_HASH)),
    ]

    def listed() -> list[tuple[int, int]]:
        return [(len(each.readers), len(each.writers)) for each in other.listed[-1].nodes]

    until(lambda: listed() == [(3, 3)])
    (node,) = other.listed[-1].nodes
    assert (node.namespace, node.name) == ("/here", "talker")
    assert {*node.readers, *node.writers} == {
        other.seen[topic].guid
        for topic in ("rt/talk", "rt/hear", "rq/setRequest", "rr/setReply", "rq/getRequest", "rr/getReply")
    }
    assert len(other.listed) - before <= 3  # one for each bundle of changes, and not one for each endpoint
    for handle in handles:
        handle.close()
    until(lambda: listed() == [(0, 0)])
    until(lambda: {*other.seen} == {entities.TOPIC})


def test_a_service_tells_the_hashes_of_its_request_and_response(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    ours.announce(token(ours, EndpointKind.SERVICE, "/set", SET_BOOL, SERVICE_HASH))
    until(lambda: "rq/setRequest" in other.seen and "rr/setReply" in other.seen)
    assert names.hash_in(other.seen["rq/setRequest"].user_data) == type_hash(SetBool.Request)
    assert names.hash_in(other.seen["rr/setReply"].user_data) == type_hash(SetBool.Response)


def test_tokens_that_are_not_of_ros_stay_here(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    ours.announce("robolink_bridge/0/ab")
    ours.announce(token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH).replace("@ros2_lv/0/", "@ros2_lv/9/"))
    last = token(ours, EndpointKind.PUBLISHER, "/last", STRING, HASH)
    ours.announce(last)
    until(lambda: "rt/last" in other.seen)
    assert {*other.seen} == {entities.TOPIC, "rt/last"}
    assert ours.tokens("robolink_bridge/**") == ["robolink_bridge/0/ab"]


# ---------------------------------------------------------------- the graph of others


@pytest.mark.parametrize("nodes_first", [True, False], ids=["nodes first", "endpoints first"])
def test_an_endpoint_has_a_token_once_its_node_is_known(
    fake: FakeNetwork, ours: DdsTransport, nodes_first: bool
) -> None:
    other = Other(fake, enclave_data("/robot"))
    if nodes_first:
        node = FakeWriter(other.participant, other.participant._endpoint(True, "x", "y", Qos(), b""), print, bool)
        ahead = other.participant.prefix + (int.from_bytes(node.guid[12:15], "big") + 1).to_bytes(3, "big") + b"\3"
        node.guid = ahead
        other.tell("real", node)
        until(lambda: len(seen_tokens(ours)) == 1)
        assert other.publisher().guid == ahead
    else:
        publisher = other.publisher()
        until(lambda: publisher.guid in ours._others.endpoints)
        assert kinds(ours) == []
        other.tell("real", publisher)
    until(lambda: kinds(ours) == ["MP real"])
    first, endpoint = sorted(seen_tokens(ours), key=lambda each: isinstance(each, EndpointToken))
    assert isinstance(first, NodeToken)
    assert isinstance(endpoint, EndpointToken)
    assert (first.namespace, first.node_name, first.enclave) == ("/there", "real", "/robot")
    assert endpoint.session == first.session == other.participant.prefix.hex()
    assert endpoint.node_id == first.node_id
    assert (endpoint.name, endpoint.type_name, endpoint.type_hash, endpoint.qos.depth) == ("/talk", STRING, HASH, 7)


def test_what_goes_takes_its_tokens_along(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    publisher, subscription = other.publisher(), other.subscription()
    other.tell("real", publisher, subscription)
    until(lambda: kinds(ours) == ["MP real", "MS real"])
    publisher.close()
    until(lambda: kinds(ours) == ["MS real"])
    other.tell("renamed", subscription)
    until(lambda: kinds(ours) == ["MS renamed"])
    other.tell_nobody()
    until(lambda: seen_tokens(ours) == [])
    other.tell("real", subscription)
    until(lambda: len(seen_tokens(ours)) == 2)
    other.participant.close()
    until(lambda: seen_tokens(ours) == [])
    assert ours._others.gids == {}


def test_a_service_is_there_when_both_its_halves_are(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    requests, replies = other.server()
    reader, writer = other.client()
    other.tell("real", requests, replies, reader, writer)
    until(lambda: kinds(ours) == ["SC real", "SS real"])
    found = {each.kind: each for each in seen_tokens(ours) if isinstance(each, EndpointToken)}
    service = found[EndpointKind.SERVICE]
    assert (service.name, service.type_name, service.type_hash) == ("/set", SET_BOOL, SERVICE_HASH)
    replies.close()
    until(lambda: kinds(ours) == ["SC real"])


def test_the_hash_of_an_unknown_service_is_learned_from_its_client_here(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    other.tell("real", *other.server("my_robot/srv/Special"))
    until(lambda: kinds(ours) == ["SS real"])

    def hashes() -> list[str]:
        return [each.type_hash for each in seen_tokens(ours) if isinstance(each, EndpointToken)]

    assert hashes() == [NO_HASH]
    theirs = "RIHS01_" + "ab" * 32
    ours.announce(token(ours, EndpointKind.CLIENT, "/set", "my_robot/srv/Special", theirs))
    until(lambda: hashes() == [theirs])


def test_endpoints_without_a_hash_have_that_of_the_type_here(fake: FakeNetwork, ours: DdsTransport) -> None:
    """Humble's nodes and plain DDS programs tell none: on DDS the type's name decides."""
    other = Other(fake)
    other.tell("humble", other.publisher(hash_text=NO_HASH))
    until(lambda: kinds(ours) == ["MP humble"])
    assert [each.type_hash for each in seen_tokens(ours) if isinstance(each, EndpointToken)] == [HASH]


def test_programs_that_are_not_of_ros_have_endpoints_without_a_node(fake: FakeNetwork, ours: DdsTransport) -> None:
    bare = Other(fake, b"")
    bare.publisher()
    until(lambda: kinds(ours) == [f"MP {names.BARE_NODE}"])
    assert len(seen_tokens(ours)) == 1


def test_a_participant_tells_of_itself_only(fake: FakeNetwork, ours: DdsTransport) -> None:
    honest, liar = Other(fake), Other(fake)
    publisher = honest.publisher()
    honest.tell("honest", publisher)
    until(lambda: kinds(ours) == ["MP honest"])
    stolen = NodeEntities("/", "liar", (), (publisher.guid,))
    liar._writer.put(entities.encode(ParticipantEntities(honest.participant.guid, (stolen,))))
    liar._writer.put(b"nonsense")
    liar._writer.put(entities.encode(ParticipantEntities(liar.participant.guid, (stolen, stolen))))
    until(lambda: len(seen_tokens(ours)) == 4)
    assert kinds(ours) == ["MP honest"]
    assert sorted(each.node_name for each in seen_tokens(ours)) == ["honest", "honest", "liar", "liar"]


@pytest.mark.parametrize("bad", ["with space", "a" * 5000, "", "ü"])
def test_names_that_ros_would_not_take_are_left_out(fake: FakeNetwork, ours: DdsTransport, bad: str) -> None:
    other = Other(fake)
    if len(bad) < entities.LONGEST_NAME:
        other.tell(bad, other.publisher())
    other.participant.writer(f"rt/{bad}", "std_msgs::msg::dds_::String_", Qos())
    good = Other(fake)
    good.tell("good", good.publisher())
    until(lambda: "MP good" in kinds(ours))
    assert kinds(ours) == ["MP good"]


def test_a_new_session_lists_all_that_is_there(fake: FakeNetwork) -> None:
    others = [Other(fake) for _ in range(3)]
    for number, other in enumerate(others):
        other.tell(f"node{number}", other.publisher(), *other.server())
    session = open_session(fake)
    assert kinds(session) == [f"{kind} node{number}" for kind in ("MP", "SS") for number in range(3)]
    session.close()


def test_a_new_session_waits_for_who_is_on_this_machine_and_slow(
    fake: FakeNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dds_transport, "LATE", 30.0)
    monkeypatch.setattr(dds_transport, "PATIENCE", 30.0)  # a thread that has no processor is not frozen
    opens: Any = fake.open
    threads: list[threading.Timer] = []

    def begin() -> None:
        slow = Other(fake)
        slow.tell("slow", slow.publisher())

    def count() -> int:
        threads.append(threading.Timer(0.05, begin))
        threads[0].start()
        return 2

    session = DdsTransport(opens, count_here=count)
    assert kinds(session) == ["MP slow"]
    threads[0].join()
    monkeypatch.setattr(dds_transport, "LATE", 0.1)
    impatient = DdsTransport(opens, count_here=lambda: 9)
    assert kinds(impatient) == ["MP slow"]
    for each in (session, impatient):
        each.close()


def test_who_comes_late_has_as_much_time_to_tell_as_the_first_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, seconds in (("FIRST", 0.0), ("PATIENCE", 10.0), ("LATE", 60.0), ("LONGEST", 60.0)):
        monkeypatch.setattr(dds_transport, name, seconds)
    fake = FakeNetwork(threaded=False)
    opens: Any = fake.open
    telling = threading.Timer(0.05, fake.deliver)

    def count() -> int:
        late = Other(fake)
        late.tell("late", late.publisher())
        telling.start()
        return 2

    session = DdsTransport(opens, count_here=count)
    assert session._worker.catch_up(30.0)
    session._begin -= 15.0  # a while ago, and nothing has happened since
    session._worker.latest -= 15.0
    assert kinds(session) == ["MP late"]
    telling.join()
    session.close()


def test_a_frozen_participant_does_not_hold_up_a_listing_for_long(
    fake: FakeNetwork, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dds_transport, "PATIENCE", 0.05)
    frozen = Other(fake)  # it has told nothing of its nodes
    good = Other(fake)
    good.tell("good", good.publisher())
    session = open_session(fake)
    begin = time.monotonic()
    assert kinds(session) == ["MP good"]
    assert time.monotonic() - begin < 2.0
    frozen.participant.close()
    session.close()


# ---------------------------------------------------------------- topics


def test_what_arrives_says_who_sent_it_when_and_as_which(fake: FakeNetwork, ours: DdsTransport) -> None:
    other, ear = Other(fake), Ear(ours, TALK)
    publisher = other.publisher()
    other.tell("real", publisher)
    until(lambda: kinds(ours) == ["MP real"])
    (text,) = [each for each in ours.tokens(GRAPH) if "/MP/" in each]
    until(lambda: bool(publisher.matched()))
    publisher.put(b"one", timestamp=123_000_000_456)
    publisher.put(b"two", timestamp=124_000_000_000)
    for number, payload, at in ((1, b"one", 123_000_000_456), (2, b"two", 124_000_000_000)):
        sample = ours.read(ear.arrived.get(timeout=10))
        assert sample.payload == payload
        assert unpack_attachment(sample.attachment) == (number, at, gid_of(text))


def test_a_message_goes_out_by_its_publishers_writer(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    other.subscription()
    texts = [token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH) for _ in range(2)]
    outlet, handles = ours.advertise(TALK, DEPTH_3), [ours.announce(each) for each in texts]
    until(lambda: all(each.writer.matched() for each in ours._topics.publications.values()))
    guids = [ours._topics.publications[gid_of(each)].writer.guid for each in texts]
    for number, text in enumerate((texts[1], texts[0], texts[1])):
        outlet.put(b"%d" % number, pack_attachment(number, 5_000_000_000 + number, gid_of(text)))
    until(lambda: len(other.got) == 3)
    assert [(payload, info.writer, info.timestamp) for payload, info in other.got] == [
        (b"0", guids[1], 5_000_000_000),
        (b"1", guids[0], 5_000_000_001),
        (b"2", guids[1], 5_000_000_002),
    ]
    handles[1].close()
    outlet.put(b"withdrawn", pack_attachment(4, 0, gid_of(texts[1])))
    outlet.put(b"last", pack_attachment(5, 0, gid_of(texts[0])))
    until(lambda: other.got[-1][0] == b"last")
    assert len(other.got) == 4


def test_the_key_of_humble_beside_the_true_one_sends_and_brings_nothing_twice(
    fake: FakeNetwork, ours: DdsTransport
) -> None:
    other = Other(fake)
    other.subscription()
    publisher = other.publisher()
    humble = format_key(DataKey(0, "/talk", STRING, NO_HASH))
    text = token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH)
    outlets = [ours.advertise(key, DEPTH_3) for key in (TALK, humble)]
    ours.announce(text)
    ears = [Ear(ours, key) for key in (TALK, humble, f"{TALK}/_buf_cpu")]
    until(lambda: bool(ours._topics.publications[gid_of(text)].writer.matched()) and bool(publisher.matched()))
    for outlet in outlets:
        outlet.put(b"out", pack_attachment(1, 1, gid_of(text)))
    publisher.put(b"in")
    until(lambda: ears[0].arrived.qsize() == 2)
    assert [payload for payload, _ in other.got] == [b"out"]
    assert ears[1].next() == b"out"  # within the session
    assert all(ear.arrived.empty() for ear in ears[1:])


def test_a_writer_that_offers_less_is_read_with_a_warning(
    fake: FakeNetwork, ours: DdsTransport, capsys: pytest.CaptureFixture[str]
) -> None:
    other = Other(fake)
    ours.announce(node_token(ours))
    ear = Ear(ours, TALK, latched(5))
    ours.announce(token(ours, EndpointKind.SUBSCRIPTION, "/talk", STRING, HASH, latched(5)))
    weak = other.publisher(Qos(reliable=False))
    middle = other.publisher(Qos(reliable=True))
    strong = other.publisher(Qos(reliable=True, transient_local=True))
    until(lambda: [len(each.matched()) for each in (weak, middle, strong)] == [1, 2, 3])
    for publisher in (weak, middle, strong):
        publisher.put(b"once")
    assert ear.take(3) == [b"once"] * 3
    until(lambda: bool(other.listed) and [len(each.readers) for each in other.listed[-1].nodes] == [3])
    assert ear.arrived.empty()
    ours._worker.catch_up(10.0)
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "durability" in line and "reliab" in line]
    assert "/talk: a publisher offers less reliability and durability than a subscription here requests" in warning
    assert "a subscription of ROS 2 would get nothing from it over DDS" in warning


def test_topics_that_come_and_go_leave_nothing_behind(ours: DdsTransport) -> None:
    for number in range(3):
        key = format_key(DataKey(0, f"/talk_{number}", STRING, HASH))
        outlet, ear = ours.advertise(key, latched(1)), Ear(ours, key)
        assert len(ours._topics._local) == 1
        outlet.put(b"here", pack_attachment(1, 1, bytes(16)))
        assert ear.next() == b"here"
        ear.handle.close()
        outlet.close()
        del outlet, ear
        assert not ours._topics._local
    assert (ours._topics._outlets, ours._topics._subscriptions, ours._topics.readings) == ({}, {}, {})


def test_a_best_effort_subscription_gets_what_a_reliable_writer_retains(
    fake: FakeNetwork, ours: DdsTransport, capsys: pytest.CaptureFixture[str]
) -> None:
    other, lazily = Other(fake), latched(5, ReliabilityPolicy.BEST_EFFORT)
    strong, weak = [other.publisher(Qos(each, transient_local=True, depth=1)) for each in (True, False)]
    strong.put(b"before")
    ear = Ear(ours, TALK, lazily)
    assert ear.next() == b"before"
    until(lambda: (len(strong.matched()), len(weak.matched())) == (2, 1))
    reliable = [each.qos.reliable for each in other.participant.endpoints() if each.guid in strong.matched()]
    assert sorted(reliable) == [False, True]  # Fast DDS sends what it retains to the RELIABLE one only
    for publisher in (strong, weak):
        publisher.put(b"once")
    assert ear.take(2) == [b"once"] * 2
    assert ear.arrived.empty()
    ours._worker.catch_up(10.0)
    assert "/talk" not in capsys.readouterr().err


@pytest.mark.parametrize("subscription_first", [True, False])
def test_a_real_subscription_that_requests_more_is_warned_of_once(
    fake: FakeNetwork, ours: DdsTransport, capsys: pytest.CaptureFixture[str], subscription_first: bool
) -> None:
    other, weak = Other(fake), QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    text = token(ours, EndpointKind.PUBLISHER, "/talk", STRING, HASH, weak)
    if not subscription_first:
        ours.announce(text)
    other.subscription(), other.subscription()
    until(lambda: len(ours._topics.listeners.get(PLACE, ())) == 2)
    if subscription_first:
        ours.announce(text)
    robolinks, other_session = Ear(ours, TALK), open_session(fake)
    Ear(other_session, TALK)
    until(lambda: len(ours._topics.listeners[PLACE]) == 4)
    ours._worker.catch_up(10.0)
    (warning,) = [line for line in capsys.readouterr().err.splitlines() if "/talk" in line and "requests more" in line]
    assert "requests more reliability than a publisher here offers: over DDS it gets nothing" in warning
    assert robolinks.arrived.empty()
    other_session.close()


def test_a_writer_of_another_definition_is_not_read(fake: FakeNetwork, ours: DdsTransport) -> None:
    other, ear = Other(fake), Ear(ours, TALK)
    wrong, right = other.publisher(hash_text="RIHS01_" + "0" * 64), other.publisher()
    until(lambda: bool(right.matched()) and bool(wrong.matched()))
    wrong.put(b"wrong")
    right.put(b"right")
    assert ear.next() == b"right"
    assert ear.arrived.empty()


def test_latched_samples_wait_for_the_subscription_of_their_token(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    publishers = [other.publisher(Qos(transient_local=True, depth=3)) for _ in range(2)]
    for number in range(5):
        publishers[0].put(b"%d" % number)
    publishers[1].put(b"x")
    ours.announce(token(ours, EndpointKind.SUBSCRIPTION, "/talk", STRING, HASH, latched(2)))
    (reading,) = ours._topics.readings[PLACE]
    until(lambda: len(reading._held) == 2 and all(each.matched() for each in publishers))
    ear = Ear(ours, TALK, latched(2))
    assert sorted(ear.take(3)) == [b"3", b"4", b"x"]
    ear.handle.close()
    again = Ear(ours, TALK, latched(2))
    assert sorted(again.take(4)) == [b"2", b"3", b"4", b"x"]  # a new reader gets all that the writers keep
    (reading,) = ours._topics.readings[PLACE]
    publishers[1].put(b"y")
    assert again.next() == b"y"
    assert again.arrived.empty()


@pytest.mark.parametrize("token_first", [True, False])
def test_a_subscription_and_its_token_share_one_reader(
    fake: FakeNetwork, ours: DdsTransport, token_first: bool
) -> None:
    text = token(ours, EndpointKind.SUBSCRIPTION, "/talk", STRING, HASH)
    if token_first:
        announced, ear = ours.announce(text), Ear(ours, TALK, DEPTH_3)
    else:
        ear, announced = Ear(ours, TALK, DEPTH_3), ours.announce(text)
    assert len(ours._topics.readings[PLACE]) == 1
    ear.handle.close()
    assert len(ours._topics.readings[PLACE]) == 1
    announced.close()
    assert PLACE not in ours._topics.readings


# ---------------------------------------------------------------- the session


def test_what_cannot_be_a_key_is_refused_in_one_line(ours: DdsTransport) -> None:
    with pytest.raises(ConnectionError, match="a//b: a key is DOMAIN/NAME/TYPE/HASH"):
        ours.advertise("a//b", DEPTH_3)


def test_a_domain_that_cannot_be_joined_says_so() -> None:
    def refuse(*_: Any, **__: Any) -> Any:
        raise OSError("no port is free")

    with pytest.raises(ConnectionError, match="cannot join DDS domain 7: no port is free"):
        DdsTransport(refuse, 7)


def test_nothing_of_it_knows_zenoh() -> None:
    for file in Path(dds_transport.__file__).parent.glob("*.py"):
        assert "import zenoh" not in file.read_text(encoding="utf-8")
