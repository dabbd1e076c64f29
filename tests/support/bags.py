"""Bags for tests: written by rosbags (others' bags) and by robolink, and read by both."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from robolink.bag.topic import BagTopic
from robolink.bag.writer import BagWriter
from robolink.duration import Infinite
from robolink.qos import DurabilityPolicy, HistoryPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy

STRING = "string data\n"
START = 1_700_000_000_000_000_000
"""Time of the first message, in nanoseconds since 1970."""
LATCHED = QoSProfile(
    history=HistoryPolicy.KEEP_LAST,
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
    deadline=Infinite,
    lifespan=Infinite,
    liveliness=LivelinessPolicy.AUTOMATIC,
    liveliness_lease_duration=Infinite,
)
CHATTER = BagTopic("/chatter", "std_msgs/msg/String", "cdr", "RIHS01_" + "ab" * 32, (), STRING)
MAP = BagTopic("/map", "std_msgs/msg/String", "cdr", "RIHS01_" + "ab" * 32, (LATCHED,), STRING)


class Said(NamedTuple):
    """Message as tests compare it."""

    topic: str
    stamp: int
    data: bytes


def text(words: str) -> bytes:
    """Return a std_msgs/String as CDR bytes."""
    raw = words.encode() + b"\0"
    return b"\0\1\0\0" + len(raw).to_bytes(4, "little") + raw + b"\0" * (-len(raw) % 4)


def ten_messages() -> list[Said]:
    """Return ten messages of two topics, a second apart from each other."""
    return [
        Said("/map" if number % 3 == 0 else "/chatter", START + number * 10**9, text(f"hello {number}"))
        for number in range(10)
    ]


def write(path: Path, messages: Iterable[Said] = (), **options: Any) -> None:
    """Write a bag by robolink."""
    with BagWriter(path, **options) as writer:
        numbers = {each.name: writer.add_topic(each) for each in (CHATTER, MAP)}
        for number, each in enumerate(messages):
            writer.write(numbers[each.topic], each.stamp, each.stamp - 5, number, each.data)


def write_theirs(
    path: Path, messages: Iterable[Said], *, version: int = 9, storage: str = "mcap", mode: str = "none"
) -> None:
    """Write a bag by rosbags: its topics are those of `write`."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

    for_ever = QosTime(9223372036, 854775807)
    latched = Qos(
        QosHistory.KEEP_LAST,
        1,
        QosReliability.RELIABLE,
        QosDurability.TRANSIENT_LOCAL,
        for_ever,
        for_ever,
        QosLiveliness.AUTOMATIC,
        for_ever,
        False,
    )
    writer = Writer(path, version=version, storage_plugin=StoragePlugin[storage.upper()])  # type: ignore[arg-type]
    writer.set_compression(CompressionMode[mode.upper()], CompressionFormat.ZSTD)
    writer.set_custom_data("robot", "r2")
    with writer:
        connections = {
            each.name: writer.add_connection(
                each.name,
                each.type_name,
                msgdef=each.message_definition,
                rihs01=each.type_hash,
                offered_qos_profiles=[latched] if each.offered_qos else [],
            )
            for each in (CHATTER, MAP)
        }
        for each in messages:
            writer.write(connections[each.topic], each.stamp, each.data)


def read(path: Path, **options: Any) -> list[Said]:
    """Read a bag by robolink."""
    from robolink.bag.reader import open_bag

    with open_bag(path) as bag:
        found = [Said(each.topic, each.log_time, bytes(each.data)) for each in bag.messages(**options)]
        assert bag.problems == []
    return found


class Theirs(NamedTuple):
    """Bag as rosbags reads it."""

    messages: list[Said]
    qos: Mapping[str, list[Any]]
    definitions: Mapping[str, str]
    hashes: Mapping[str, str]
    custom_data: Mapping[str, str] | None
    counts: Mapping[str, int]


def read_by_rosbags(path: Path) -> Theirs:
    """Read a bag by rosbags."""
    from rosbags.rosbag2 import Reader

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ResourceWarning)
        with Reader(path) as reader:
            messages = [Said(each.topic, stamp, bytes(data)) for each, stamp, data in reader.messages()]
            return Theirs(
                messages,
                {each.topic: list(getattr(each.ext, "offered_qos_profiles")) for each in reader.connections},  # noqa: B009
                {each.topic: each.msgdef.data for each in reader.connections},
                {each.topic: each.digest for each in reader.connections},
                reader.storage.metadata.custom,
                {each.topic: each.msgcount for each in reader.connections},
            )
