"""Hostile datagrams: a participant lives, its memory is flat, and nothing costs it much more than its own size."""

from __future__ import annotations

import socket
import struct
import tracemalloc
from collections.abc import Iterable
from contextlib import ExitStack, closing

import pytest

from robolink.rtps import Participant, Qos, ids
from robolink.rtps import submessages as subs
from robolink.rtps.announcements import EndpointData, ParticipantData, encode_endpoint, encode_participant
from robolink.rtps.core import LocalWriter
from robolink.rtps.parameters import SENTINEL, parameter
from robolink.rtps.submessages import Inline, encode_data, encode_header
from tests.rtps.fuzz import ALL, PEER, Corpus, Mutator, Victim, record, run
from tests.support.domains import free_dds_domain
from tests.support.rtps_network import HOST, TYPE, Network, numbers, sample
from tests.support.waits import wait_until

READER, WRITER = b"\0\0\2\4", b"\0\0\1\3"
"""The victim's reader of rt/all, and the peer's writer to it."""
OUR_WRITER, THEIR_READER = b"\0\0\1\3", b"\0\0\4\4"


@pytest.fixture(scope="module")
def corpus() -> Corpus:
    return record()


@pytest.fixture
def victim(corpus: Corpus) -> Victim:
    """A participant that knows the peer."""
    made = Victim(corpus)
    made.greet()
    made.most_answered = 0
    assert len(made.core.endpoints()) == 6
    return made


def of_peer(*parts: bytes | memoryview) -> bytes:
    return b"".join((encode_header(PEER), *parts))


def cost(victim: Victim, datagrams: Iterable[bytes]) -> float:
    """Give these; return the memory that is held because of them, for each of their bytes."""
    raws = list(datagrams)
    tracemalloc.start()
    try:
        before, _ = tracemalloc.get_traced_memory()
        for raw in raws:
            victim.take(raw)
        after, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    return (after - before) / sum(map(len, raws))


@pytest.mark.slow
def test_mutated_datagrams() -> None:
    """tests.rtps.fuzz gives a million."""
    found = run(20_000, seed=2, life=10_000)
    assert found.all_well
    assert found.memory[-1] < found.memory[0] + 8_000
    assert found.nonsense > 5_000  # enough of them were mutated
    assert found.answered > 100_000  # and enough were understood


def test_mutated_datagrams_at_the_ports_of_a_participant(corpus: Corpus) -> None:
    """Its thread once ended by a port above 65535."""
    got: list[bytes] = []
    with free_dds_domain() as domain, ExitStack() as stack:
        victim = stack.enter_context(closing(Participant(domain)))
        victim.reader("rt/all", TYPE, ALL, lambda payload, info: got.append(payload))
        victim.writer("rt/all", TYPE, ALL)
        sender = stack.enter_context(socket.socket(type=socket.SOCK_DGRAM))
        mutator = Mutator(corpus.all, seed=3)
        ports = [victim._sockets.metatraffic, victim._sockets.default]
        for number in range(4_000):
            sender.sendto(mutator.next()[:65_000], ports[number % 2])
        friend = stack.enter_context(closing(Participant(domain)))
        writer = friend.writer("rt/all", TYPE, ALL)
        wait_until(writer.matched)
        writer.put(sample(7, 200_000))
        wait_until(lambda: got and numbers(got)[-1] == 7)
        assert victim._core.nonsense > 100


def test_the_peer_of_the_corpus_is_understood(corpus: Corpus, victim: Victim) -> None:
    for raw in corpus.all[len(corpus.greeting) :]:
        victim.take(raw)
    assert victim.core.nonsense == 0
    assert len(victim.core.peers()) == 0  # it said goodbye in the end


def test_mutations_are_the_same_for_the_same_seed(corpus: Corpus) -> None:
    one, other = Mutator(corpus.all, 5), Mutator(corpus.all, 5)
    assert [one.next() for _ in range(50)] == [other.next() for _ in range(50)]


