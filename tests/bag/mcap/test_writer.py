"""Writer: what it writes is read by robolink, mcap and rosbags, before it is closed and after."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from mcap.reader import make_reader

from robolink.bag.mcap import Attachment, McapError, Reader, Writer
from tests.support.mcap_files import (
    add_channels,
    count_by_rosbags,
    read,
    read_by_mcap,
    read_by_mcap_linearly,
    some_messages,
    write_all,
)

COMPRESSIONS = ("", "zstd", "lz4")


@pytest.fixture
def path(tmp_path: Path) -> Iterator[Path]:
    yield tmp_path / "probe.mcap"
    assert not [each for each in tmp_path.iterdir() if each.suffix == ".new"]


@pytest.mark.parametrize("compression", COMPRESSIONS)
@pytest.mark.parametrize("count", [0, 1, 3000])
def test_others_read_what_is_written(path: Path, compression: str, count: int) -> None:
    with Writer(path, compression=compression, chunk_size=64 << 10) as writer:
        messages = some_messages(count, add_channels(writer, 3))
        write_all(writer, messages)
        writer.flush()
        for _ in range(2):  # while it is open, and once it is closed
            assert read(path) == messages
            assert read_by_mcap(path) == [each.sequence for each in messages]
            assert read_by_mcap_linearly(path) == [each.sequence for each in messages]
            assert count_by_rosbags(path) == count
            writer.close()


def test_a_closed_file_has_no_dead_space(path: Path) -> None:
    with Writer(path) as writer:
        messages = some_messages(500, add_channels(writer, 3))
        write_all(writer, messages)
        writer.flush()
        assert path.stat().st_size > 8 << 20
    data = sum(len(each.data) + 31 for each in messages)
    assert data < path.stat().st_size < data * 1.3


def test_the_summary_tells_what_is_in_it(path: Path) -> None:
    with Writer(path, library="probe") as writer:
        messages = some_messages(100, add_channels(writer, 2))
        write_all(writer, messages)
        writer.add_metadata("rosbag2", {"serialized_metadata": "{}"})
        writer.add_attachment(Attachment(1, 2, "a.txt", "text/plain", b"abc"))
        writer.flush()
        assert writer.summary_size > 100
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True)
        assert (reader.get_header().profile, reader.get_header().library) == ("ros2", "probe")
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        assert summary.statistics.message_count == 100
        assert summary.statistics.channel_message_counts == {1: 50, 2: 50}
        assert summary.statistics.message_start_time == min(each.log_time for each in messages)
        assert summary.statistics.message_end_time == max(each.log_time for each in messages)
        assert [each.data for each in reader.iter_attachments()] == [b"abc"]
        assert [(each.name, each.metadata) for each in reader.iter_metadata()] == [
            ("rosbag2", {"serialized_metadata": "{}"})
        ]
    with Reader(path) as own:
        assert own.attachments == [Attachment(1, 2, "a.txt", "text/plain", b"abc")]
        assert own.metadata == [("rosbag2", {"serialized_metadata": "{}"})]
        assert (own.profile, own.library, own.is_whole) == ("ros2", "probe", True)


@pytest.mark.slow
def test_a_message_larger_than_a_chunk_has_one_of_its_own(path: Path) -> None:
    with Writer(path, chunk_size=10_000) as writer:
        (channel,) = add_channels(writer, 1)
        sizes = (10, 3_000_000, 20, 100_000, 9_999, 30_000_000)
        for number, size in enumerate(sizes):
            writer.write(channel, number, number, number, bytes(size))
            writer.flush()
            assert read_by_mcap(path) == list(range(number + 1))
    assert [len(each.data) for each in read(path)] == list(sizes)


@pytest.mark.slow
def test_a_channel_that_comes_later_is_there(path: Path) -> None:
    with Writer(path, chunk_size=2_000) as writer:
        messages = []
        for number in range(50):
            channel = writer.add_channel(writer.add_schema(f"probe_msgs/msg/P{number}", "ros2msg", b""), "/p", "cdr")
            messages += some_messages(10, [channel])
            write_all(writer, messages[-10:])
            writer.flush()
            with Reader(path) as reader:
                assert reader.statistics.counts == dict.fromkeys(range(1, number + 2), 10)
    assert read(path) == messages


def test_views_are_copied(path: Path) -> None:
    buffer = bytearray(b"first")
    with Writer(path) as writer:
        (channel,) = add_channels(writer, 1)
        writer.write(channel, 1, 1, -1, memoryview(buffer))
        buffer[:] = b"later"
    assert [(each.data, each.sequence) for each in read(path)] == [(b"first", 2**32 - 1)]


def test_the_same_schema_is_there_once(path: Path) -> None:
    with Writer(path) as writer:
        assert writer.add_schema("a/msg/A", "ros2msg", b"") == writer.add_schema("a/msg/A", "ros2msg", b"")
        assert writer.add_schema("a/msg/A", "ros2msg", b"int8 a") == 2


def test_wrong_calls_are_refused_and_cost_nothing(path: Path) -> None:
    with Writer(path) as writer:
        (channel,) = add_channels(writer, 1)
        writer.write(channel, 1, 1, 0, b"good")
        with pytest.raises(McapError, match=r"a message of channel 7, which was not added"):
            writer.write(7, 1, 1, 1, b"")
        with pytest.raises(McapError, match=r"a time is from 0 to .*: -1, 1"):
            writer.write(channel, -1, 1, 2, b"")
        with pytest.raises(McapError, match=r"channel /x has schema 9, which was not added"):
            writer.add_channel(9, "/x", "cdr")
        with pytest.raises(McapError, match=r"a file is there already"):
            Writer(path)
        with pytest.raises(McapError, match=r"no compression 'gzip'"):
            Writer(path.with_name("other"), compression="gzip")
        with pytest.raises(McapError, match=r"cannot be made: No such file"):
            Writer(path.parent / "nowhere" / "x.mcap")
        writer.write(channel, 2, 2, 1, b"too")
    assert [each.data for each in read(path)] == [b"good", b"too"]
    with pytest.raises(McapError, match="the file is closed"):
        writer.write(channel, 2, 2, 1, b"late")
    with pytest.raises(McapError, match="the file is closed"):
        writer.tick()
    writer.close()
    assert len(read(path)) == 2
