"""Services of DdsTransport over a network in memory: identities of calls in both forms, and who waits for whom."""

from __future__ import annotations

import pytest

from robolink.dds.names import Role, dds_topic, dds_type
from robolink.dds.transport import DdsTransport
from robolink.qos import QoSProfile
from robolink.rtps import Qos
from robolink.wire import (
    EndpointKind,
    gid_of,
    pack_attachment,
    unpack_attachment,
)
from tests.support.dds_others import (
    SERVICE,
    SERVICE_HASH,
    SET_BOOL,
    Other,
    node_token,
    token,
)
from tests.support.fake_rtps import ECLIPSE, FakeNetwork
from tests.support.transports import Caller, Desk, until


def test_a_request_names_the_reader_of_its_reply(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    _, replies = other.server()
    text = token(ours, EndpointKind.CLIENT, "/set", SET_BOOL, SERVICE_HASH)
    ours.announce(text)
    client = ours._services._clients[gid_of(text)]
    until(lambda: bool(client._requests.matched()) and bool(replies.matched()))
    caller = Caller(ours, b"please", SERVICE, pack_attachment(41, 1, gid_of(text)))
    until(lambda: bool(other.got))
    payload, info = other.got[0]
    assert (payload, info.related) == (b"please", (client._replies.guid, 0))
    replies.put(b"of another client", related=(bytes(15) + b"\1", info.number))
    replies.put(b"of another call", related=(client._replies.guid, info.number + 1))
    replies.put(b"yes", related=(client._replies.guid, info.number), timestamp=77)
    ((answer, attachment),) = caller.replies()
    assert answer == b"yes"
    assert unpack_attachment(attachment) == (41, 77, gid_of(text))


def test_a_reply_that_names_the_writer_of_the_request_is_taken_too(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    _, replies = other.server()
    ours.announce(text := token(ours, EndpointKind.CLIENT, "/set", SET_BOOL, SERVICE_HASH))
    until(lambda: bool(replies.matched()))
    caller = Caller(ours, b"please", SERVICE, pack_attachment(1, 1, gid_of(text)))
    until(lambda: bool(other.got))
    replies.put(b"yes", related=(other.got[0][1].writer, other.got[0][1].number))
    assert caller.answers() == [b"yes"]


@pytest.mark.parametrize("names_reader", [True, False])
def test_a_reply_names_its_request_and_its_client(fake: FakeNetwork, ours: DdsTransport, names_reader: bool) -> None:
    other, desk = Other(fake), Desk(ours, SERVICE)
    reader, writer = other.client()
    until(lambda: bool(writer.matched()) and bool(reader.matched()))
    writer.put(b"first", related=(reader.guid, 0) if names_reader else None)
    number = writer.put(b"second", related=(reader.guid, -1 << 32) if names_reader else (bytes(16), 0))
    queries = [desk.next(), desk.next()]
    assert unpack_attachment(queries[1].attachment)[::2] == (number, writer.guid)
    for query in reversed(queries):
        query.reply(b"re " + query.payload, b"")
        query.reply(b"again", b"")
        query.close()
        query.reply(b"too late", b"")
    until(lambda: len(other.got) == 2)
    whom = reader.guid if names_reader else writer.guid
    assert [(payload, info.related) for payload, info in other.got] == [
        (b"re second", (whom, 2)),
        (b"re first", (whom, 1)),
    ]


HEAD = b"\0\1\0\0"


def test_each_server_gets_a_request_in_its_own_form(fake: FakeNetwork, ours: DdsTransport) -> None:
    """Cyclone's services have a header in the payload, where the others have inline QoS: each reads its own only."""
    ours.announce(text := token(ours, EndpointKind.CLIENT, "/set", SET_BOOL, SERVICE_HASH))
    fast, cyclone = Other(fake), Other(fake, vendor=ECLIPSE)
    (_, fast_replies), (_, cyclone_replies) = fast.server(), cyclone.server()
    client = ours._services._clients[gid_of(text)]
    until(lambda: client._with_headers is not None and len(client._with_headers.matched()) == 1)
    until(lambda: len(client._requests.matched()) == 1 and all((fast_replies.matched(), cyclone_replies.matched())))
    caller = Caller(ours, HEAD + b"please  ", SERVICE, pack_attachment(7, 1, gid_of(text)))
    until(lambda: bool(fast.got) and bool(cyclone.got))
    assert [payload for payload, _ in fast.got] == [HEAD + b"please  "]
    ((asked, info),) = cyclone.got
    assert (info.related, asked[:4], asked[20:]) == (None, HEAD, b"please  ")
    cyclone_replies.put(HEAD + bytes(8) + asked[12:20] + b"of another client")
    cyclone_replies.put(HEAD)
    cyclone_replies.put(asked[:20] + b"by header")
    fast_replies.put(HEAD + b"beside it", related=(client._replies.guid, fast.got[0][1].number))
    assert sorted(caller.answers()) == [HEAD + b"beside it", HEAD + b"by header"]


@pytest.mark.parametrize("head", [HEAD, bytes(4)], ids=["little", "big"])
def test_each_client_gets_a_reply_in_its_own_form(fake: FakeNetwork, ours: DdsTransport, head: bytes) -> None:
    fast, cyclone = Other(fake), Other(fake, vendor=ECLIPSE)
    ours.announce(node_token(ours))
    desk = Desk(ours, SERVICE)
    ours.announce(token(ours, EndpointKind.SERVICE, "/set", SET_BOOL, SERVICE_HASH))
    (reader, writer), (_, headed) = fast.client(), cyclone.client()
    until(lambda: bool(writer.matched()) and bool(headed.matched()) and bool(reader.matched()))
    header = bytes(range(8)) + (99).to_bytes(8, "little" if head[1] else "big")
    headed.put(b"short")
    headed.put(head + header + b"one")
    writer.put(head + b"two", related=(reader.guid, 0))
    queries = [desk.next(), desk.next()]
    assert sorted(each.payload for each in queries) == [head + b"one", head + b"two"]
    for query in queries:
        query.reply(head + b"re " + query.payload[4:], b"")
    until(lambda: bool(fast.got) and bool(cyclone.got))
    assert [payload for payload, _ in cyclone.got] == [head + header + b"re one"]
    assert [payload for payload, _ in fast.got] == [head + b"re two"]
    until(lambda: bool(fast.listed) and [len(each.writers) for each in fast.listed[-1].nodes] == [2])


def test_a_reply_waits_until_its_clients_reader_is_met(fake: FakeNetwork, ours: DdsTransport) -> None:
    """Fast DDS tells of a client's two ends one after the other: a reply to a reader that is not matched is lost."""
    other, desk = Other(fake), Desk(ours, SERVICE)
    topic, type_name = dds_topic(Role.REQUEST, "/set"), dds_type(Role.REQUEST, SET_BOOL)
    writer = other.participant.writer(topic, type_name, Qos())
    until(lambda: bool(writer.matched()))
    ahead = other.participant.prefix + (int.from_bytes(writer.guid[12:15], "big") + 1).to_bytes(3, "big") + b"\4"
    writer.put(b"early", related=(ahead, 0))
    query = desk.next()
    query.reply(b"here it is", b"")
    topic, type_name = dds_topic(Role.REPLY, "/set"), dds_type(Role.REPLY, SET_BOOL)
    reader = other.participant.reader(topic, type_name, Qos(), other.sink)
    assert reader.guid == ahead
    until(lambda: bool(other.got))
    assert other.got[0] == (b"here it is", other.got[0][1]._replace(related=(ahead, 1)))


def test_replies_for_a_client_that_is_gone_are_dropped(fake: FakeNetwork, ours: DdsTransport) -> None:
    other, desk = Other(fake), Desk(ours, SERVICE)
    topic, type_name = dds_topic(Role.REQUEST, "/set"), dds_type(Role.REQUEST, SET_BOOL)
    writer = other.participant.writer(topic, type_name, Qos())
    until(lambda: bool(writer.matched()))
    writer.put(b"early", related=(other.participant.prefix + b"\0\0\x63\4", 0))
    desk.next().reply(b"for nobody", b"")
    (server,) = ours._services._servers["/set", SET_BOOL]
    assert len(server._waiting) == 1
    other.participant.close()
    until(lambda: len(server._waiting) == 0)


def test_a_call_ends_when_its_server_goes(fake: FakeNetwork, ours: DdsTransport) -> None:
    first, second = Other(fake), Other(fake)
    first.server()
    _, replies = second.server()
    ours.announce(text := token(ours, EndpointKind.CLIENT, "/set", SET_BOOL, SERVICE_HASH))
    client = ours._services._clients[gid_of(text)]
    until(lambda: len(client._requests.matched()) == 2 and bool(replies.matched()))
    caller = Caller(ours, b"all", SERVICE, pack_attachment(1, 1, gid_of(text)))
    until(lambda: bool(first.got) and bool(second.got))
    replies.put(b"yes", related=(client._replies.guid, second.got[0][1].number))
    assert ours.read(caller.arrived.get(timeout=10)).payload == b"yes"
    assert caller.arrived.empty()
    first.participant.close()
    assert caller.arrived.get(timeout=10) is None


def test_requests_wait_for_the_service_of_their_token(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    reader, writer = other.client()
    announced = ours.announce(token(ours, EndpointKind.SERVICE, "/set", SET_BOOL, SERVICE_HASH))
    until(lambda: bool(writer.matched()) and bool(reader.matched()))
    writer.put(b"early", related=(reader.guid, 0))
    (server,) = ours._services._servers["/set", SET_BOOL]
    until(lambda: len(server._held) == 1)
    desk = Desk(ours, SERVICE)
    assert desk.next().payload == b"early"
    assert len(ours._services._servers["/set", SET_BOOL]) == 1
    desk.handle.close()
    announced.close()
    until(lambda: writer.matched() == [])


def test_a_service_has_the_profile_of_its_token(fake: FakeNetwork, ours: DdsTransport) -> None:
    other = Other(fake)
    Desk(ours, SERVICE)
    ours.announce(token(ours, EndpointKind.SERVICE, "/set", SET_BOOL, SERVICE_HASH, QoSProfile(depth=3)))
    until(lambda: "rq/setRequest" in other.seen and other.seen["rq/setRequest"].qos.depth == 3)
    assert len(ours._services._servers["/set", SET_BOOL]) == 1
