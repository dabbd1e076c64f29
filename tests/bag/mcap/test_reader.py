"""Reader: messages by channel and time, in both directions, of whole files and of files that others wrote."""

from __future__ import annotations

from operator import attrgetter
from pathlib import Path

import pytest
from mcap.writer import CompressionType, IndexType
from mcap.writer import Writer as OtherWriter

from robolink.bag.mcap import McapError, Reader, Writer
from tests.support.mcap_files import SECOND, Sent, add_channels, read, some_messages, taken, write_all

IN_ORDER = attrgetter("log_time")


@pytest.fixture(params=["closed", "open", "cut"])
def written(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, list[Sent]]:
    """A file of overlapping chunks: closed, still open, or without its end."""
    path = tmp_path / "probe.mcap"
    writer = Writer(path, chunk_size=8 << 10)
    messages = some_messages(2000, add_channels(writer, 5))
    write_all(writer, messages)
    writer.flush()
    if request.param == "open":
        copy = tmp_path / "copy.mcap"
        copy.write_bytes(path.read_bytes())
        path = copy
    writer.close()
    if request.param == "cut":
        path.write_bytes(path.read_bytes()[:-20])
    return path, messages


def test_messages_in_each_order(written: tuple[Path, list[Sent]]) -> None:
    path, messages = written
    in_order = sorted(messages, key=IN_ORDER)
    with Reader(path) as reader:
        assert taken(reader.messages(in_log_order=False)) == messages
        assert taken(reader.messages(in_log_order=False, reverse=True)) == messages[::-1]
        assert taken(reader.messages()) == in_order
        assert taken(reader.messages(reverse=True)) == in_order[::-1]


def test_messages_of_channels_and_times(written: tuple[Path, list[Sent]]) -> None:
    path, messages = written
    low, high = SECOND + 500_000, SECOND + 900_000
    for channels in ([2], [1, 5], [], [99]):
        wanted = [each for each in sorted(messages, key=IN_ORDER) if each.channel in channels]
        with Reader(path) as reader:
            assert taken(reader.messages(channels)) == wanted
            window = [each for each in wanted if low <= each.log_time < high]
            assert taken(reader.messages(channels, low, high)) == window
            assert taken(reader.messages(channels, low, high, reverse=True)) == window[::-1]


def test_statistics(written: tuple[Path, list[Sent]]) -> None:
    path, messages = written
    with Reader(path) as reader:
        times = [each.log_time for each in messages]
        assert reader.statistics == (2000, dict.fromkeys(range(1, 6), 400), min(times), max(times))
        assert [each.topic for each in reader.channels.values()] == [f"/probe{number}" for number in range(5)]
        assert reader.schemas[1][1:] == ("probe_msgs/msg/Bytes0", "ros2msg", b"uint8[] data\n")
        assert reader.is_whole == (not reader.problems)


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("layout", ["usual", "unchunked", "no index", "no repeats", "no statistics"])
def test_files_of_mcap_s_own_writer(tmp_path: Path, compression: CompressionType, layout: str) -> None:
    path = tmp_path / "other.mcap"
    with path.open("wb") as file:
        writer = OtherWriter(
            file,
            compression=compression,
            chunk_size=4096,
            use_chunking=layout != "unchunked",
            index_types=IndexType.NONE if layout == "no index" else IndexType.ALL,
            repeat_channels=layout != "no repeats",
            repeat_schemas=layout != "no repeats",
            use_statistics=layout != "no statistics",
        )
        writer.start("ros2")
        schema = writer.register_schema("a/msg/A", "ros2msg", b"uint8[] data")
        channels = [writer.register_channel(f"/a{number}", "cdr", schema) for number in range(3)]
        messages = some_messages(1000, channels)
        for each in messages:
            writer.add_message(each.channel, each.log_time, each.data, each.publish_time, each.sequence)
        writer.add_metadata("probe", {"a": "b"})
        writer.finish()  # type: ignore[no-untyped-call]
    assert read(path) == messages
    with Reader(path) as reader:
        assert (reader.is_whole, reader.problems) == (True, [])
        assert reader.statistics.message_count == 1000
        assert reader.metadata == [("probe", {"a": "b"})]
        assert taken(reader.messages()) == sorted(messages, key=IN_ORDER)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "it is empty"),
        (b"\x89MCAP", "it is cut after 5 bytes"),
        (b"\x89MCAP1\r\n" + bytes(30), "its format is MCAP version 1; robolink reads version 0"),
        (b"SQLite format 3\0" + bytes(100), "it is not an MCAP file, but an SQLite database"),
        (b"#ROSBAG V2.0\n", "but a bag of ROS 1"),
        (b"\x28\xb5\x2f\xfd" + bytes(30), "packed with zstd as a whole"),
        (b"Hello, world", "it is not an MCAP file: it begins with b'Hello, w'"),
    ],
)
def test_other_files_are_named(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "other.mcap"
    path.write_bytes(content)
    with pytest.raises(McapError) as caught:
        Reader(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)


def test_a_file_that_cannot_be_opened(tmp_path: Path) -> None:
    with pytest.raises(McapError, match="cannot be read: No such file"):
        Reader(tmp_path / "none.mcap")
    with pytest.raises(McapError, match="cannot be read: Is a directory"):
        Reader(tmp_path)
