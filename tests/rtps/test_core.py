"""Participants among themselves in virtual time: what arrives, whatever the network does."""

from __future__ import annotations

import pytest

from robolink.rtps import Qos, ids
from robolink.rtps.core import LocalReader, LocalWriter
from robolink.rtps.submessages import AckNack, Data, DataFrag, Gap, Heartbeat, NackFrag
from robolink.rtps.writer import FRAGMENT
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


def test_a_late_best_effort_reader_gets_the_latched_samples() -> None:
    network = Network()
    a, b = pair(network)
    writer = a.writer(qos=Qos(transient_local=True, depth=3))
    for number in range(5):
        a.put(writer, sample(number, 100_000 if number == 4 else 12))
    _, got = b.reader(qos=Qos(reliable=False, transient_local=True))
    network.run(2)
    assert numbers(got) == [2, 3, 4]


def test_samples_beyond_the_depth_are_skipped_by_a_reader_that_lost_them() -> None:
    network = Network()
    a, _, writer, _, got = met(network, Qos(depth=3))
    network.faults = Faults(is_lost=lambda raw, address: True)
    for number in range(10):
        a.put(writer, sample(number))
    network.run(0.3)
    network.faults = Faults()
    network.run(3)
    assert numbers(got) == [7, 8, 9]


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
