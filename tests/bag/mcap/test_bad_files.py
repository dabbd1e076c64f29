"""Bad files: cut, flipped, mixed with the unknown; what is good in them is still read, and nothing crashes."""

from __future__ import annotations

import contextlib
import random
import struct
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.bag.mcap import McapError, MissingCompressionError, Reader, Writer, chunk, reindex
from robolink.bag.mcap.blocks import Source
from robolink.bag.mcap.records import (
    CHUNK,
    FILLER,
    MAGIC,
    MESSAGE,
    Malformed,
    header_record,
    read_attachment,
    read_channel,
    read_chunk_head,
    read_chunk_index,
    read_metadata,
    read_schema,
    read_statistics,
    record,
    records,
)
from robolink.bag.mcap.scan import scan
from tests.support.mcap_files import Sent, add_channels, count_by_rosbags, read, read_by_mcap, some_messages, write_all


def made(path: Path, compression: str = "", count: int = 400, chunk_size: int = 4096) -> list[Sent]:
    """Write a closed file of a dozen chunks."""
    path.unlink(missing_ok=True)
    with Writer(path, compression=compression, chunk_size=chunk_size, sync_every=0) as writer:
        messages = some_messages(count, add_channels(writer, 3))
        write_all(writer, messages)
        writer.add_metadata("probe", {"a": "b"})
    return messages


def places(data: bytes, kind: int) -> list[tuple[int, int]]:
    """Start and end of the content of each record of a kind."""
    return [(8 + start, 8 + end) for opcode, start, end in records(data[8:-8]) if opcode == kind]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["", "zstd", "lz4"])
def test_a_file_that_is_cut_anywhere_has_what_is_before(tmp_path: Path, name: str) -> None:
    path = tmp_path / "cut.mcap"
    messages = made(path, name)
    data = path.read_bytes()
    ends = [end for _, end in places(data, CHUNK)]
    chance = random.Random(3)
    for at in (9, 40, *sorted(chance.sample(range(500, len(data) - 1), 40)), len(data) - 1):
        path.write_bytes(data[:at])
        found = read(path)
        whole = sum(end <= at for end in ends)
        assert found == messages[: len(found)]
        assert len(found) >= whole * len(messages) // (len(ends) + 1)
        with Reader(path) as reader:
            assert not reader.is_whole
            assert len(reader.problems) == 1
        assert reindex(path).messages == len(found)
        assert read(path) == found
        assert at < 37 or count_by_rosbags(path) == len(found)  # without the header it is not known to be ROS 2's


