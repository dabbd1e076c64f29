"""Files that claim to unpack to far more than they should, and files that were quadratic: told soon, in little memory.

The limits are lowered: what would take gigabytes is here a few kilobytes.
"""

from __future__ import annotations

import functools
import random
import struct
import time
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from robolink.bag import limits
from robolink.bag.mcap import Reader
from robolink.bag.mcap.blocks import in_log_order
from robolink.bag.mcap.chunk import compressor
from robolink.bag.mcap.records import (
    DATA_END,
    MAGIC,
    MESSAGE,
    Channel,
    ChunkIndex,
    Malformed,
    Message,
    Schema,
    Statistics,
    channel_record,
    chunk_index_record,
    chunk_opening,
    footer,
    header_record,
    record,
    records,
    schema_record,
    statistics_record,
)

KIB = 1024
NOTHING = memoryview(b"")
pack = functools.cache(compressor("zstd"))


class Chunk(NamedTuple):
    """A chunk as a hostile writer makes it."""

    data: bytes
    claimed: int = -1
    time: int = 5


def message(stamp: int = 5, data: bytes = b"\0\1\0\0") -> bytes:
    return record(MESSAGE, struct.pack("<HIQQ", 1, 0, stamp, stamp) + data)


def made(path: Path, chunks: Sequence[Chunk], *, indexed: bool, channels: int = 1) -> Path:
    """Write a file of these chunks, with a summary or without."""
    out = bytearray(MAGIC + header_record("ros2", "test"))
    told = schema_record(Schema(1, "std_msgs/msg/String", "ros2msg", b"string data\n"))
    told += b"".join(channel_record(Channel(1 + each, 1, f"/a{each}", "cdr", {})) for each in range(channels))
    out += told
    index = b""
    for data, claimed, stamp in chunks:
        packed, size = pack(data), len(data) if claimed < 0 else claimed
        at = len(out)
        out += chunk_opening(stamp, stamp, size, 0, "zstd", len(packed)) + packed
        index += chunk_index_record(ChunkIndex(stamp, stamp, at, len(out) - at, {1: 0}, 0, "zstd", len(packed), size))
    out += record(DATA_END, bytes(4))
    start = len(out) if indexed else 0
    if indexed:
        statistics = Statistics(len(chunks), {1: len(chunks)}, 0, 9)
        out += told + statistics_record(statistics, (1, channels, 0, 0, len(chunks))) + index
    path.write_bytes(bytes(out) + footer(start) + MAGIC)
    return path


