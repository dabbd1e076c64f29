"""Messages between a real ROS 2 over DDS and robolink, both ways at once, by itself and through the bridge."""

from __future__ import annotations

import functools
import statistics
import time
from typing import Any, NamedTuple

import pytest

from tests.dds.conftest import Scene
from tests.dds.peers import PATIENCE, Peer, meet, until

pytestmark = pytest.mark.processes


class Case(NamedTuple):
    """A topic's messages: their type, size in bytes, number, rate in Hz."""

    name: str
    type_name: str
    messages: int
    rate: float
    size: int = 0
    reliable: bool = True


RELIABLE = [
    Case("string", "std_msgs/msg/String", 20, 100.0),
    Case("scan", "sensor_msgs/msg/LaserScan", 20, 100.0),
    Case("image", "sensor_msgs/msg/Image", 8, 30.0, 1_000_000),
    Case("large_image", "sensor_msgs/msg/Image", 4, 10.0, 6_220_800),
    Case("unknown_type", "test_msgs/msg/BasicTypes", 10, 100.0),
]
BEST_EFFORT = [
    Case("cloud", "sensor_msgs/msg/PointCloud2", 10, 30.0, 320_000, reliable=False),
    Case("image", "sensor_msgs/msg/Image", 10, 30.0, 1_000_000, reliable=False),
    Case("large_image", "sensor_msgs/msg/Image", 4, 10.0, 6_220_800, reliable=False),
]


def ways(scene: Scene, case: Case, prefix: str) -> list[tuple[Peer, Peer, str]]:
    """Give each peer a publisher that the other subscribes to; return sender, receiver and topic of each."""
    found = []
    depth = max(10, case.messages)  # on a busy machine all wait at once, and of more than that the oldest are dropped
    qos: dict[str, Any] = {"type_name": case.type_name, "reliable": case.reliable, "depth": depth}
    for sender, receiver in ((scene.real, scene.ours), (scene.ours, scene.real)):
        topic = f"{prefix}_{case.name}_of_{sender.name}"
        sender.ask("publisher", topic=topic, **qos)
        receiver.ask("subscription", topic=topic, **qos)
        found.append((sender, receiver, topic))
    for sender, receiver, topic in found:
        meet(sender, receiver, topic)
    return found


def forget(scene: Scene, *topics: str) -> None:
    for topic in topics:
        scene.real.ask("forget", topic=topic)
        scene.ours.ask("forget", topic=topic)


@pytest.mark.parametrize("case", RELIABLE, ids=lambda case: case.name)
def test_reliable_messages_come_all_once_and_in_order_with_their_fields(scene: Scene, case: Case) -> None:
    pairs = ways(scene, case, "reliable")
    for sender, _, topic in pairs:
        sender.start("stream", topic=topic, rate=case.rate, count=case.messages, size=case.size)
    for _, receiver, topic in pairs:
        receiver.wait(topic, case.messages)
    for _, receiver, topic in pairs:
        came = receiver.events(topic)
        assert [each["number"] for each in came] == list(range(1, case.messages + 1))
        assert all(each["right"] for each in came)
    forget(scene, *(topic for *_, topic in pairs))


@pytest.mark.parametrize("case", BEST_EFFORT, ids=lambda case: case.name)
def test_best_effort_messages_come_at_most_once_and_in_order_with_their_fields(scene: Scene, case: Case) -> None:
    pairs = ways(scene, case, "best_effort")
    end, first = time.monotonic() + PATIENCE, 1
    while any(len(receiver.events(topic)) < case.messages for _, receiver, topic in pairs):
        assert time.monotonic() < end, {topic: len(receiver.events(topic)) for _, receiver, topic in pairs}
        sending = [
            (sender, sender.start("stream", topic=topic, rate=case.rate, count=5, first=first, size=case.size))
            for sender, _, topic in pairs
        ]
        for sender, number in sending:
            sender.answer(number)
        first += 5
    for _, receiver, topic in pairs:
        came = receiver.events(topic)
        numbers = [each["number"] for each in came]
        assert numbers == sorted(set(numbers))
        assert all(each["right"] for each in came)
    forget(scene, *(topic for *_, topic in pairs))


def test_a_map_of_1_mb_reaches_who_joins_a_second_late_at_once(scene: Scene) -> None:
    """The kept message comes without a wait for a heartbeat, of which Fast DDS sends one in three seconds."""
    qos: dict[str, Any] = {"type_name": "nav_msgs/msg/OccupancyGrid", "depth": 1, "latched": True}
    pairs = [(scene.real, scene.ours, "map_of_real"), (scene.ours, scene.real, "map_of_ours")]
    for sender, _, topic in pairs:
        sender.ask("publisher", topic=topic, **qos)
        sender.ask("publish", topic=topic, first=1, last=2, size=1_000_000)
    time.sleep(1.0)  # how late they are
    for _, receiver, topic in pairs:
        took = []
        for turn in range(1, 4):
            begun = time.monotonic()
            receiver.ask("subscription", topic=topic, **qos)
            came = receiver.wait(topic, turn)
            assert [(each["number"], each["right"]) for each in came] == [(2, True)] * turn
            took.append(came[-1]["at"] - begun)
            receiver.ask("forget", topic=topic)
        assert statistics.median(took) < 0.3
    forget(scene, *(topic for *_, topic in pairs))


