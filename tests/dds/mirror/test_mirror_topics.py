"""Topics through a mirror between two networks in memory, in virtual time, in whatever order ends come and go."""

from __future__ import annotations

from typing import Any

import pytest

from robolink import Node
from robolink.dds.mirror.crossing import KNOWN_WITHIN
from robolink.dds.mirror.mirror import LINGER
from robolink.interfaces.std_msgs.msg import Int32
from robolink.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from robolink.transport.base import Handle
from robolink.wire import DataKey, format_key, format_token, pack_attachment
from tests.support.mirrored import Half, Mirrored, crossings, heard, packed, raw_tokens, send

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def test_what_is_published_arrives_once(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    got, echo = heard(there.node("listener")), heard(here.node("beside"))
    publisher = here.node("talker").create_publisher(Int32, "chatter", 10)
    scene.until(lambda: publisher.get_subscription_count() == 2)
    send(publisher, 1, 2, 3)
    scene.run(0.5)
    assert got == echo == [1, 2, 3]


def test_the_first_message_of_a_publisher_that_waited_for_somebody_arrives(pair: tuple[Mirrored, Half, Half]) -> None:
    """What `topic pub --once` does: the message comes before the mirror knows the publisher."""
    scene, here, there = pair
    got = heard(there.node("listener"))
    scene.run(0.1)
    talker = here.node("talker")
    publisher = talker.create_publisher(Int32, "chatter", 10)
    assert publisher.get_subscription_count() == 1
    send(publisher, 7)
    talker.destroy_node()
    scene.run(0.5)
    assert got == [7]


def test_nothing_flows_while_nobody_subscribes(joined: Mirrored) -> None:
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", 10)
    joined.run(0.1)
    assert not publisher._is_heard_
    listener = joined.b.node("listener")
    got = heard(listener)
    joined.until(lambda: publisher._is_heard_)
    send(publisher, 1)
    joined.until(lambda: got)
    assert joined.mirror is not None
    assert joined.mirror.count().topics == 1
    listener.destroy_node()
    joined.until(lambda: not publisher._is_heard_)
    assert joined.mirror.count().topics == 0


def test_nothing_is_there_before_the_mirror_and_all_of_it_afterwards(scene: Mirrored) -> None:
    got = heard(scene.b.node("listener"))
    publisher = scene.a.node("talker").create_publisher(Int32, "chatter", 10)
    send(publisher, 1)
    scene.run(0.3)
    assert got == []
    for value in (2, 3):  # a mirror that went, and another one
        scene.join()
        scene.until(lambda: publisher.get_subscription_count() == 1)
        send(publisher, value)
        scene.run(0.1)
        scene.part()
        assert publisher.get_subscription_count() == 0
    assert got == [2, 3]


def test_publishers_stay_apart_with_their_numbers_and_times(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    received: list[Any] = []
    listener = there.node("listener")
    listener.create_subscription(Int32, "chatter", lambda m, info: received.append((m.data, info)), 10)
    publishers = [here.node(f"talker{number}").create_publisher(Int32, "chatter", 10) for number in range(3)]
    scene.until(lambda: all(each.get_subscription_count() for each in publishers))
    for turn in range(4):
        for number, each in enumerate(publishers):
            send(each, 10 * number + turn)
        scene.run(0.1)
    assert sorted(value for value, _ in received) == [10 * number + turn for number in range(3) for turn in range(4)]
    by_gid: dict[bytes, list[tuple[int, int]]] = {}
    for value, info in received:
        by_gid.setdefault(bytes(info["publisher_gid"]["data"]), []).append((value, info["publication_sequence_number"]))
    numbers = sorted(by_gid.values())
    assert numbers == [[(10 * number + turn, turn + 1) for turn in range(4)] for number in range(3)]
    infos = listener.get_publishers_info_by_topic("/chatter")
    assert {bytes(each.endpoint_gid) for each in infos} == set(by_gid)
    assert {each.node_name for each in infos} == {"talker0", "talker1", "talker2"}
    times = [info["source_timestamp"] for _, info in received]
    assert times == sorted(times)
    assert times[0] < times[-1]


def test_both_ways_on_one_topic_and_no_echo(joined: Mirrored) -> None:
    ends = [(half.node(f"node{number}"), half) for number, half in enumerate(joined.halves)]
    got = [heard(node) for node, _ in ends]
    publishers = [node.create_publisher(Int32, "chatter", 10) for node, _ in ends]
    joined.until(lambda: all(each.get_subscription_count() == 2 for each in publishers))
    for value, each in enumerate(publishers):
        send(each, value)
    joined.run(KNOWN_WITHIN + 0.5)
    assert [sorted(each) for each in got] == [[0, 1], [0, 1]]


def test_a_latched_message_reaches_who_comes_late_once(pair: tuple[Mirrored, Half, Half]) -> None:
    scene, here, there = pair
    publisher = here.node("map_server").create_publisher(Int32, "map", LATCHED)
    send(publisher, 1, 2)
    scene.run(0.3)
    first = heard(there.node("first"), "map", LATCHED)
    scene.until(lambda: first == [2])
    second = heard(there.node("second"), "map", LATCHED)
    scene.until(lambda: second == [2])
    send(publisher, 3)
    scene.run(0.1)
    third = heard(there.node("third"), "map", LATCHED)
    scene.run(0.5)
    assert (first, second, third) == ([2, 3], [2, 3], [3])


def test_a_latched_message_that_was_published_while_nobody_listened_replaces_the_older(joined: Mirrored) -> None:
    publisher = joined.a.node("map_server").create_publisher(Int32, "map", LATCHED)
    send(publisher, 1)
    first = joined.b.node("first")
    got = heard(first, "map", LATCHED)
    joined.until(lambda: got == [1])
    first.destroy_node()
    joined.run(0.5)
    send(publisher, 2)
    joined.run(0.1)
    late = heard(joined.b.node("late"), "map", LATCHED)
    joined.run(0.5)
    assert late == [2]


def test_latched_and_volatile_publishers_of_one_topic(joined: Mirrored) -> None:
    latched = joined.a.node("latched").create_publisher(Int32, "chatter", LATCHED)
    send(latched, 1)
    got = heard(joined.b.node("listener"), qos=QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    joined.until(lambda: got == [1])
    volatile = joined.a.node("volatile").create_publisher(Int32, "chatter", 10)
    joined.until(lambda: volatile.get_subscription_count() == 1)
    send(volatile, 2)
    send(latched, 3)
    joined.run(0.3)
    assert sorted(got) == [1, 2, 3]


def test_a_publisher_that_comes_back_within_a_moment(joined: Mirrored) -> None:
    got = heard(joined.b.node("listener"))
    for value in range(5):
        talker = joined.a.node("talker")
        publisher = talker.create_publisher(Int32, "chatter", 10)
        joined.run(LINGER / 5)
        send(publisher, value)
        talker.destroy_node()
    joined.run(1.0)
    assert got == list(range(5))


def test_a_publisher_that_stays_idle_costs_nothing_but_comes_when_it_is_wanted_again(joined: Mirrored) -> None:
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", 10)
    numbers = []
    for value in range(4):
        listener = joined.b.node(f"listener{value}")
        got = heard(listener)
        joined.until(lambda: publisher.get_subscription_count() == 1)
        send(publisher, value)
        joined.until(lambda got=got: got)  # type: ignore[misc]
        numbers += got
        listener.destroy_node()
        joined.until(lambda: publisher.get_subscription_count() == 0)
    assert numbers == [0, 1, 2, 3]


def test_a_latched_subscription_beside_a_volatile_one_gets_what_was_before(joined: Mirrored) -> None:
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", LATCHED)
    send(publisher, 1)
    volatile = heard(joined.b.node("volatile"))
    joined.run(0.2)
    latched = heard(joined.b.node("latched"), qos=LATCHED)
    joined.until(lambda: latched == [1])
    send(publisher, 2)
    joined.run(2.0)
    assert latched == [1, 2]
    assert volatile[-1] == 2
    assert len(volatile) == len(set(volatile))


@pytest.mark.parametrize("order", [[False, True], [True, False]])
def test_a_reliable_subscription_is_not_fed_by_that_of_a_best_effort_one(
    joined: Mirrored, monkeypatch: pytest.MonkeyPatch, order: list[bool]
) -> None:
    source, feeding = joined.transports[0], []
    subscribe = source.subscribe

    def spy(key: str, qos: QoSProfile, sink: Any) -> Handle:
        if "/chatter/" in key:
            feeding.append(qos.reliability)
        return subscribe(key, qos, sink)

    monkeypatch.setattr(source, "subscribe", spy)
    nodes = {is_reliable: joined.b.node("reliable" if is_reliable else "hasty") for is_reliable in order}
    publisher = joined.a.node("talker").create_publisher(Int32, "chatter", 10)
    got = {}
    for is_reliable in order:
        policy = ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT
        got[is_reliable] = heard(nodes[is_reliable], qos=QoSProfile(depth=10, reliability=policy))
        joined.run(0.1)
    assert feeding.pop() is ReliabilityPolicy.RELIABLE
    nodes[True].destroy_node()
    joined.run(2.0)
    assert feeding.pop() is ReliabilityPolicy.BEST_EFFORT
    send(publisher, 1)
    joined.until(lambda: got[False] == [1])


@pytest.mark.parametrize("qos", [10, QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)])
def test_who_stays_misses_and_repeats_nothing(pair: tuple[Mirrored, Half, Half], qos: Any) -> None:
    scene, here, there = pair
    publisher = here.node("talker").create_publisher(Int32, "chatter", qos)
    first = there.node("first")  # the one that feeds the mirror goes while the others stay
    heard(first, qos=LATCHED)
    stays = heard(there.node("stays"), qos=QoSProfile(depth=100))
    scene.until(lambda: publisher.get_subscription_count() == 2)
    others: list[Node] = [first]
    for value in range(60):
        send(publisher, value)
        scene.turn()
        if value % 5 == 0:
            others.append(there.node(f"other{value}"))
            heard(others[-1], qos=LATCHED if value % 2 else QoSProfile(depth=3))
        elif value % 5 == 3:
            others.pop(0).destroy_node()
    scene.run(0.5)
    assert stays == list(range(60))


def test_a_publisher_whose_gid_is_not_that_of_its_token(joined: Mirrored) -> None:
    """What zenoh-ros2-sdk has: its samples are its own, since no other publisher of the topic is without any."""
    got = heard(joined.b.node("listener"))
    usual = joined.a.node("talker").create_publisher(Int32, "chatter", 10)
    session = joined.a.session()
    token = raw_tokens(session.session_id)[0]
    outlet = session.advertise(format_key(DataKey(0, token.name, token.type_name, token.type_hash)), token.qos)
    announced = session.announce(format_token(token))
    joined.until(lambda: usual.get_subscription_count() == 1 and outlet.matched)
    joined.run(0.1)
    send(usual, 1)
    joined.run(0.1)
    outlet.put(packed(7), pack_attachment(1, 0, b"chosen at random"))
    joined.until(lambda: got == [1, 7], 1.0)
    outlet.put(packed(8), pack_attachment(2, 0, b"chosen at random"))
    outlet.put(packed(9), pack_attachment(1, 0, b"somebody else's."))
    send(usual, 2)
    joined.run(KNOWN_WITHIN + 0.5)
    assert got == [1, 7, 8, 2]
    announced.close()
    joined.run(0.5)
    outlet.put(packed(10), pack_attachment(3, 0, b"chosen at random"))
    joined.run(KNOWN_WITHIN + 0.5)
    assert got == [1, 7, 8, 2]
    assert all(not each._parked and len(each._forwards) <= 1 for each in crossings(joined))


def test_what_comes_behind_the_last_subscription_is_not_given_to_the_next(pair: tuple[Mirrored, Half, Half]) -> None:
    """One for the last was under way, or waited in the lane: the next gets the newest, and nothing else."""
    scene, here, there = pair
    publisher = here.node("map_server").create_publisher(Int32, "map", LATCHED)
    send(publisher, 1)
    first = there.node("first")
    got = heard(first, "map", LATCHED)
    scene.until(lambda: got == [1])
    (crossing,) = [each for each in crossings(scene) if each._forwards]
    attachment = next(iter(crossing._forwards.values())).last
    first.destroy_node()
    scene.until(lambda: not publisher._is_heard_)
    crossing._source.lane.sink(crossing)((packed(1), attachment))
    scene.run(0.1)
    send(publisher, 2)
    late = heard(there.node("late"), "map", QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    scene.run(0.5)
    assert late == [2]


def test_a_latched_message_that_nobody_reads_any_more_is_gone_although_the_lane_stands(joined: Mirrored) -> None:
    publisher = joined.a.node("map_server").create_publisher(Int32, "map", LATCHED)
    send(publisher, 1)
    first = joined.b.node("first")
    got = heard(first, "map", LATCHED)
    joined.until(lambda: got == [1])
    assert joined.mirror is not None
    lane = joined.mirror.sides[0].lane
    step, lane.step = lane.step, lambda: False  # type: ignore[method-assign]
    first.destroy_node()
    joined.until(lambda: not publisher._is_heard_)
    send(publisher, 2)
    late = heard(joined.b.node("late"), "map", LATCHED)
    joined.run(0.5)
    assert late == []
    lane.step = step  # type: ignore[method-assign]
    joined.run(0.5)
    assert late == [2]
