"""Figures of channels: heavy ones that nobody else receives are sampled, on a clock of the test's own."""

from __future__ import annotations

import json
from typing import Any, cast

from robolink.view.channels import Channel, Source
from robolink.view.server.statistics import HEAVY, PERIOD, REST, Statistics


class Cameras:
    """A source of one heavy and one light channel, and a client that is told the figures."""

    is_page = True

    def __init__(self) -> None:
        self.heavy, self.light = Channel(1, "/image", "a/msg/B", ""), Channel(2, "/odom", "a/msg/B", "")
        self.channels = {1: self.heavy, 2: self.light}
        self.received: set[int] = set()
        self.time = 0.0
        self.told: dict[int, dict[str, Any]] = {}
        self.statistics = Statistics(cast(Source, self), lambda: self.time)
        self.statistics.follow(self)

    def listen(self, channel: Channel) -> None:
        self.received.add(channel.id)

    def leave(self, channel: Channel) -> None:
        self.received.discard(channel.id)

    def now(self) -> int:
        return round(self.time * 1e9)

    def ends(self, channel: Channel) -> tuple[int, int]:
        return 1, 0

    def say(self, text: str) -> None:
        self.told = {each["channelId"]: each for each in json.loads(text)["topics"]}

    def send(self, body: bytes) -> None:
        raise AssertionError(body)

    def complain(self, message: str, level: int = 2) -> None:
        raise AssertionError(message)

    def second(self) -> tuple[bool, float]:
        """Let a second pass; return whether the heavy channel is received after it, and its bandwidth as it is told."""
        self.time += PERIOD
        for each in self.channels.values():
            if each.id in self.received:
                each.note(self.now(), int(5 * HEAVY) if each is self.heavy else 100)
        self.statistics.tick(1, 0)
        return 1 in self.received, self.told[1]["bandwidth"]


def test_a_heavy_channel_is_received_in_one_of_eleven_seconds_and_told_as_measured() -> None:
    cameras = Cameras()
    seen = [cameras.second() for _ in range(3 * (REST + 1))]
    assert sum(is_received for is_received, _ in seen) == 3  # each at the end of a rest
    assert {bandwidth for _, bandwidth in seen} == {5 * HEAVY}
    assert cameras.light.count == len(seen)
    assert cameras.heavy.count == 3


def test_a_channel_that_somebody_looks_at_is_not_sampled() -> None:
    cameras = Cameras()
    cameras.second()
    cameras.heavy.takers = [lambda *_: None]
    cameras.listen(cameras.heavy)  # as the client's subscription does
    assert [cameras.second()[0] for _ in range(2 * REST)] == [True] * 2 * REST
    assert cameras.told[1]["age"] is not None
    cameras.heavy.takers = []
    assert not cameras.second()[0]
    cameras.statistics.follow(cameras)  # another page that comes does not end the rest
    assert not cameras.second()[0]
    cameras.statistics.part(cameras)
    assert cameras.received == set()


class Played(Cameras):
    """A bag of ten messages a second, whose time the test moves."""

    def play(self, seconds: float) -> dict[str, Any]:
        """Play on, and return the figures that are told."""
        for _ in range(round(seconds * 10)):
            self.time += 0.1
            self.light.note(self.now(), 100)
        self.statistics.tick(1, 0)
        return self.told[2]

    def move(self, to: float) -> None:
        """Move the bag to another place, where the last message of a second before is told."""
        self.time = to
        self.light.note(round((to - 1.0) * 1e9), 100)
        self.statistics.jump()


def test_rates_and_ages_of_a_bag_are_in_its_time_at_any_speed() -> None:
    bag = Played()
    assert bag.play(0)["rate"] == 0.0
    assert bag.play(0)["age"] is None
    for seconds in (8.0, 1.0, 0.2, 0.2, 0.2, 0.0, 0.0):  # faster, as recorded, slower, and paused
        told = bag.play(seconds)
        assert (told["rate"], told["bandwidth"], told["age"]) == (10.0, 1000.0, 0.0)
    for place in (500.0, 100.0):
        bag.move(place)
        told = bag.play(0)
        assert (told["rate"], told["age"]) == (10.0, 1.0)
        assert bag.play(1.0)["rate"] == 10.0
    bag.time = 20.0  # it plays from its begin again, and no message has come since
    told = bag.play(0)
    assert (told["rate"], told["age"]) == (10.0, None)
