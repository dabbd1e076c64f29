"""Participants among themselves in virtual time: what arrives, whatever the network does."""

from __future__ import annotations

import itertools
import random

import pytest

from robolink.rtps import Info, Qos, ids
from robolink.rtps.core import LocalReader, LocalWriter
from robolink.rtps.parameters import Locator
from robolink.rtps.submessages import (
    AckNack,
    Data,
    DataFrag,
    Gap,
    Heartbeat,
    NackFrag,
    encode_data_frag,
    encode_gap,
    encode_header,
    encode_heartbeat,
    parse,
)
from robolink.rtps.writer import FRAGMENT, MOST_STORED
from tests.support.big_endian import big_endian
from tests.support.rtps_network import TYPE, Faults, Member, Network, numbers, sample

LATCHED = Qos(transient_local=True, depth=1)
BEST_EFFORT = Qos(reliable=False)
ALL = Qos(depth=0)

HOSTILE = [
    Faults(every=7),
    Faults(loss=0.33),
    Faults(jitter=0.02),
    Faults(twice=0.5, jitter=0.002),
    Faults(loss=0.2, twice=0.2, jitter=0.01),
]


def pair(network: Network) -> tuple[Member, Member]:
    return network.join(), network.join()


def met(
    network: Network, qos: Qos = ALL, wants: Qos | None = None
) -> tuple[Member, Member, LocalWriter, LocalReader, list[bytes]]:
    """Return two participants with a writer and a reader that are matched, and what the reader gets."""
    a, b = pair(network)
    writer = a.writer(qos=qos)
    reader, got = b.reader(qos=wants or qos)
    assert network.run(5, until=lambda: bool(writer.readers) and bool(reader.writers))
    assert network.run(5, until=lambda: writer.due == float("inf"))
    network.sent.clear()
    return a, b, writer, reader, got


@pytest.mark.parametrize("faults", HOSTILE)
def test_reliable_samples_arrive_all_once_and_in_order_on_a_hostile_network(faults: Faults) -> None:
    network = Network()
    network.faults = faults
    a, _, writer, _, got = met(network)
    for number in range(300):
        a.put(writer, sample(number))
        network.run(0.001)
    network.run(5, until=lambda: len(got) >= 300)
    assert numbers(got) == list(range(300))


@pytest.mark.parametrize("faults", HOSTILE)
def test_large_reliable_samples_arrive_all_once_and_in_order_on_a_hostile_network(faults: Faults) -> None:
    network = Network()
    network.faults = faults
    a, _, writer, _, got = met(network)
    for number in range(20):
        a.put(writer, sample(number, 10 * FRAGMENT + 8))
        network.run(0.02)
    network.run(20, until=lambda: len(got) >= 20)
    assert numbers(got) == list(range(20))
    assert {len(each) for each in got} == {10 * FRAGMENT + 8}


@pytest.mark.parametrize("faults", HOSTILE)
@pytest.mark.parametrize("size", [12, 3 * FRAGMENT])
def test_best_effort_samples_arrive_in_order_and_without_any_request(faults: Faults, size: int) -> None:
    network = Network()
    a, _, writer, _, got = met(network, ALL, BEST_EFFORT)
    network.faults = faults
    for number in range(300):
        a.put(writer, sample(number, size))
        network.run(0.001 if size == 12 else 0.03)
    network.run(1)
    assert numbers(got) == sorted(set(numbers(got)))
    assert 20 < len(got) <= 300
    assert not network.submessages(AckNack)
    assert not network.submessages(NackFrag)
    assert not network.submessages(Heartbeat)


def test_a_late_reader_gets_the_latched_sample() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=LATCHED)
    for number in range(3):
        a.put(writer, sample(number))
    network.run(3)
    _, got = b.reader(qos=LATCHED)
    assert network.run(0.2, until=lambda: bool(got))
    network.run(1)
    assert numbers(got) == [2]


def test_a_late_reader_gets_a_latched_sample_in_fragments() -> None:
    network = Network()
    network.faults = Faults(every=7)
    a, b = pair(network)
    writer = a.writer(qos=LATCHED)
    a.put(writer, sample(5, 1_000_000))
    network.run(3)
    _, got = b.reader(qos=LATCHED)
    assert network.run(0.5, until=lambda: bool(got))
    assert (numbers(got), len(got[0])) == ([5], 1_000_000)


def test_a_late_reader_that_does_not_want_old_samples_gets_the_new_ones() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=Qos(transient_local=True))
    for number in range(8):
        a.put(writer, sample(number))
    reader, got = b.reader(qos=Qos())
    network.run(2)
    assert reader.writers
    a.put(writer, sample(8))
    network.run(1)
    assert numbers(got) == [8]


