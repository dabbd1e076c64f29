"""Participants across a link that loses frames, in virtual time: what is said of samples that are gone, and repairs."""

from __future__ import annotations

import random

import pytest

from robolink.rtps import Qos
from robolink.rtps.submessages import AckNack, Gap, NackFrag
from robolink.rtps.writer import FRAGMENT
from tests.support.rtps_network import Faults, Network, numbers, sample


def test_a_sample_that_newer_ones_replaced_is_not_told_by_a_gap() -> None:
    """By a heartbeat, which is what readers of Fast DDS need."""
    network = Network()
    a, b = network.join(), network.join()
    writer, (reader, got) = a.writer(qos=Qos(depth=2, transient_local=True)), b.reader(qos=Qos(depth=2))
    assert network.run(5, until=lambda: bool(writer.readers) and bool(reader.writers))
    seen: list[bytes] = []

    def second(raw: bytes, _: object) -> bool:
        seen.append(raw)
        return len(seen) == 2

    network.faults = Faults(is_lost=second, delay=0.05)
    for number in range(6):
        a.put(writer, sample(number, 3 * FRAGMENT))
        network.run(0.02)
    network.run(1, until=lambda: 5 in numbers(got))
    assert numbers(got) == [1, 2, 3, 4, 5]  # sample 0 was replaced before the request for its fragment came
    assert network.submessages(NackFrag)
    assert not network.submessages(Gap)


@pytest.mark.parametrize(("host", "largest"), [("10.0.0.1", 1420 - 28), ("127.0.0.1", 65_507)])
def test_a_datagram_to_another_machine_fits_into_a_frame(host: str, largest: int) -> None:
    """Also through a tunnel (WireGuard: 1420 bytes with the headers of IP and UDP)."""
    network = Network(host=host)
    a, b = network.join(), network.join()
    writer, (reader, got) = a.writer(qos=Qos(depth=0)), b.reader(qos=Qos(depth=0))
    assert network.run(5, until=lambda: bool(writer.readers) and bool(reader.writers))
    network.sent.clear()
    network.faults = Faults(loss=0.3)
    sizes = [12, 1200, 1204, 500, 600, 100_000, *(12 for _ in range(100))]
    for number, size in enumerate(sizes):
        a.put(writer, sample(number, size), related=(reader.guid, number))
    network.run(20, until=lambda: len(got) == len(sizes))
    assert [len(each) for each in got] == sizes
    assert largest / 2 < max(len(raw) for _, raw, _ in network.sent) <= largest


def test_a_lost_sample_that_is_expected_comes_though_its_writer_does_not_remind(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A Fast DDS reminds its readers every 3 s: by then a service's caller may have given up."""
    network = Network()
    a, b = network.join(), network.join("fastdds")
    reader, got = a.reader(qos=Qos())
    writer = b.writer(qos=Qos())
    assert network.run(5, until=lambda: bool(writer.readers) and reader.writers[writer.guid].is_known)
    monkeypatch.setattr(writer, "_expect", lambda *_: None)
    network.faults = Faults(is_lost=lambda raw, address: sample(7) in raw)
    a.core.expect(network.now, reader)
    b.put(writer, sample(7))
    network.faults = Faults()
    network.sent.clear()
    network.run(0.15, until=lambda: bool(got))
    assert numbers(got) == [7]
    network.sent.clear()
    network.run(10)
    assert not [nack for nack in network.submessages(AckNack) if nack.writer == writer.entity and not nack.final]


def test_what_never_comes_is_asked_for_a_few_times_only() -> None:
    network = Network()
    a, b = network.join(), network.join()
    reader, _ = a.reader(qos=Qos())
    writer = b.writer(qos=Qos())
    assert network.run(5, until=lambda: bool(writer.readers) and reader.writers[writer.guid].is_known)
    network.sent.clear()
    a.core.expect(network.now, reader)
    network.run(60)
    assert len([nack for nack in network.submessages(AckNack) if not nack.final]) == 6


@pytest.mark.parametrize("loss", [0.01, 0.03])
def test_large_samples_cross_a_link_that_loses_frames_without_a_storm_of_repairs(loss: float) -> None:
    network = Network(host="10.0.0.1")
    a, b = network.join(), network.join()
    writer, (reader, got) = a.writer(qos=Qos()), b.reader(qos=Qos())
    assert network.run(5, until=lambda: bool(writer.readers) and bool(reader.writers))
    network.sent.clear()
    dice = random.Random(1)

    def is_lost(raw: bytes, _: object) -> bool:
        frames = -(-len(raw) // 1480)
        return any(dice.random() < loss for _ in range(frames))

    network.faults = Faults(delay=0.005, is_lost=is_lost)
    for number in range(20):
        a.put(writer, sample(number, 300_000))
        network.run(0.1)
    network.run(2, until=lambda: len(got) == 20)
    assert numbers(got) == list(range(20))
    least = 20 * 300_000 * (1 + 0.1)  # with headers
    assert sum(len(raw) for _, raw, _ in network.sent) < least * (1 + 2 * loss)
