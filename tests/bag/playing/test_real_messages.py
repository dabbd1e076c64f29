"""A bag of messages that a real ROS 2 serialized is played with nothing dropped."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import pytest

from robolink import Node
from robolink.bag.playing import Player
from robolink.bag.topic import BagTopic, message_definition
from robolink.bag.writer import BagWriter
from robolink.message import type_hash
from robolink.testing import System
from tests.support.players import START
from tests.support.real_messages import made, our_class, plain, recorded

STANDARD = {name: data for name, data in recorded().items() if "/msg/" in name and not name.startswith("test_msgs")}


def write(path: Path) -> Path:
    with BagWriter(path) as writer:
        for name, data in STANDARD.items():
            cls = our_class(name)
            number = writer.add_topic(BagTopic(topic(name), name, "cdr", type_hash(cls), (), message_definition(cls)))
            for at, each in enumerate(data):
                writer.write(number, START + at * 10**6, START + at * 10**6, at, each)
    return path


def topic(name: str) -> str:
    return f"/{name.replace('/msg/', '/').lower()}"


@pytest.mark.slow
def test_all_messages_arrive(system: System, tmp_path: Path) -> None:
    heard: dict[str, list[Any]] = {name: [] for name in STANDARD}
    for name in STANDARD:
        system.node.create_subscription(our_class(name), topic(name), functools.partial(hear, heard[name]), 100)
    bag = write(tmp_path / "bag")
    players: list[Player] = []

    class PlayerNode(Node):
        def __init__(self) -> None:
            super().__init__("rosbag2_player")
            players.append(Player(self, [bag]))

    system.start(PlayerNode)
    players[0].start()
    system.run(1.0)
    for name, data in STANDARD.items():
        cls = our_class(name)
        assert heard[name] == [plain(made(cls, at, our_class)) for at in range(len(data))], name


def hear(into: list[Any], message: Any) -> None:
    into.append(plain(message))