def test_a_late_reader_gets_no_sample_whose_lifespan_is_over() -> None:
    network = Network()
    a, b = pair(network)
    qos = Qos(transient_local=True, depth=0, lifespan=1.0)
    writer = a.writer(qos=qos)
    for number in range(10):
        a.put(writer, sample(number))
        network.run(0.25)
    _, got = b.reader(qos=qos)
    network.run(1)
    assert numbers(got) == [7, 8, 9]


def test_a_late_best_effort_reader_gets_the_latched_samples() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=Qos(transient_local=True, depth=3))
    for number in range(5):
        a.put(writer, sample(number, 100_000 if number == 4 else 12))
    _, got = b.reader(qos=Qos(reliable=False, transient_local=True))
    network.run(2)
    assert numbers(got) == [2, 3, 4]


@pytest.mark.parametrize(
    ("qos", "size", "kept"),
    [
        (Qos(depth=3), 12, 30),  # ten times as many, since they may all be lost in one row
        (Qos(depth=20), 12, 100),
        (Qos(depth=150), 12, 150),
        (Qos(depth=3), 1_000_000, 8),  # as long as they are small
        (Qos(depth=12), 1_000_000, 12),
        (Qos(depth=3, transient_local=True), 12, 3),
    ],
)
def test_samples_too_far_beyond_the_depth_are_skipped_by_a_reader_that_lost_them(
    qos: Qos, size: int, kept: int
) -> None:
    network = Network()
    a, _, writer, _, got = met(network, qos)
    network.faults = Faults(is_lost=lambda raw, address: True)
    total = 200 if size == 12 else 20
    for number in range(total):
        a.put(writer, sample(number, size))
    network.run(0.3)
    network.faults = Faults()
    network.run(3)
    assert numbers(got) == list(range(total - kept, total))


def test_holes_in_the_history_are_told_by_a_gap() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=Qos(transient_local=True, depth=0))
    for number in range(1, 8):
        a.put(writer, sample(number))
    for number in (1, 3, 4, 7):
        writer.discard(number)
    _, got = b.reader(qos=Qos(transient_local=True))
    network.run(2)
    assert numbers(got) == [2, 5, 6]
    assert network.submessages(Gap)
    network.sent.clear()
    network.run(10)
    assert network.is_quiet  # nothing is requested for ever


def test_several_readers_behind_one_address_get_one_datagram() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=ALL)
    readers = [b.reader(qos=ALL) for _ in range(3)]
    readers.append(b.reader(qos=BEST_EFFORT))
    network.run(2)
    assert len(writer.readers) == 4
    network.sent.clear()
    for size in (12, 2 * FRAGMENT):
        a.put(writer, sample(1, size))
    network.run(2)
    assert [each.reader for each in network.submessages(Data)] == [ids.UNKNOWN_ENTITY]
    assert [each.reader for each in network.submessages(DataFrag)] == [ids.UNKNOWN_ENTITY] * 2
    assert [len(got) for _, got in readers] == [2] * 4


def test_a_reader_gets_only_what_the_writers_send_that_it_is_matched_with() -> None:
    network = Network()
    a, b = pair(network)
    strong, weak = a.writer(qos=ALL), a.writer(qos=BEST_EFFORT)
    reliable, got = b.reader(qos=ALL)
    rest, others = b.reader(qos=BEST_EFFORT, accepts=lambda endpoint: not endpoint.qos.reliable)
    network.run(2)
    assert ([*reliable.writers], [*rest.writers]) == ([strong.guid], [weak.guid])
    for number in range(5):
        a.put(strong, sample(number))
        a.put(weak, sample(10 + number))
    network.run(1)
    assert (numbers(got), numbers(others)) == ([0, 1, 2, 3, 4], [10, 11, 12, 13, 14])


def test_a_writer_sends_only_to_the_participants_that_it_accepts() -> None:
    network = Network()
    a, b = pair(network)
    c = network.join()
    writer = a.writer(accepts=lambda endpoint: endpoint.guid[:12] == c.core.prefix)
    (_, refused), (_, accepted) = b.reader(), c.reader()
    network.run(2)
    a.put(writer, sample(1))
    network.run(2)
    assert (len(refused), len(accepted)) == (0, 1)


def test_topics_with_keys_are_not_matched() -> None:
    network = Network()
    a, b = pair(network)
    network.run(1)
    reader, _ = b.reader()
    keyed = a.core._endpoint(0x02, "rt/a", TYPE, Qos(), b"")
    a.core._discovery.publish(network.now, keyed._replace(is_writer=True))
    network.run(1)
    assert [endpoint.guid for endpoint, _ in b.found] == [keyed.guid]
    assert not reader.writers