def test_a_sample_of_4_gigabytes_costs_what_came_of_it(victim: Victim) -> None:
    def fragments(number: int, size: int, claimed: int) -> bytes:
        head = struct.pack("<HH4s4siIIHHI", 0, 28, READER, WRITER, 0, number, 7, 1, size, claimed)
        return of_peer(struct.pack("<BBH", 0x16, 1, len(head) + size) + head + bytes(size))

    claims = [
        fragments(number, 1024, claimed) for number in range(1, 200) for claimed in (0xFFFFFFFF, 1 << 30, 9 << 10)
    ]
    assert cost(victim, claims) < 2


def test_a_sample_in_crumbs_costs_what_came_of_it(victim: Victim) -> None:
    def crumb(first: int) -> bytes:
        head = struct.pack("<HH4s4siIIHHI", 0, 28, READER, WRITER, 0, 50, first, 1, 1, 1 << 29)
        return of_peer(struct.pack("<BBH", 0x16, 1, len(head) + 4) + head + bytes(4))

    assert cost(victim, [crumb(first) for first in range(2, 3000)]) < 2


def test_a_gap_of_2_to_the_60_samples_costs_little(victim: Victim) -> None:
    gaps = [of_peer(subs.encode_gap(READER, WRITER, 1 << 40, 1 << 60)) for _ in range(100)]
    gaps += [of_peer(subs.encode_gap(READER, WRITER, number, 1 << 60)) for number in range(400, 10_000, 64)]
    gaps += [of_peer(subs.encode_gap(READER, WRITER, 400, 20_000, [20_001, 20_200]))]
    assert cost(victim, gaps) < 3


def test_heartbeats_of_2_to_the_60_samples_cost_little(victim: Victim) -> None:
    beats = [of_peer(subs.encode_heartbeat(READER, WRITER, 1, (1 << 60) + n, n)) for n in range(1, 2000)]
    before = victim.answered
    assert cost(victim, beats) < 1
    assert victim.answered - before < 3 * sum(map(len, beats))


def test_samples_that_wait_for_ever_are_limited(victim: Victim) -> None:
    """Those far ahead, of writers of programs and of discovery."""
    for writer, reader in ((WRITER, READER), (ids.PUBLICATIONS_WRITER, ids.PUBLICATIONS_READER)):
        small = [of_peer(encode_data(reader, writer, 5_000 + n, bytes(16))) for n in range(5_000)]
        assert cost(victim, small) < 8


@pytest.mark.slow
def test_a_thousand_participants_of_a_stranger(victim: Victim, monkeypatch: pytest.MonkeyPatch) -> None:
    most = 50
    monkeypatch.setattr("robolink.rtps.discovery.MOST_PEERS", most)

    def announcement(number: int) -> bytes:
        prefix = ids.VENDOR_ROBOLINK + number.to_bytes(10, "big")
        place = ((HOST, 10_000 + number),)
        data = ParticipantData(prefix, metatraffic=place, default=place, lease=1e9, user_data=bytes(1000), domain=0)
        raw = encode_data(ids.UNKNOWN_ENTITY, ids.SPDP_WRITER, 1, encode_participant(data))
        return encode_header(prefix) + raw

    cost(victim, [announcement(number) for number in range(200)])
    assert len(victim.core.peers()) == most
    # What is held is for those who took the places of others.
    assert cost(victim, [announcement(number) for number in range(200, 1_000)]) * 800 / most < 4
    assert len(victim.core.peers()) == most
    assert any(peer.prefix == PEER for peer in victim.core.peers())  # who was there stays
    assert victim.is_well()  # and who comes is let in


