"""Bags to play, and what a player has published of them with the times at which it came."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from robolink import Node
from robolink.bag.playing import Player, PlaySettings
from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.interfaces.std_msgs.msg import String
from robolink.message import encode, type_hash
from robolink.qos import QoSProfile
from robolink.testing import System

START = 1_700_000_000_000_000_000
"""Time of the first message, in nanoseconds since 1970."""


class Heard(NamedTuple):
    """A message, and the time in seconds at which it came, since the player's start."""

    at: float
    topic: str
    data: str


def topic(name: str, *offered: QoSProfile) -> BagTopic:
    """Return a topic of std_msgs/String."""
    return BagTopic(name, "std_msgs/msg/String", "cdr", type_hash(String), offered, message_definition(String))


def write(path: Path, topics: Iterable[BagTopic], said: Iterable[tuple[float, str, str]], **options: Any) -> Path:
    """Write a bag of strings: (time in seconds, topic, text). They were sent a millisecond before."""
    with BagWriter(path, **options) as writer:
        numbers = {each.name: writer.add_topic(each) for each in topics}
        for at, name, text in said:
            stamp = START + round(at * 1e9)
            writer.write(numbers[name], stamp, stamp - 10**6, 0, encode(String(data=text)))
    return path


def counting(path: Path, count: int = 5) -> Path:
    """Write a bag with a message in each second: "0", "1", ... on /count."""
    return write(path, [topic("/count")], [(float(each), "/count", str(each)) for each in range(count)])


class Played:
    """Player in a system in virtual time, and a node that hears what it publishes.

    Args:
        system: The system.
        paths: Bags.
        settings: Of the player.
        names: Topics that are heard.
    """

    def __init__(
        self,
        system: System,
        paths: Sequence[Path],
        settings: PlaySettings | None = None,
        names: Sequence[str] = ("/count",),
        qos: QoSProfile | int = 100,
    ) -> None:
        self.heard: list[Heard] = []
        self._system = system
        for each in names:
            system.node.create_subscription(String, each, functools.partial(self._hear, each), qos)
        made: list[Player] = []

        class PlayerNode(Node):
            def __init__(self) -> None:
                super().__init__("rosbag2_player")
                made.append(Player(self, paths, settings))

        self.node = system.start(PlayerNode)
        (self.player,) = made
        self.playback = self.player.playback
        self._begin = system.time
        self.player.start()

    def _hear(self, name: str, message: String) -> None:
        self.heard.append(Heard(round(self._system.time - self._begin, 9), name, message.data))

    def run(self, seconds: float) -> list[str]:
        """Let time pass; return the texts that came meanwhile."""
        before = len(self.heard)
        self._system.run(seconds)
        return [each.data for each in self.heard[before:]]

    @property
    def texts(self) -> list[str]:
        """All texts that came."""
        return [each.data for each in self.heard]

    @property
    def times(self) -> list[float]:
        """The times at which they came."""
        return [each.at for each in self.heard]
