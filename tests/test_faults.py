"""Faults on a network in memory: what arrives, when, and that one fault changes nothing of another's draws."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable
from typing import Any

import pytest

from robolink.faults import FaultyNetwork, FaultyTransport, MessageFault, Partition, Why
from robolink.faults.streams import uniform
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport.base import Sample
from robolink.transport.memory import Bus
from robolink.wire import (
    DataKey,
    EndpointKind,
    EndpointToken,
    NodeToken,
    attachments,
    format_key,
    format_token,
    gid_of,
)

QOS = QoSProfile(depth=10)
HASH = "RIHS01_" + "0" * 64
MS = 1_000_000


class Timeline:
    """Time that a test lets pass."""

    def __init__(self) -> None:
        self.now, self._serial = 1_000 * MS, itertools.count()
        self._acts: list[tuple[int, int, Callable[[], object]]] = []

    def steady(self) -> int:
        return self.now

    def at(self, time_ns: int, act: Callable[[], object]) -> None:
        heapq.heappush(self._acts, (time_ns, next(self._serial), act))

    def go_on(self, seconds: float) -> None:
        end = self.now + round(seconds * 1e9)
        while self._acts and self._acts[0][0] <= end:
            self.now, _, act = heapq.heappop(self._acts)
            act()
        self.now = end


class Program:
    """A program with one node, which talks without robolink's own classes."""

    def __init__(self, system: System, name: str) -> None:
        self.system, self.name = system, name
        self.session = FaultyTransport(system.network, name)
        self.session.announce(format_token(NodeToken(0, self.session.session_id, "0", "/", "/", name)))
        self._ids = itertools.count(1)

    def publisher(self, topic: str, qos: QoSProfile = QOS) -> Callable[[int], None]:
        outlet, attach = self.session.advertise(key(topic), qos), self._attachments(topic, EndpointKind.PUBLISHER)
        return lambda number: outlet.put(b"%d" % number, attach())

    def client(self, service: str) -> Callable[[bytes], list[Any]]:
        attach = self._attachments(service, EndpointKind.CLIENT)

        def ask(payload: bytes) -> list[Any]:
            answers: list[Any] = []
            answered = self.session.call(key(service), payload, attach(), answers.append)
            self.system.held.append(answered)
            return answers

        return ask

    def hear(self, topic: str, qos: QoSProfile = QOS) -> list[tuple[float, int]]:
        heard: list[tuple[float, int]] = []

        def note(sample: Sample) -> None:
            heard.append((round((self.system.time.now - 1_000 * MS) / 1e9, 6), int(sample.payload)))

        self.session.subscribe(key(topic), qos, note)
        return heard

    def serve(self, service: str, *, at_once: bool = True) -> list[Any]:
        asked: list[Any] = []

        def answer(query: Any) -> None:
            asked.append(query.payload)
            query.reply(query.payload.upper(), query.attachment)
            query.close()

        self.session.serve(key(service), answer if at_once else asked.append)
        return asked

    def _attachments(self, name: str, kind: EndpointKind) -> Callable[[], bytes]:
        session, number = self.session.session_id, next(self._ids)
        token = format_token(
            EndpointToken(
                0, session, "0", str(number), kind, "/", "/", self.name, name, "std_msgs/msg/Int32", HASH, QOS
            )
        )
        self.session.announce(token)
        return attachments(gid_of(token), self.system.time.steady)


class System:
    """Programs on a network with faults."""

    def __init__(self, seed: int = 1) -> None:
        self.time = Timeline()
        self.network = FaultyNetwork(Bus(), self.time, seed=seed)
        self.held: list[Any] = []

    def program(self, name: str) -> Program:
        return Program(self, name)


def key(name: str) -> str:
    return format_key(DataKey(0, name, "std_msgs/msg/Int32", HASH))