@pytest.mark.parametrize(
    ("offered", "requested", "fit"),
    [
        (Qos(), Qos(), True),
        (Qos(), BEST_EFFORT, True),
        (BEST_EFFORT, Qos(), False),
        (Qos(), Qos(transient_local=True), False),
        (Qos(transient_local=True), Qos(), True),
        (Qos(deadline=0.1), Qos(deadline=0.2), True),
        (Qos(deadline=0.3), Qos(deadline=0.2), False),
        (Qos(), Qos(deadline=0.2), False),
        (Qos(liveliness=0), Qos(liveliness=2), False),
        (Qos(lease=3), Qos(lease=1), False),
    ],
)
def test_endpoints_are_matched_if_their_qos_fit(offered: Qos, requested: Qos, fit: bool) -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=offered)
    reader, _ = b.reader(qos=requested)
    network.run(1)
    assert (bool(writer.readers), bool(reader.writers)) == (fit, fit)


def test_nothing_is_sent_but_announcements_once_all_is_acknowledged() -> None:
    network = Network()
    a, _, writer, _, _ = met(network)
    a.put(writer, sample(1))
    network.run(2)
    network.sent.clear()
    network.run(20)
    assert network.is_quiet
    assert writer._history == {}
    ticks = 20  # one search a second, and their renewals
    assert len({at for at, _, _ in network.sent}) <= 2 * (ticks + 8)


def test_a_reader_that_is_gone_without_a_word_is_reminded_ever_more_rarely() -> None:
    network = Network()
    a, b, writer, _, _ = met(network)
    b.kill()
    a.put(writer, sample(1))
    network.run(10)
    assert 5 < len(network.submessages(Heartbeat)) < 20
    network.run(20)
    assert not writer.readers
    network.sent.clear()
    network.run(5)
    assert network.is_quiet


@pytest.mark.parametrize("who", [0, 1])
def test_a_big_endian_participant_is_understood(who: int) -> None:
    network = Network()
    members = pair(network)
    members[who].rewrite = big_endian
    a, b = members
    infos: list[Info] = []
    a.core.add_reader(network.now, "rt/answer", TYPE, ALL, lambda _, info: infos.append(info))
    question, answer = a.writer("rt/question", ALL), b.writer("rt/answer", ALL)
    latched = a.writer("rt/latched", LATCHED)
    a.put(latched, sample(1, 5 * FRAGMENT))
    a.put(latched, sample(2, 5 * FRAGMENT))
    _, got = b.reader("rt/question", ALL)
    network.run(1)
    _, late = b.reader("rt/latched", LATCHED)
    network.faults = Faults(every=5)
    for number in range(50):
        a.put(question, sample(number))
        b.put(answer, sample(number), (question.guid, number + (1 << 33)))
        network.run(0.01)
    network.run(3)
    assert numbers(got) == list(range(50))
    assert numbers(late) == [2]
    assert [info.related for info in infos] == [(question.guid, number + (1 << 33)) for number in range(50)]
    assert {info.timestamp for info in infos} == {1_700_000_000_123_456_789}
    network.faults = Faults()
    members[who].leave()
    network.run(0.1)
    assert not members[1 - who].core.peers()


@pytest.mark.parametrize("size", [13, 14, 15, 16, FRAGMENT + 1, FRAGMENT + 2])
def test_a_payload_arrives_with_at_most_three_bytes_more(size: int) -> None:
    network = Network()
    a, _, writer, _, got = met(network)
    payload = (b"\0\1\0\0" + bytes(range(256)) * 300)[:size]
    a.put(writer, payload)
    network.run(1)
    assert got[0][:size] == payload
    assert got[0][size:] == bytes(-size % 4 if size <= FRAGMENT else 0)


def test_a_writer_that_keeps_all_has_a_cap_and_the_oldest_are_skipped() -> None:
    network = Network()
    a, _, writer, _, got = met(network)
    network.faults = Faults(is_lost=lambda raw, address: True)
    for number in range(MOST_STORED + 100):
        a.put(writer, sample(number))
    assert (len(writer._history), writer.lost) == (MOST_STORED, 100)
    network.faults = Faults()
    network.run(20, until=lambda: len(got) == MOST_STORED)
    assert numbers(got) == list(range(100, MOST_STORED + 100))
    network.run(1)
    assert writer._history == {}