def test_of_an_uncompressed_chunk_without_its_end_the_first_messages_are_read(tmp_path: Path) -> None:
    path = tmp_path / "cut.mcap"
    messages = made(path, count=100, chunk_size=1 << 20)
    data = path.read_bytes()
    ((start, end),) = places(data, CHUNK)
    path.write_bytes(data[: (start + end) // 2])
    assert 40 < len(read(path)) < 60
    assert read(path) == messages[: len(read(path))]


@pytest.mark.parametrize("name", ["", "zstd"])
def test_a_broken_chunk_costs_its_own_messages(tmp_path: Path, name: str) -> None:
    path = tmp_path / "broken.mcap"
    messages = made(path, name)
    data = bytearray(path.read_bytes())
    chunks = places(bytes(data), CHUNK)
    start, end = chunks[len(chunks) // 2]
    data[end - 40] ^= 0xFF
    path.write_bytes(data)
    found = read(path)
    assert 0 < len(messages) - len(found) <= 2 * len(messages) / len(chunks)
    assert found == [each for each in messages if each in found]
    with Reader(path) as reader:
        list(reader.messages())
        list(reader.messages())
        assert len(reader.problems) == 1
        assert reader.problems[0].startswith(f"byte {start - 9}: a chunk: it")
    report = reindex(path)
    assert (report.messages, len(report.problems), report.was_whole) == (len(found), 1, False)
    assert read_by_mcap(path) == [each.sequence for each in found]


def test_a_broken_length_costs_its_own_record(tmp_path: Path) -> None:
    path = tmp_path / "broken.mcap"
    messages = made(path)
    data = bytearray(path.read_bytes())[:-300]  # no index: it is scanned
    chunks = places(path.read_bytes(), CHUNK)
    start, _ = chunks[3]
    struct.pack_into("<Q", data, start - 8, 1 << 60)
    path.write_bytes(data)
    found = read(path)
    assert found[:5] == messages[:5]
    assert len(found) >= len(messages) * (len(chunks) - 2) / len(chunks)
    assert len({each.sequence for each in found}) == len(found)


def test_unknown_records_are_skipped(tmp_path: Path) -> None:
    path = tmp_path / "unknown.mcap"
    messages = made(path)
    data = path.read_bytes()
    first = len(MAGIC + header_record("ros2", "robolink"))
    odd = record(0x40, b"of a later version") + record(FILLER + 5, b"\x05" * 40)
    path.write_bytes(data[:first] + odd + data[first:])
    assert read(path) == messages


def test_messages_of_unknown_channels_are_left_out_and_counted(tmp_path: Path) -> None:
    path = tmp_path / "unknown.mcap"
    message = record(MESSAGE, struct.pack("<HIQQ", 7, 0, 1, 1) + b"data")
    path.write_bytes(MAGIC + header_record("", "") + message)
    with Reader(path) as reader:
        assert list(reader.messages()) == []
        assert any("1 messages belong to channels that are not described" in each for each in reader.problems)


def test_a_chunk_that_claims_to_be_huge_is_no_bomb(tmp_path: Path) -> None:
    path = tmp_path / "bomb.mcap"
    made(path, "zstd", count=50, chunk_size=1 << 20)
    data = bytearray(path.read_bytes())
    ((start, _),) = places(bytes(data), CHUNK)
    for size in (1, 1 << 33, (1 << 64) - 1):
        struct.pack_into("<Q", data, start + 16, size)
        path.write_bytes(data[:-10])
        assert read(path) == []


def test_a_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "packed.mcap"
    made(path, "zstd")
    chunk._module.cache_clear()
    monkeypatch.setitem(chunk.MODULES, "zstd", ("robolink_has_no_zstd",))
    try:
        with Reader(path) as reader:  # what is in it can be told
            assert reader.statistics.message_count == 400
            assert reader.compression == "zstd"
            with pytest.raises(MissingCompressionError) as caught:
                list(reader.messages())
        wanted = "compression 'zstd' needs a package that is not here: pip install robolink_has_no_zstd"
        assert str(caught.value) == f"{path}: {wanted}"
        path.write_bytes(path.read_bytes()[:-10])
        with pytest.raises(MissingCompressionError, match="pip install robolink_has_no_zstd"):
            Reader(path)
        with pytest.raises(MissingCompressionError):
            Writer(tmp_path / "other.mcap", compression="zstd")
    finally:
        monkeypatch.undo()
        chunk._module.cache_clear()


PARSERS = (
    read_attachment,
    read_channel,
    read_chunk_head,
    read_chunk_index,
    read_metadata,
    read_schema,
    read_statistics,
)


@given(st.sampled_from(PARSERS), st.binary(max_size=200))
def test_no_bytes_break_a_parser(parse: object, content: bytes) -> None:
    assert callable(parse)
    with contextlib.suppress(Malformed):
        parse(content)


RECORDS = st.builds(record, st.integers(0, 0x82), st.binary(max_size=80))


@given(st.lists(st.one_of(RECORDS, st.binary(max_size=30)), max_size=12), st.booleans())
def test_no_bytes_break_the_reader(
    tmp_path_factory: pytest.TempPathFactory, parts: list[bytes], has_head: bool
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.mcap"
    path.write_bytes(MAGIC + (header_record("ros2", "x") if has_head else b"") + b"".join(parts) + MAGIC)
    with Reader(path) as reader:
        assert len(list(reader.messages())) == reader.statistics.message_count


@given(st.data(), st.sampled_from(["", "zstd", "lz4"]), st.booleans())
def test_no_flipped_bytes_break_the_reader(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject, name: str, is_scanned: bool
) -> None:
    path = tmp_path_factory.getbasetemp() / "flipped.mcap"
    made(path, name, count=60, chunk_size=1000)
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(len(MAGIC), len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(content)
    with contextlib.suppress(McapError):  # a compression that does not exist, for example
        with Reader(path) as reader:
            list(reader.messages())
        if is_scanned:
            source = Source(path)
            scan(source)
            source.close()
        reindex(path)


@given(
    st.lists(st.tuples(st.integers(1, 3), st.integers(0, 2**64 - 1), st.binary(max_size=300)), max_size=60),
    st.sampled_from(["", "zstd", "lz4"]),
    st.integers(1, 2000),
)
def test_all_messages_come_back(
    tmp_path_factory: pytest.TempPathFactory, given: list[tuple[int, int, bytes]], name: str, chunk_size: int
) -> None:
    path = tmp_path_factory.getbasetemp() / "trip.mcap"
    path.unlink(missing_ok=True)
    sent = [Sent(channel, number, time, time // 2, data) for number, (channel, time, data) in enumerate(given)]
    with Writer(path, compression=name, chunk_size=chunk_size, sync_every=0, flush_every=0.0) as writer:
        add_channels(writer, 3)
        write_all(writer, sent)
    assert read(path) == sent
    with Reader(path) as reader:
        assert [each.log_time for each in reader.messages()] == sorted(each.log_time for each in sent)
        assert [each.log_time for each in reader.messages(reverse=True)] == sorted(
            (each.log_time for each in sent), reverse=True
        )