def arrived(count: int, *faults: MessageFault | Partition, seed: int = 1, period: float = 0.02) -> list[Any]:
    """Publish numbers on /scan from `world` to `follower`; give when each arrived."""
    system = System(seed)
    for each in faults:
        system.network.add(each)
    heard, publish = system.program("follower").hear("/scan"), system.program("world").publisher("/scan")
    for number in range(count):
        publish(number)
        system.time.go_on(period)
    system.time.go_on(10.0)
    return heard


def numbers(heard: list[tuple[float, int]]) -> list[int]:
    return [number for _, number in heard]


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


def test_a_partition_parts_groups_for_a_while() -> None:
    parted = Partition(between=["world", ["viewer", "follower"]], after=0.02, until=0.06)
    assert numbers(arrived(5, parted)) == [0, 3, 4]
    assert numbers(arrived(3, Partition(between=["world", "viewer"]))) == [0, 1, 2]
    assert numbers(arrived(3, Partition(between=["world", "**"]))) == []


def ask(fault: MessageFault | Partition) -> tuple[list[Any], list[Any], System]:
    system = System()
    system.network.add(fault)
    asked = system.program("server").serve("/reset")
    return asked, system.program("caller").client("/reset")(b"now"), system


def test_a_request_comes_late_and_so_does_its_answer() -> None:
    asked, answers, system = ask(MessageFault(service="/reset", latency=0.1))
    assert (asked, answers) == ([], [])
    system.time.go_on(0.15)
    assert (asked, answers) == ([b"now"], [])
    system.time.go_on(0.1)
    assert [each and each.payload for each in answers] == [b"NOW", None]


@pytest.mark.parametrize(("way", "heard"), [("caller", []), ("server", [b"now"])])
def test_who_asks_waits_when_its_request_or_the_answer_is_lost(way: str, heard: list[bytes]) -> None:
    asked, answers, system = ask(MessageFault(service="/reset", from_=way, loss=1.0))
    system.time.go_on(100.0)
    assert asked == heard
    assert answers == []


def test_who_asks_is_told_when_the_server_that_was_not_reached_goes() -> None:
    system = System()
    system.network.add(Partition(between=["server", "caller"]))
    server = system.program("server")
    server.serve("/reset")
    answers = system.program("caller").client("/reset")(b"now")
    assert answers == []
    server.session.close()
    assert answers == [None]


def test_a_fault_on_a_topic_is_none_on_a_service() -> None:
    _, answers, _ = ask(MessageFault(topic="**", loss=1.0))
    assert len(answers) == 2
    _, answers, _ = ask(MessageFault(loss=1.0))
    assert answers == []


def test_a_call_is_never_doubled() -> None:
    asked, answers, _ = ask(MessageFault(duplication=1.0))
    assert (len(asked), len(answers)) == (1, 2)


def test_a_report_counts_what_was_done() -> None:
    system = System()
    report = system.network.add(MessageFault(topic="/scan", loss=0.5, latency=0.1, after=1.0))
    system.program("follower").hear("/scan")
    publish = system.program("world").publisher("/scan")
    publish(0)
    system.time.go_on(1.0)
    for number in range(100):
        publish(number)
    assert report.met == 100
    assert report.lost + report.late == 100
    expected = f"{{topic: /scan, loss: 0.5, latency: 0.1, after: 1}}: {report.lost} lost, {report.late} late of 100"
    assert str(report) == expected


def test_a_fault_that_met_nothing_is_told_with_the_nearest_name() -> None:
    system = System()
    for fault in (MessageFault(topic="/scann", loss=0.5), MessageFault(from_="follower", to="world", loss=0.5)):
        system.network.add(fault)
    system.program("follower").hear("/scan")
    system.program("world").publisher("/scan")(1)
    system.time.go_on(0.1)
    assert [each.text for each in system.network.unmet()] == [
        "{topic: /scann, loss: 0.5} met nothing: no topic '/scann' was received by any node (did you mean '/scan'?)",
        (
            "{from: follower, to: world, loss: 0.5} met nothing: nothing went that way"
            " (what stays within a process never travels)"
        ),
    ]
    assert [each.why for each in system.network.unmet()] == [Why.WRONG_NAME, Why.IN_VAIN]
