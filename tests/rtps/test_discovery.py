"""Who is met, for how long, and what is known of whose endpoints, in virtual time."""

from __future__ import annotations

import itertools

import pytest

from robolink.rtps import Qos, ids
from robolink.rtps.discovery import MOST_PEERS
from robolink.rtps.submessages import (
    AckNack,
    Data,
    Heartbeat,
    InfoTimestamp,
    encode_data,
    encode_header,
    encode_heartbeat,
    parse,
)
from tests.support.rtps_network import HOST, Faults, Network, numbers, sample

MADE_UP_WITHIN = 0.5
"""Seconds in which two participants meet, and have what is latched, although datagrams were lost."""


def announcements(network: Network) -> int:
    return sum(
        isinstance(each, Data) and each.writer == ids.SPDP_WRITER
        for _, raw, _ in network.sent
        for each in parse(raw).submessages
    )


@pytest.mark.parametrize("vendor", ["ours", "fastdds", "cyclone"])
def test_participants_and_their_endpoints_are_known_within_a_tenth_of_a_second(vendor: str) -> None:
    network = Network()
    members = [network.join(vendor) for _ in range(10)]
    for member in members:
        for number in range(10):
            member.writer(f"rt/w{number}")
            member.reader(f"rt/r{number}")
    assert network.run(0.1, until=lambda: all(len(member.core.endpoints()) == 180 for member in members))
    assert all(member.core.is_settled() for member in members)


def test_a_reader_greets_each_vendor_as_that_one_answers_at_once() -> None:
    # Fast DDS answers only base 0 at once, else its next heartbeat comes after 3 s; Cyclone takes 0 for malformed.
    for vendor, base in (("fastdds", 0), ("cyclone", 1)):
        network = Network()
        us, other = network.join(), network.join(vendor)
        other.writer()
        us.reader()
        network.run(1)
        greetings = [
            each
            for _, raw, _ in network.sent
            if raw[8:20] == us.core.prefix
            for each in parse(raw).submessages
            if isinstance(each, AckNack) and not each.missing and not each.final
        ]
        assert len({each.writer for each in greetings}) == 3  # publications, subscriptions, the topic
        assert {each.base for each in greetings} == {base}


def _has(raw: bytes, kind: type) -> bool:
    return any(isinstance(each, kind) for each in parse(raw).submessages)


def test_a_writer_that_never_answers_is_asked_ever_more_rarely() -> None:
    network = Network()
    us, other = network.join(), network.join()
    other.writer()
    us.reader()
    network.faults = Faults(is_lost=lambda raw, address: _has(raw, Heartbeat) and address == us.default)
    network.run(120)
    asked = [each for each in network.submessages(AckNack) if each.writer[3] == ids.KEYLESS_WRITER]
    assert 8 < len(asked) < 16


def test_a_participant_that_did_not_listen_yet_is_told_again_when_it_announces_itself() -> None:
    network = Network()
    us = network.join()
    network.run(2)
    other = network.join("fastdds")
    deaf_until = network.now + 0.05
    network.faults = Faults(is_lost=lambda raw, address: address == other.metatraffic and network.now < deaf_until)
    assert network.run(0.3, until=lambda: bool(other.core.peers()) and bool(us.core.peers()))


def test_two_that_do_not_know_that_they_are_known_do_not_answer_each_other_without_end() -> None:
    network = Network()
    a, b = network.join(), network.join()
    network.faults = Faults(is_lost=lambda raw, address: ids.SPDP_WRITER not in raw)
    network.run(1)
    assert a.core.peers()
    assert b.core.peers()
    assert sum(address in (a.metatraffic, b.metatraffic) for _, _, address in network.sent) < 300


def test_samples_of_discovery_have_source_timestamps_that_rise_with_their_numbers() -> None:
    """Fast DDS sorts what waits for an earlier sample by them, that of all participants together."""
    network = Network()
    us, other = network.join(), network.join()
    writers = [us.writer(f"rt/w{number}") for number in range(3)]
    assert network.run(1, until=lambda: len(other.core.endpoints()) == 3)
    us.core.remove(network.now, writers[0])
    us.writer("rt/w3")
    network.run(1)
    stamps: dict[int, int] = {}
    for _, raw, _ in network.sent:
        stamp = 0
        for each in parse(raw).submessages:
            if isinstance(each, InfoTimestamp):
                stamp = each.timestamp
            elif isinstance(each, Data) and each.writer == ids.PUBLICATIONS_WRITER:
                assert stamps.setdefault(each.number, stamp) == stamp
    assert sorted(stamps) == [1, 2, 3, 4, 5]
    assert 0 < stamps[1] <= stamps[2] <= stamps[3] < stamps[4] <= stamps[5]


