"""Faults on a network in memory: what arrives, when, and that one fault changes nothing of another's draws."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from robolink.faults import MessageFault, Partition
from robolink.faults.network import uniform
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.wire import (
    NodeToken,
    format_token,
)
from tests.support.faulty import QOS, System, arrived, key, numbers


def test_without_faults_all_arrive_at_once() -> None:
    assert arrived(3) == [(0.0, 0), (0.02, 1), (0.04, 2)]


def test_a_topic_without_faults_passes_through_no_code_of_theirs() -> None:
    system = System()
    system.network.add(MessageFault(topic="/odom", loss=1.0))
    taken: list[Any] = []
    follower = system.program("follower")
    follower.session.subscribe(key("/scan"), QOS, taken.append)
    (subscription,) = system.network.bus.subscriptions[key("/scan")]
    assert subscription.sink == taken.append
    system.network.add(MessageFault(topic="/scan", loss=1.0))
    assert subscription.sink != taken.append
    system.network.clear()
    assert subscription.sink == taken.append


def test_loss_is_a_share_of_all_messages() -> None:
    assert 0.18 < 1 - len(arrived(5000, MessageFault(loss=0.2))) / 5000 < 0.22


def test_more_loss_takes_more_of_the_same() -> None:
    few, many = (set(numbers(arrived(500, MessageFault(loss=loss)))) for loss in (0.1, 0.3))
    assert many < few


def test_bursts_are_as_long_on_average_as_was_said() -> None:
    heard = set(numbers(arrived(20000, MessageFault(loss=0.2, burst=5.0))))
    lost = [number not in heard for number in range(20000)]
    runs = [len(list(group)) for is_lost, group in itertools.groupby(lost) if is_lost]
    assert 0.17 < sum(lost) / len(lost) < 0.23
    assert 4.4 < sum(runs) / len(runs) < 5.6


def test_latency_is_for_all_alike() -> None:
    assert arrived(3, MessageFault(latency=0.05)) == [(0.05, 0), (0.07, 1), (0.09, 2)]


def test_latencies_of_several_faults_add_up() -> None:
    assert arrived(1, MessageFault(latency=0.05), MessageFault(topic="scan", latency=0.02)) == [(0.07, 0)]


def test_jitter_spreads_evenly_about_the_latency_and_keeps_the_order() -> None:
    heard = arrived(2000, MessageFault(latency=0.005, jitter=0.004))
    late = [time - number * 0.02 for time, number in heard]
    assert numbers(heard) == list(range(2000))
    assert 0.001 <= min(late) < 0.0012
    assert 0.0088 < max(late) <= 0.009
    assert abs(sum(late) / len(late) - 0.005) < 0.0003


def test_more_jitter_than_time_between_messages_keeps_the_order_unless_asked() -> None:
    kept = arrived(500, MessageFault(latency=0.2, jitter=0.2))
    assert numbers(kept) == list(range(500))
    mixed = arrived(500, MessageFault(latency=0.2, jitter=0.2, reorder=True))
    assert numbers(mixed) != list(range(500))
    assert sorted(numbers(mixed)) == list(range(500))


def test_nothing_overtakes_what_is_still_on_its_way_when_a_fault_ends() -> None:
    heard = arrived(4, MessageFault(latency=0.1, until=0.03))
    assert heard == [(0.1, 0), (0.12, 1), (0.12, 2), (0.12, 3)]


def test_duplication_sends_a_copy() -> None:
    heard = arrived(1000, MessageFault(duplication=0.1))
    doubled = len(heard) - 1000
    assert 70 < doubled < 130
    assert sorted(set(numbers(heard))) == list(range(1000))


def test_a_fault_holds_from_and_until() -> None:
    assert numbers(arrived(5, MessageFault(loss=1.0, after=0.02, until=0.06))) == [0, 3, 4]


def test_faults_by_sender_and_receiver() -> None:
    assert numbers(arrived(2, MessageFault(from_="world", to="follower", loss=1.0))) == []
    assert numbers(arrived(2, MessageFault(from_="follower", to="world", loss=1.0))) == [0, 1]
    assert numbers(arrived(2, MessageFault(from_=["x", "wor*"], loss=1.0))) == []


def test_a_fault_finds_a_program_by_the_names_of_its_nodes() -> None:
    system = System()
    system.network.add(MessageFault(from_="ada/lidar", loss=1.0))
    world, heard = system.program("world"), system.program("follower").hear("/scan")
    publish = world.publisher("/scan")
    publish(0)
    world.session.announce(format_token(NodeToken(0, world.session.session_id, "1", "/", "/ada", "lidar")))
    publish(1)
    assert numbers(heard) == [0]


def test_what_stays_within_a_program_meets_no_fault() -> None:
    system = System()
    report = system.network.add(MessageFault(loss=1.0))
    world = system.program("world")
    heard, publish = world.hear("/scan"), world.publisher("/scan")
    publish(0)
    assert numbers(heard) == [0]
    assert report.met == 0


@pytest.mark.parametrize(
    "other",
    [
        MessageFault(topic="/odom", loss=0.5),
        MessageFault(from_="world", latency=0.01, jitter=0.01),
        MessageFault(loss=0.3),
        MessageFault(from_="follower", duplication=0.5),
        Partition(between=["world", "x"]),
    ],
)
def test_one_fault_more_changes_no_others_draws(other: MessageFault | Partition) -> None:
    lossy = MessageFault(topic="/scan", loss=0.2)
    alone = set(numbers(arrived(300, lossy)))
    only_other = set(numbers(arrived(300, other)))
    for faults in ((lossy, other), (other, lossy)):
        assert set(numbers(arrived(300, *faults))) == alone & only_other


def test_a_fault_that_is_added_meanwhile_leaves_the_others_where_they_were() -> None:
    def losses(add_at: int) -> list[int]:
        system = System()
        system.network.add(MessageFault(topic="/scan", loss=0.3))
        heard, publish = system.program("follower").hear("/scan"), system.program("world").publisher("/scan")
        for number in range(200):
            if number == add_at:
                system.network.add(MessageFault(topic="/odom", loss=0.5))
            publish(number)
        return numbers(heard)

    assert losses(100) == losses(-1)


def test_a_seed_decides_all() -> None:
    fault = MessageFault(loss=0.3, jitter=0.01, duplication=0.1)
    assert arrived(200, fault, seed=5) == arrived(200, fault, seed=5)
    assert arrived(200, fault, seed=5) != arrived(200, fault, seed=6)


def test_the_numbers_of_a_stream_are_the_same_everywhere() -> None:
    draw = uniform(3, "a", "b")
    assert [draw() for _ in range(3)] == NUMBERS_OF_3_A_B


NUMBERS_OF_3_A_B = [0.8509877529841602, 0.4015259553540097, 0.8311597442916506]


def test_all_ears_of_a_program_hear_the_same() -> None:
    system = System()
    system.network.add(MessageFault(loss=0.5))
    follower, publish = system.program("follower"), system.program("world").publisher("/scan")
    first, second, other = follower.hear("/scan"), follower.hear("/scan"), system.program("viewer").hear("/scan")
    for number in range(200):
        publish(number)
    assert first == second
    assert first != other


def test_a_late_joiner_gets_what_was_kept_as_late_as_all_else() -> None:
    system = System()
    system.network.add(MessageFault(latency=0.5))
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    system.program("world").publisher("/map", latched)(7)
    heard = system.program("viewer").hear("/map", latched)
    assert heard == []
    system.time.go_on(1.0)
    assert heard == [(0.5, 7)]


def test_nothing_arrives_at_a_program_that_is_gone_by_then() -> None:
    system = System()
    system.network.add(MessageFault(latency=0.5))
    follower, publish = system.program("follower"), system.program("world").publisher("/scan")
    heard = follower.hear("/scan")
    publish(1)
    follower.session.close()
    system.time.go_on(1.0)
    assert heard == []