def test_a_latched_topic_keeps_as_many_as_its_depth_says(scene: Scene) -> None:
    qos: dict[str, Any] = {"type_name": "std_msgs/msg/String", "depth": 5, "latched": True}
    for sender, receiver in ((scene.real, scene.ours), (scene.ours, scene.real)):
        topic = f"kept_of_{sender.name}"
        sender.ask("publisher", topic=topic, **qos)
        sender.ask("publish", topic=topic, first=1, last=9)
        receiver.ask("subscription", topic=topic, **qos)
        assert [each["number"] for each in receiver.wait(topic, 5)] == [5, 6, 7, 8, 9]
        sender.ask("publish", topic=topic, first=10)
        assert [each["number"] for each in receiver.wait(topic, 6)] == [5, 6, 7, 8, 9, 10]
        forget(scene, topic)


OFFERS_LESS = [
    pytest.param({"reliable": False}, {"reliable": True}, id="best effort to reliable"),
    pytest.param({"latched": False}, {"latched": True}, id="volatile to transient local"),
]


@pytest.mark.parametrize(("offered", "requested"), OFFERS_LESS)
def test_ours_hears_who_offers_less_as_over_zenoh(
    scene: Scene, offered: dict[str, bool], requested: dict[str, bool]
) -> None:
    topic = f"less_{'_'.join(offered)}"
    scene.real.ask("publisher", topic=topic, type_name="std_msgs/msg/String", **offered)
    scene.ours.ask("subscription", topic=topic, type_name="std_msgs/msg/String", **requested)

    def heard() -> bool:
        scene.real.ask("publish", topic=topic)
        return bool(scene.ours.events(topic))

    until(heard, f"a message on {topic}")
    assert all(each["right"] for each in scene.ours.events(topic))
    forget(scene, topic)


KINDS: dict[str, dict[str, bool]] = {"best_effort": {"reliable": False}, "reliable": {}, "latched": {"latched": True}}


def test_ours_is_matched_with_a_real_subscription_by_the_rules_of_dds(scene: Scene) -> None:
    """What offers less than is requested does not come; it would not from a real node either."""
    order = list(KINDS)
    topics = {f"pair_{offers}_{requests}": (offers, requests) for offers in order for requests in order}
    for topic, (offers, requests) in topics.items():
        scene.ours.ask("publisher", topic=topic, type_name="std_msgs/msg/String", **KINDS[offers])
        scene.real.ask("subscription", topic=topic, type_name="std_msgs/msg/String", **KINDS[requests])
    fits = {topic for topic, pair in topics.items() if order.index(pair[0]) >= order.index(pair[1])}

    def came() -> bool:
        for topic in topics:
            scene.ours.ask("publish", topic=topic)
        return all(scene.real.events(topic) for topic in fits)

    until(came, f"messages on {sorted(fits)}")
    assert {topic for topic in topics if scene.real.events(topic)} == fits
    forget(scene, *topics)


def matches_two(peer: Peer) -> bool:
    return bool(peer.ask("matched", topic="shared") == [2, 2])


def test_each_message_comes_once_where_both_publish_and_subscribe(scene: Scene) -> None:
    """Nothing comes back to whoever sent it by another way."""
    both = (scene.real, scene.ours)
    for peer in both:
        peer.ask("publisher", topic="shared", type_name="std_msgs/msg/String")
        peer.ask("subscription", topic="shared", type_name="std_msgs/msg/String")
    for peer in both:
        until(functools.partial(matches_two, peer), f"{peer.name} sees both ends of both")
    scene.real.ask("stream", topic="shared", rate=100.0, count=10, first=1)
    scene.ours.ask("stream", topic="shared", rate=100.0, count=10, first=101)
    expected = [*range(1, 11), *range(101, 111)]
    for peer in both:
        peer.wait("shared", 20)
    # What came twice would be here by now: a message that was sent later has come both ways.
    for peer, number in zip(both, (200, 300), strict=True):
        peer.ask("publish", topic="shared", first=number)
    for peer in both:
        peer.wait("shared", 1, number=200)
        peer.wait("shared", 1, number=300)
        assert sorted(each["number"] for each in peer.events("shared")) == [*expected, 200, 300]
    forget(scene, "shared")