def _meet(losses: tuple[int, ...] = ()) -> int:
    """Let two meet while datagrams with these numbers are lost; return how many there were."""
    network = Network()
    members = [network.join(), network.join()]
    got = []
    for member, other in zip(members, reversed(members), strict=True):
        member.put(member.writer(f"rt/{members.index(member)}", Qos(depth=1, transient_local=True)), sample(7))
        got.append(member.reader(f"rt/{members.index(other)}", Qos(depth=1, transient_local=True))[1])
    known = {each for member in members for each in (member.metatraffic, member.default)}
    count = itertools.count()
    network.faults = Faults(is_lost=lambda raw, address: address in known and next(count) in losses)
    assert network.run(MADE_UP_WITHIN, until=lambda: all(numbers(each) == [7] for each in got)), losses
    return next(count)


def test_any_two_datagrams_that_are_lost_while_two_meet_are_made_up_soon() -> None:
    for losses in itertools.combinations(range(-1, _meet()), 2):  # -1: only one of them
        _meet(losses)


def test_samples_that_come_before_their_writer_is_known_are_not_lost() -> None:
    network = Network()
    a, b = network.join(), network.join()
    network.run(2)
    network.faults = Faults(is_lost=lambda raw, address: ids.PUBLICATIONS_WRITER in raw)
    writer = a.writer(qos=Qos(depth=0))
    _, got = b.reader(qos=Qos(depth=0))
    network.run(1)
    assert writer.readers  # it knows the reader, which does not know it
    for number in range(5):
        a.put(writer, sample(number))
    network.run(1)
    assert not got
    network.faults = Faults()
    network.run(3)
    assert numbers(got) == [0, 1, 2, 3, 4]


def test_endpoints_that_went_do_not_come_back_by_a_repair() -> None:
    for seed in range(20):
        network = Network(seed)
        a, b = network.join(), network.join()
        network.faults = Faults(loss=0.3, jitter=0.01)
        network.run(1)
        kept = []
        for number in range(20):
            writer = a.writer(f"rt/{number}")
            network.run(0.005)
            if number % 2:
                a.core.remove(network.now, writer)
            else:
                kept.append(writer.guid)
        network.run(20)
        assert sorted(endpoint.guid for endpoint in b.core.endpoints()) == sorted(kept)
        came_and_went = {endpoint.guid: came for endpoint, came in b.found}
        assert [guid for guid, came in came_and_went.items() if came] == kept


def test_what_is_announced_of_endpoints_that_went_is_not_kept() -> None:
    network = Network()
    a, b = network.join(), network.join()
    network.run(1)
    for number in range(50):
        a.core.remove(network.now, a.writer(f"rt/{number}"))
        network.run(0.01)
    network.run(1)
    assert a.core._discovery.writers[True]._history == {}
    assert not b.core.endpoints()


def test_a_reader_and_a_writer_that_close_are_not_matched_any_more() -> None:
    network = Network()
    a, b = network.join(), network.join()
    writers, readers = [a.writer() for _ in range(3)], [b.reader()[0] for _ in range(3)]
    network.run(1)
    assert [len(writer.readers) for writer in writers] == [3, 3, 3]
    a.core.remove(network.now, writers[0])
    b.core.remove(network.now, readers[0])
    network.run(1)
    assert [len(reader.writers) for reader in readers[1:]] == [2, 2]
    assert [len(writer.readers) for writer in writers[1:]] == [2, 2]
    network.sent.clear()
    network.run(10)
    assert network.is_quiet
    a.core.remove(network.now, writers[0])  # the second time it is nothing


def test_a_writer_whose_reader_closed_without_acknowledging_keeps_nothing_for_it() -> None:
    network = Network()
    a, b = network.join(), network.join()
    writer = a.writer(qos=Qos(depth=0))
    reader, _ = b.reader()
    network.run(1)
    network.faults = Faults(is_lost=lambda raw, address: address == b.default)
    for number in range(5):
        a.put(writer, sample(number))
    assert len(writer._history) == 5
    b.core.remove(network.now, reader)
    network.run(1)
    assert writer._history == {}


def test_a_participant_that_says_goodbye_is_gone_at_once() -> None:
    network = Network()
    a, b = network.join(), network.join()
    writer = a.writer()
    b.reader()
    network.run(1)
    b.leave()
    network.run(0.01)
    assert (a.core.peers(), a.core.endpoints(), writer.readers) == ([], [], {})
    assert a.peers == [(b.core.prefix, True), (b.core.prefix, False)]
    assert [came for _, came in a.found] == [True, False]


@pytest.mark.parametrize("lease", [2.0, 20.0])
def test_a_participant_that_is_killed_is_gone_after_its_lease(lease: float) -> None:
    network = Network()
    a, b = network.join(), network.join(lease=lease)
    b.writer()
    network.run(1)
    b.kill()
    network.run(lease - 1.1)
    assert a.core.peers()
    network.run(1.2)
    assert (a.core.peers(), a.core.endpoints()) == ([], [])


