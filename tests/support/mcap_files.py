"""MCAP files for tests: what was written to them, and what other readers find in them."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from mcap.reader import NonSeekingReader, make_reader
from rosbags.rosbag2 import Reader as RosbagsReader

from robolink.bag.mcap import Reader, Writer
from robolink.bag.mcap.records import Message

SECOND = 10**9


class Sent(NamedTuple):
    """A message as it was written."""

    channel: int
    sequence: int
    log_time: int
    publish_time: int
    data: bytes


def some_messages(count: int, channels: Sequence[int], seed: int = 1, largest: int = 200) -> list[Sent]:
    """Messages whose log times are nearly in order, by turns for these channels."""
    chance = random.Random(seed)
    return [
        Sent(
            channels[number % len(channels)],
            number,
            SECOND + number * 1000 + chance.randrange(-300_000, 300_000),
            SECOND + number * 1000,
            chance.randbytes(chance.randrange(largest)),
        )
        for number in range(count)
    ]


def add_channels(writer: Writer, count: int) -> list[int]:
    """Add channels of different types, as many as are asked for."""
    return [
        writer.add_channel(
            writer.add_schema(f"probe_msgs/msg/Bytes{number}", "ros2msg", b"uint8[] data\n"),
            f"/probe{number}",
            "cdr",
            {"offered_qos_profiles": ""},
        )
        for number in range(count)
    ]


def write_all(writer: Writer, messages: Iterable[Sent]) -> None:
    """Write messages, and tick as a recorder does."""
    for number, each in enumerate(messages):
        writer.write(each.channel, each.log_time, each.publish_time, each.sequence, each.data)
        if number % 64 == 0:
            writer.tick()


def taken(messages: Iterable[Message]) -> list[Sent]:
    """Messages that were read, with data of their own."""
    return [Sent(*each[:4], bytes(each.data)) for each in messages]


def read(path: Path) -> list[Sent]:
    """Messages that robolink finds in a file, in the order in which they are there."""
    with Reader(path) as reader:
        return taken(reader.messages(in_log_order=False))


def read_by_mcap(path: Path) -> list[int]:
    """Sequence numbers that mcap's reader finds by the index."""
    with path.open("rb") as file:
        return sorted(each.sequence for _, _, each in make_reader(file, validate_crcs=True).iter_messages())


def read_by_mcap_linearly(path: Path) -> list[int]:
    """Sequence numbers that mcap's reader finds without the index, in the file's order."""
    with path.open("rb") as file:
        found = NonSeekingReader(file, validate_crcs=True).iter_messages(log_time_order=False)
        return [each.sequence for _, _, each in found]


def count_by_rosbags(path: Path) -> int:
    """Number of messages that rosbags finds."""
    with RosbagsReader(path) as reader:
        return sum(1 for _ in reader.messages())