def test_a_writer_that_keeps_all_keeps_no_more_bytes_than_its_cap(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.rtps.writer.MOST_STORED_BYTES", 1_000_000)
    network = Network()
    a, _, writer, _, got = met(network)
    network.faults = Faults(is_lost=lambda raw, address: True)
    for number in range(20):
        a.put(writer, sample(number, 100_000))
    assert [change.number for change in writer._history.values()] == list(range(11, 21))
    network.faults = Faults()
    network.run(3)
    assert numbers(got) == list(range(10, 20))


def test_what_waits_for_an_earlier_sample_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robolink.rtps.reader.MOST_WAITING", 50)
    monkeypatch.setattr("robolink.rtps.reader.MOST_WAITING_BYTES", 300_000)
    network = Network()
    a, _b, writer, reader, got = met(network)
    lost = sample(0)
    network.faults = Faults(is_lost=lambda raw, address: lost in raw)
    for number in range(200):
        a.put(writer, sample(number, 12 if number % 5 else 12 + 100_000 * (number > 0)))
        network.run(0.001)
    proxy = reader.writers[writer.guid]
    network.run(1)
    assert not got
    assert len(proxy.waiting) <= 50
    assert proxy.bytes <= 400_000
    network.faults = Faults()
    network.run(10, until=lambda: len(got) == 200)
    assert numbers(got) == list(range(200))
    assert proxy.bytes == 0


def test_an_acknowledgement_is_requested_before_much_is_under_way() -> None:
    network = Network()
    a, _b, writer, _reader, got = met(network)
    network.run(1)
    network.sent.clear()
    most = 0
    for number in range(2000):  # 10,000 a second
        a.put(writer, sample(number))
        network.run(0.0001)
        most = max(most, len(writer._history))
    assert most < 200
    assert len(network.submessages(AckNack)) < 30  # not one for each
    network.run(0.05)
    assert (len(got), writer._history) == (2000, {})


def test_a_reader_that_answers_only_in_a_pause_of_heartbeats_has_one() -> None:
    """Fast DDS answers 5 ms after a heartbeat, and begins to wait anew with each."""
    network = Network()
    a, _b, writer, _reader, _got = met(network)
    network.run(1)
    network.sent.clear()
    for number in range(1000):
        a.put(writer, sample(number))
        network.run(0.001)
    network.run(1)
    beats = [at for at, raw, _ in network.sent for each in parse(raw).submessages if isinstance(each, Heartbeat)]
    assert 100 < len(beats) < 130
    assert min(later - earlier for earlier, later in itertools.pairwise(beats)) > 0.007


def test_the_last_of_a_row_of_samples_is_not_missed_for_long() -> None:
    network = Network()
    a, _b, writer, _reader, got = met(network)
    network.run(1)
    lost = sample(4)
    network.faults = Faults(is_lost=lambda raw, address: lost in raw)
    for number in range(5):
        a.put(writer, sample(number))
    network.faults = Faults()
    network.run(0.03)
    assert numbers(got) == [0, 1, 2, 3, 4]


def test_requests_count_on_when_a_participant_comes_back() -> None:
    """A Fast DDS that stood still for longer than its lease has not missed us, and ignores what does not count up."""
    network = Network()
    a, b, writer, reader, _ = met(network)
    for each in range(5):
        a.put(writer, sample(each))
        network.run(1)

    def serials() -> list[int]:
        return [each.serial for each in network.submessages(AckNack) if each.reader == reader.entity]

    before = serials()
    network.sent.clear()
    b.core._discovery.lose(a.core.prefix)
    assert network.run(5, until=lambda: bool(reader.writers))
    network.run(1)
    after = serials()
    assert before
    assert min(after) > max(before)


def test_a_lost_sample_is_requested_when_the_next_one_comes() -> None:
    network = Network()
    a, _, writer, _, got = met(network)
    lost = sample(1)
    network.faults = Faults(is_lost=lambda raw, address: lost in raw)
    a.put(writer, sample(0))
    a.put(writer, lost)
    network.faults = Faults()
    a.put(writer, sample(2))
    network.run(0.002)  # the heartbeat of a Fast DDS may be 3 s away
    assert numbers(got) == [0, 1, 2]


def test_a_lost_fragment_is_requested_when_the_last_one_comes() -> None:
    network = Network()
    a, _, writer, _, got = met(network)
    seen: list[bytes] = []

    def third(raw: bytes, address: Locator) -> bool:
        seen.append(raw)
        return len(seen) == 3

    network.faults = Faults(is_lost=third)
    a.put(writer, sample(0, 9 * FRAGMENT))
    network.run(0.002)
    assert numbers(got) == [0]
    assert [nack.missing for nack in network.submessages(NackFrag)] == [[3]]


def test_a_large_sample_gets_through_a_small_buffer() -> None:
    """A burst of which six datagrams of 64 kB have room, as in the buffer that a socket has by default."""
    network = Network()
    a, b, writer, _, got = met(network)
    came: list[float] = []

    def is_full(raw: bytes, address: Locator) -> bool:
        if address != b.default or len(raw) < 10_000:
            return False
        came[:] = [at for at in came if at > network.now - 0.00015]
        if len(came) < 6:
            came.append(network.now)
            return False
        return True

    network.faults = Faults(is_lost=is_full)
    a.put(writer, sample(0, 6_200_000))
    network.run(0.5, until=lambda: bool(got))
    assert len(got) == 1
    fragments = len(network.submessages(DataFrag))
    assert fragments < 2.5 * 6_200_000 / FRAGMENT  # what it has no room for is not requested again and again


def test_a_heartbeat_with_each_fragment_is_answered_once() -> None:
    """Fast DDS sends one: an answer to each would take the time in which the next fragments are received."""
    network = Network()
    a, b, writer, reader, got = met(network)
    payload, head = sample(0, 50 * FRAGMENT), encode_header(a.core.prefix)
    for fragment in range(1, 51):
        piece = encode_data_frag(reader.entity, writer.entity, 1, fragment, FRAGMENT, payload)
        beat = encode_heartbeat(reader.entity, writer.entity, 1, 1, 100 + fragment)
        b.core.receive(network.now, head + b"".join(piece), a.default)
        b.core.receive(network.now, head + beat, a.default)
        network.run(0.00005)
    b.call()
    assert numbers(got) == [0]
    answers = network.submessages(AckNack)
    assert [(each.base, each.missing) for each in answers] == [(1, []), (2, [])]
    assert not network.submessages(NackFrag)


def test_a_gap_that_claims_everything_costs_nothing() -> None:
    network = Network()
    a, b, writer, reader, _got = met(network)
    head = encode_header(a.core.prefix)
    for first, base in ((5, 1 << 61), (2, 1 << 61), (1, 300)):
        gap = encode_gap(reader.entity, writer.entity, first, base)
        b.core.receive(network.now, head + gap, a.default)
        assert len(reader.writers[writer.guid].waiting) <= 256
    assert reader.writers[writer.guid].next <= 1 << 61


def test_a_sample_that_claims_to_be_huge_costs_what_came_of_it() -> None:
    network = Network()
    a, b, writer, reader, _got = met(network)
    head = encode_header(a.core.prefix)
    for number in range(1, 30):
        piece = encode_data_frag(reader.entity, writer.entity, number, 1, 1024, bytes(5000))
        raw = bytearray(head + b"".join(piece))
        raw[20 + 32 : 20 + 36] = (900_000_000).to_bytes(4, "little")
        b.core.receive(network.now, bytes(raw), a.default)
    proxy = reader.writers[writer.guid]
    # Of the one that is due; what the others claim is more than may wait.
    assert (proxy.bytes, [*proxy.parts]) == (1024, [1])


def test_nonsense_raises_nothing_and_fills_nothing() -> None:
    network = Network()
    network.faults = Faults(every=9)
    a, b, writer, _reader, _got = met(network)
    latched = a.writer("rt/latched", LATCHED)
    a.put(latched, sample(1, 3 * FRAGMENT))
    b.reader("rt/latched", LATCHED)
    for number in range(30):
        a.put(writer, sample(number, 1000), (bytes(16), 1))
        network.run(0.01)
    a.core.remove(network.now, a.writer("rt/gone"))
    network.run(1)
    a.core.goodbye()
    recorded = [raw for _, raw, _ in network.sent if raw[8:20] == a.core.prefix]
    dice = random.Random(1)
    for count in range(20_000):
        raw = bytearray(dice.choice(recorded))
        for _ in range(dice.randint(1, 6)):
            at = dice.randrange(20 if dice.random() < 0.9 else 0, min(len(raw), 200))
            raw[at] = dice.choice((0, 1, 0x7F, 0x80, 0xFF, dice.randrange(256)))
        if dice.random() < 0.2:
            del raw[dice.randrange(len(raw)) :]
        b.core.receive(network.now, bytes(raw), a.default)
        b.call()
        if count % 100 == 0:
            network.run(0.01)
    assert b.core.nonsense > 1000
    c, _d = pair(network)
    _, heard = b.reader("rt/new", ALL)
    new = c.writer("rt/new", ALL)
    network.run(3)
    c.put(new, sample(7))
    network.run(1)
    assert numbers(heard) == [7]