@pytest.mark.slow
@pytest.mark.parametrize("is_writer", [True, False])
def test_endless_endpoints_of_a_stranger(victim: Victim, is_writer: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    most = 1_000
    monkeypatch.setattr("robolink.rtps.discovery.MOST_ENDPOINTS", most)
    monkeypatch.setattr("robolink.rtps.core.MOST_MATCHES", 300)

    def announcement(number: int) -> bytes:
        guid = PEER + number.to_bytes(3, "big") + (b"\3" if is_writer else b"\4")
        payload = encode_endpoint(EndpointData(guid, is_writer, "rt/all", TYPE, Qos(), (), bytes(100)))
        return of_peer(encode_data(*said_by, number, payload))

    said_by = (ids.SUBSCRIPTIONS_READER, ids.SUBSCRIPTIONS_WRITER)
    if is_writer:
        said_by = (ids.PUBLICATIONS_READER, ids.PUBLICATIONS_WRITER)

    assert cost(victim, [announcement(number) for number in range(4, most + 200)]) < 20
    assert len(victim.core.endpoints()) == most
    matched = [len(writer.readers) for writer in victim.core._writers.values()]
    matched += [len(reader.writers) for readers in victim.core._readers_of.values() for reader in readers[:1]]
    assert max(matched) == 300
    assert cost(victim, [announcement(number) for number in range(most + 200, most + 500)]) < 0.1


def test_an_announcement_of_megabytes_is_refused(victim: Victim) -> None:
    data = EndpointData(PEER + b"\1\1\1\3", True, "rt/x", TYPE)
    payload = encode_endpoint(data)[:-4] + parameter(0x3000, bytes(60_000)) * 50 + SENTINEL
    pieces = [
        of_peer(*subs.encode_data_frag(ids.PUBLICATIONS_READER, ids.PUBLICATIONS_WRITER, 4, n, 60_000, payload))
        for n in range(1, len(payload) // 60_000 + 2)
    ]
    assert cost(victim, pieces) < 0.1


def test_what_waits_of_all_writers_has_one_limit_and_the_greediest_loses(
    victim: Victim, monkeypatch: pytest.MonkeyPatch
) -> None:
    room = victim.core._room
    monkeypatch.setattr(room, "_most", 1_000_000)

    def early(writer: bytes, reader: bytes, number: int) -> bytes:
        return of_peer(encode_data(reader, writer, number, bytes(60_000)))

    held = cost(victim, [early(WRITER, READER, number) for number in range(100, 200)])
    assert held * 100 * 60_000 < 1_200_000
    assert 900_000 < room.used <= 1_000_000
    for number in range(100, 105):  # the other one finds room
        victim.take(early(b"\0\0\2\3", b"\0\0\4\4", number))
    assert room.used == 300_000


def test_a_sample_that_is_too_large_is_passed_over() -> None:
    """Else it would be requested for ever, and nothing behind it would come."""
    network = Network()
    a, b = network.join(), network.join()
    writer = a.writer("rt/all", ALL)
    reader, got = b.reader("rt/all", ALL)
    reader._largest = 200_000
    network.run(2)
    for number, size in ((1, 100_000), (2, 200_004), (3, 100_000), (4, 12)):
        a.put(writer, sample(number, size))
    assert network.run(2, until=lambda: len(got) == 3)
    assert numbers(got) == [1, 3, 4]
    network.run(1)
    network.sent.clear()
    network.run(2)
    assert network.is_quiet


def test_requests_of_large_samples_again_and_again(victim: Victim) -> None:
    """A reader may request what it lost, but not have us send without end."""
    writer = victim.core._writers[OUR_WRITER]
    assert isinstance(writer, LocalWriter)
    for number in range(300):
        victim.member.put(writer, sample(number, 60_000))
    victim.take(of_peer(subs.encode_acknack(THEIR_READER, OUR_WRITER, 1, [], 1)))
    before = victim.answered
    for serial in range(2, 102):
        victim.take(of_peer(subs.encode_acknack(THEIR_READER, OUR_WRITER, 1, range(1, 257), serial)))
        victim.take(of_peer(subs.encode_nack_frag(THEIR_READER, OUR_WRITER, 2, [1, 2, 3], serial)))
    seconds = 0.2
    assert 5_000_000 < victim.answered - before < (8 << 20) + seconds * 100e6


def test_a_datagram_full_of_everything(victim: Victim) -> None:
    """As many submessages as have room: the answers are of the same order."""
    for part in (
        subs.encode_heartbeat(READER, WRITER, 1, 5, 9),
        subs.encode_acknack(THEIR_READER, OUR_WRITER, 0, [], 4),
        subs.encode_gap(READER, WRITER, 3, 9, [11]),
        subs.encode_inline(Inline()) or b"\x01\1\0\0",
    ):
        raw = of_peer(part * (64_000 // len(part)))
        victim.take(raw)
        assert victim.most_answered < 10 * len(raw)