@pytest.fixture
def low(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in {
        "PIECE": 64 * KIB,
        "FILE": 256 * KIB,
        "FILE_RATIO": 100,
        "SMALL": 16 * KIB,
        "MESSAGES": 100,
    }.items():
        monkeypatch.setattr(limits, name, value)


@pytest.mark.usefixtures("low")
@pytest.mark.parametrize("indexed", [True, False])
def test_a_chunk_that_claims_too_much_for_its_size_is_left_out_and_the_others_are_read(
    tmp_path: Path, indexed: bool
) -> None:
    chunks = [Chunk(message(5)), Chunk(bytes(200 * KIB)), Chunk(message(6), time=6)]
    with Reader(made(tmp_path / "a.mcap", chunks, indexed=indexed)) as reader:
        assert [each.log_time for each in reader.messages()] == [5, 6]
        (problem,) = reader.problems
    assert f"claim to be {200 * KIB}: from {64 * KIB} on 250 times as many are unpacked at most" in problem


@pytest.mark.usefixtures("low")
@pytest.mark.parametrize("indexed", [True, False])
def test_chunks_that_claim_too_much_together_are_left_out(tmp_path: Path, indexed: bool) -> None:
    chunks = [Chunk(message(5)), *[Chunk(bytes(60 * KIB))] * 9]
    with Reader(made(tmp_path / "a.mcap", chunks, indexed=indexed)) as reader:
        assert [each.log_time for each in reader.messages()] == [5]
        assert reader.problems
        assert "its chunks claim to be" in reader.problems[0] or "too many were unpacked before" in reader.problems[0]


def test_four_gigabytes_in_a_claim_are_told_at_once(tmp_path: Path) -> None:
    for indexed in (True, False):
        path = made(tmp_path / f"{indexed}.mcap", [Chunk(bytes(KIB), 4 << 30)], indexed=indexed)
        begun = time.process_time()
        with Reader(path) as reader:
            assert list(reader.messages()) == []
            assert len(reader.problems) == 1
        assert time.process_time() - begun < 0.5


@pytest.mark.usefixtures("low")
def test_a_chunk_that_is_all_the_same_message_is_left_out(tmp_path: Path) -> None:
    with Reader(made(tmp_path / "a.mcap", [Chunk(message() * 1000)], indexed=True)) as reader:
        assert list(reader.messages()) == []
        assert "with more than" in reader.problems[0]


@pytest.mark.usefixtures("low")
def test_what_is_packed_well_by_an_honest_recorder_is_read(tmp_path: Path) -> None:
    black = [Chunk(message(each, bytes(15 * KIB)), time=each) for each in range(16)]
    with Reader(made(tmp_path / "a.mcap", black, indexed=True)) as reader:
        assert [each.log_time for each in reader.messages()] == list(range(16))
        assert reader.problems == []


@pytest.mark.usefixtures("low")
@pytest.mark.parametrize("indexed", [True, False])
def test_of_a_long_recording_of_black_images_the_first_are_read(tmp_path: Path, indexed: bool) -> None:
    black = [Chunk(message(each, bytes(50 * KIB)), time=each) for each in range(9)]
    with Reader(made(tmp_path / "a.mcap", black, indexed=indexed)) as reader:
        assert [each.log_time for each in reader.messages()] == [0, 1, 2, 3, 4]
        assert reader.problems


def test_zeros_are_no_records() -> None:
    with pytest.raises(Malformed, match="a record is missing"):
        list(records(bytes(100)))


@pytest.mark.slow
@pytest.mark.parametrize("indexed", [True, False])
@pytest.mark.parametrize("reverse", [True, False])
def test_chunks_of_one_time_are_read_in_time_that_grows_with_their_number(
    tmp_path: Path, indexed: bool, reverse: bool
) -> None:
    path = made(tmp_path / "a.mcap", [Chunk(message())] * 4000, indexed=indexed)
    begun = time.process_time()
    with Reader(path) as reader:
        assert sum(1 for _ in reader.messages(reverse=reverse)) == 4000
    assert time.process_time() - begun < 1.5


@pytest.mark.slow
def test_broken_chunks_are_told_in_time_that_grows_with_their_number(tmp_path: Path) -> None:
    path = made(tmp_path / "a.mcap", [Chunk(b"", 9)] * 4000, indexed=True)
    begun = time.process_time()
    with Reader(path) as reader:
        assert list(reader.messages()) == []
        assert len(reader.problems) == 4000
        assert list(reader.messages()) == []
        assert len(reader.problems) == 4000
    assert time.process_time() - begun < 1.5


@pytest.mark.slow
def test_sixty_five_thousand_channels_are_opened_in_two_seconds(tmp_path: Path) -> None:
    path = made(tmp_path / "a.mcap", [Chunk(message())], indexed=True, channels=65_000)
    begun = time.process_time()
    with Reader(path) as reader:
        assert len(reader.channels) == 65_000
    assert time.process_time() - begun < 2.0


@pytest.mark.parametrize("reverse", [True, False])
def test_overlapping_chunks_come_in_the_order_of_a_stable_sort(reverse: bool) -> None:
    dice = random.Random(3)
    for _ in range(300):
        chunks = [
            [
                Message(1, dice.randrange(10**6), dice.randrange(9), 0, memoryview(b""))
                for _ in range(dice.randrange(1, 6))
            ]
            for _ in range(dice.randrange(1, 7))
        ]
        edge = max if reverse else min
        chunks.sort(key=lambda each: edge(message.log_time for message in each), reverse=reverse)
        edges = [edge(message.log_time for message in each) for each in chunks]
        found = list(in_log_order(zip(chunks, [*edges[1:], None], strict=True), reverse=reverse))
        every = [each for chunk in chunks for each in (reversed(chunk) if reverse else chunk)]
        assert found == sorted(every, key=lambda each: each.log_time, reverse=reverse)