def test_a_lease_ends_when_it_is_due_though_its_length_may_not_come_out_of_a_subtraction() -> None:
    network = Network()
    a, b = network.join(), network.join()
    network.run(1)
    b.kill()
    heard = next(each for each in (100 + n / 10 for n in range(1, 1000)) if (each + 20.0) - each < 20.0)
    a.core._discovery.peers[b.core.prefix].heard = heard
    assert a.core.tick(heard + 20.0) > heard + 20.0  # else it would be called again and again
    assert not a.core.peers()


def test_leases_do_not_end_while_anything_comes() -> None:
    network = Network()
    a, b = network.join(lease=2), network.join(lease=4)
    network.run(60)
    # Announcements come every 3 s: those of a shorter lease do not suffice, but that is what it says of itself.
    assert [came for _, came in a.peers] == [True]
    assert [came for _, came in b.peers][:1] == [True]


def test_a_participant_that_was_restarted_at_the_same_port_replaces_the_one_before() -> None:
    network = Network()
    a, b = network.join(), network.join("fastdds")
    writer = a.writer(qos=Qos(depth=0))
    b.reader()
    network.run(1)
    b.kill()
    a.put(writer, sample(0))
    network.run(0.5)
    c = network.join("fastdds", index=1)
    _, got = c.reader()
    assert network.run(0.5, until=lambda: [peer.prefix for peer in a.core.peers()] == [c.core.prefix])
    network.run(0.5)
    a.put(writer, sample(1))
    network.run(0.5)
    assert numbers(got) == [1]
    assert a.peers == [(b.core.prefix, True), (b.core.prefix, False), (c.core.prefix, True)]


def test_participants_of_one_cyclone_process_share_a_port() -> None:
    network = Network()
    a, b = network.join(), network.join("cyclone")
    c = network.join("cyclone", index=1)
    network.run(5)
    assert {peer.prefix for peer in a.core.peers()} == {b.core.prefix, c.core.prefix}


def test_another_domain_is_not_met() -> None:
    network = Network()
    a, b = network.join(), network.join()
    b.core._discovery._announcement = b.core._discovery._announcement.replace(
        b"\x0f\0\4\0" + bytes(4), b"\x0f\0\4\0\1\0\0\0"
    )
    network.run(2)
    assert not a.core.peers()


def test_more_participants_than_allowed_are_not_met() -> None:
    network = Network()
    us, other = network.join(), network.join()
    announcement = other.core._discovery._announcement

    def come(number: int) -> None:
        raw = announcement.replace(other.core.prefix, ids.VENDOR_ROBOLINK + number.to_bytes(10, "big"))
        port = other.metatraffic[1].to_bytes(4, "little")
        us.core.receive(network.now, raw.replace(port, (20_000 + number).to_bytes(4, "little")), (HOST, 9))

    def talk(number: int) -> None:
        beat = encode_heartbeat(ids.PUBLICATIONS_READER, ids.PUBLICATIONS_WRITER, 1, 0, 1)
        us.core.receive(network.now, encode_header(ids.VENDOR_ROBOLINK + number.to_bytes(10, "big")) + beat, (HOST, 9))

    come(0)
    talk(0)
    for number in range(1, MOST_PEERS + 50):
        come(number)
    # Those that say nothing but that they are there make room: most likely they are not.
    assert len(us.core.peers()) == MOST_PEERS
    assert us.core._discovery.refused == 0
    there = [int.from_bytes(peer.prefix[2:], "big") for peer in us.core.peers()]
    assert there == [0, *range(51, MOST_PEERS + 50)]
    for number in there:
        talk(number)
    for number in range(1, 51):
        come(number)
    assert us.core._discovery.refused == 50
    assert [int.from_bytes(peer.prefix[2:], "big") for peer in us.core.peers()] == there


def test_an_idle_participant_sends_and_wakes_up_a_few_times_a_second() -> None:
    network = Network()
    members = [network.join() for _ in range(3)]
    for member in members:
        member.writer("rt/a")
        member.reader("rt/a")
    network.run(5)
    network.sent.clear()
    before = {member: member.ticks for member in members}
    network.run(60)
    assert network.is_quiet
    assert all(member.ticks - before[member] <= 60 + 20 + 20 for member in members)
    # A search of 31 ports a second, without those who know us; and each of two peers every 3 s.
    assert announcements(network) <= 3 * (61 * 29 + 2 * 21)


def test_a_participant_that_hears_of_itself_does_not_meet_itself() -> None:
    network = Network()
    us = network.join()
    us.core.receive(network.now, us.core._discovery._announcement, us.default)
    assert not us.core.peers()


def test_nothing_of_a_stranger_is_taken_before_it_has_announced_itself() -> None:
    network = Network()
    a, b = network.join(), network.join()
    reader, got = b.reader()
    network.faults = Faults(is_lost=lambda raw, address: True)
    a.writer()
    network.run(1)
    raw = encode_header(a.core.prefix) + encode_data(ids.UNKNOWN_ENTITY, b"\0\0\1\3", 1, sample(1))
    b.core.receive(network.now, raw, a.default)
    b.call()
    assert not got
    assert not reader.writers
