"""Writer of bags: its folder, splits, metadata.yaml at every moment, and what it refuses."""

from __future__ import annotations

import contextlib
import errno
from itertools import pairwise
from pathlib import Path

import pytest

from robolink.bag import writer as writing
from robolink.bag.metadata import read_metadata, write_metadata
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.bag.writer import BagWriter
from tests.support.bags import CHATTER, MAP, START, read, read_by_rosbags, ten_messages, text, write

MESSAGES = ten_messages()
STORAGES = pytest.mark.parametrize("storage", ["mcap", "sqlite3"])


@STORAGES
def test_a_bag_without_messages_is_one(tmp_path: Path, storage: str) -> None:
    write(tmp_path / "bag", storage=storage)
    with open_bag(tmp_path / "bag") as bag:
        assert bag.topics == [CHATTER, MAP]
        assert bag.metadata.message_count == 0
        assert list(bag.messages()) == []
    assert read_by_rosbags(tmp_path / "bag").messages == []


def test_the_same_topic_again_has_the_same_number(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        assert [writer.add_topic(each) for each in (CHATTER, MAP, CHATTER)] == [0, 1, 0]


@STORAGES
def test_a_file_that_is_large_enough_is_followed_by_the_next(tmp_path: Path, storage: str) -> None:
    splits: list[tuple[str, str]] = []
    with BagWriter(tmp_path / "bag", storage=storage, max_size=5000) as writer:
        writer.on_split = lambda closed, opened: splits.append((closed.name, opened.name))
        number = writer.add_topic(CHATTER)
        for each in range(30):
            writer.write(number, START + each, START + each, each, text("x" * 1000))
    ending = {"mcap": "mcap", "sqlite3": "db3"}[storage]
    names = [f"bag_{each}.{ending}" for each in range(len(writer.files))]
    assert [each.name for each in writer.files] == names == read_metadata(tmp_path / "bag").relative_file_paths
    assert 5 <= len(names) <= 8
    assert splits == list(pairwise(names))
    assert [each.stamp - START for each in read(tmp_path / "bag")] == list(range(30))


@pytest.mark.slow
def test_a_file_whose_index_is_large_is_followed_by_the_next(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writing, "LARGEST_SUMMARY", 2000)
    with BagWriter(tmp_path / "bag") as writer:
        for number in range(100):
            topic = writer.add_topic(CHATTER._replace(name=f"/chatter{number}"))
            writer.write(topic, START + number * 10**9, START, 0, text("x"))
            writer.flush()
    assert 5 < len(writer.files) <= 10
    assert len(read(tmp_path / "bag")) == 100


def test_a_file_ends_after_its_time(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES, max_duration=3.0)
    metadata = read_metadata(tmp_path / "bag")
    assert [each.message_count for each in metadata.files] == [3, 3, 3, 1]
    assert [each.duration for each in metadata.files] == [2 * 10**9] * 3 + [0]


def test_only_the_newest_files_are_kept(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag", max_duration=2.0, max_files=2) as writer:
        numbers = {"/map": writer.add_topic(MAP)}
        for each in MESSAGES:
            if each.topic not in numbers:
                numbers[each.topic] = writer.add_topic(CHATTER)
            writer.write(numbers[each.topic], each.stamp, each.stamp, 0, each.data)
        assert writer.counts == {"/map": 2, "/chatter": 2}
    names = ["bag_3.mcap", "bag_4.mcap"]
    assert sorted(each.name for each in (tmp_path / "bag").iterdir()) == [*names, "metadata.yaml"]
    metadata = read_metadata(tmp_path / "bag")
    assert metadata.relative_file_paths == names
    assert (metadata.message_count, metadata.starting_time) == (4, MESSAGES[6].stamp)
    assert read(tmp_path / "bag") == MESSAGES[6:] == read_by_rosbags(tmp_path / "bag").messages


def test_a_topic_that_comes_late_is_in_all_later_files(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        first = writer.add_topic(CHATTER)
        writer.write(first, START, START, 0, text("a"))
        late = writer.add_topic(MAP)
        writer.split()
        writer.write(late, START + 1, START, 0, text("b"))
        assert writer.counts == {"/chatter": 1, "/map": 1}
    assert [each.topic for each in read(tmp_path / "bag")] == ["/chatter", "/map"]


@STORAGES
def test_a_bag_that_is_being_written_can_be_read(tmp_path: Path, storage: str) -> None:
    writer = BagWriter(tmp_path / "bag", storage=storage)
    numbers = {each.name: writer.add_topic(each) for each in (CHATTER, MAP)}
    for count, each in enumerate(MESSAGES, start=1):
        writer.write(numbers[each.topic], each.stamp, each.stamp, 0, each.data)
        writer.flush()
        assert read(tmp_path / "bag") == MESSAGES[:count]
        assert read_metadata(tmp_path / "bag").message_count == count
    writer.close()


def test_metadata_names_a_topic_soon_after_it_came(tmp_path: Path) -> None:
    writer = BagWriter(tmp_path / "bag")
    writer.add_topic(CHATTER)
    writer.tick()
    assert [topic.name for topic, _ in read_metadata(tmp_path / "bag").topics_with_message_count] == ["/chatter"]
    writer.close()


def test_closing_twice_is_closing_once(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        assert writer.close() is writer.close()


def test_times_that_go_back_are_in_order_when_read(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        number = writer.add_topic(CHATTER)
        for stamp in (5, 3, 9, 1):
            writer.write(number, START + stamp, START, 0, text("x"))
    with open_bag(tmp_path / "bag") as bag:
        assert (bag.start_time, bag.end_time) == (START + 1, START + 9)
    assert [each.stamp - START for each in read(tmp_path / "bag")] == [1, 3, 5, 9]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"storage": "mcpa"}, "no storage named 'mcpa' (did you mean 'mcap'?): there are mcap and sqlite3"),
        ({"compression": "zst"}, "no compression 'zst' (did you mean 'zstd'?): there are zstd and lz4"),
        ({"compression_mode": "flie"}, "no compression mode 'flie' (did you mean 'file'?): there are file and message"),
        ({"compression_mode": "file"}, "the compression mode 'file' needs the format zstd, got 'none'"),
        ({"compression_mode": "message", "compression": "lz4"}, "mode 'message' needs the format zstd, got 'lz4'"),
        ({"storage": "sqlite3", "compression": "zstd"}, "a file of sqlite3 has no zstd inside"),
    ],
)
def test_what_there_is_not_is_refused(tmp_path: Path, options: dict[str, str], words: str) -> None:
    with pytest.raises(BagError) as refused:
        BagWriter(tmp_path / "bag", **options)  # type: ignore[arg-type]
    assert words in str(refused.value)


def test_a_folder_that_is_there_is_not_written_to(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    with pytest.raises(BagError, match="exists already: choose another folder"):
        BagWriter(tmp_path / "bag")
    assert read(tmp_path / "bag") == MESSAGES


def test_an_empty_folder_is_used(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    write(tmp_path / "bag", MESSAGES)
    assert read(tmp_path / "bag") == MESSAGES


@STORAGES
def test_a_bag_whose_next_file_cannot_be_made_keeps_what_it_has(tmp_path: Path, storage: str) -> None:
    writer = BagWriter(tmp_path / "bag", storage=storage)
    number = writer.add_topic(CHATTER)
    writer.write(number, START, START, 0, text("x"))
    (tmp_path / "bag" / f"bag_1{writer.files[0].suffix}").write_bytes(b"")
    with pytest.raises(BagError):
        writer.split()
    size = writer.size
    metadata = writer.close()
    assert (metadata.message_count, metadata.relative_file_paths) == (1, [writer.files[0].name])
    assert writer.size == size == writer.files[0].stat().st_size


@STORAGES
def test_metadata_has_the_times_of_messages_that_came_in_any_order(tmp_path: Path, storage: str) -> None:
    with BagWriter(tmp_path / "bag", storage=storage) as writer:
        number = writer.add_topic(CHATTER)
        for stamp in (5, 3, 9, 1):
            writer.write(number, START + stamp, START, 0, text("x"))
            writer.flush()
        found = read_metadata(tmp_path / "bag")
        assert (found.starting_time, found.duration, found.message_count) == (START + 1, 8, 4)
        writer.split()
        writer.write(number, START + 20, START, 0, text("x"))
        assert (writer.counts, writer.message_count) == ({"/chatter": 5}, 5)
    assert [each.message_count for each in read_metadata(tmp_path / "bag").files] == [4, 1]


def test_a_database_on_a_full_disk_is_a_line_and_keeps_what_was_written(tmp_path: Path) -> None:
    writer = BagWriter(tmp_path / "bag", storage="sqlite3")
    number = writer.add_topic(CHATTER)
    writer.write(number, START, START, 1, text("first"))
    writer.flush()
    (file,) = (tmp_path / "bag").glob("*.db3")
    pages = writer._file._database.execute("PRAGMA page_count").fetchone()[0]  # type: ignore[attr-defined]
    writer._file._database.execute(f"PRAGMA max_page_count = {pages + 1}")  # type: ignore[attr-defined]
    with pytest.raises(BagError) as caught:
        writer.write(number, START + 1, START + 1, 2, bytes(1 << 20))
    assert str(caught.value) == f"{file} cannot be written: database or disk is full"
    with contextlib.suppress(BagError):
        writer.close()
    assert [each.stamp for each in read(tmp_path / "bag")] == [START]


def test_a_full_disk_leaves_the_old_metadata_and_is_told_with_its_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    write(tmp_path / "bag", MESSAGES)
    before = read_metadata(tmp_path / "bag")
    monkeypatch.setattr(Path, "write_text", full)
    with pytest.raises(OSError, match="No space left") as caught:
        write_metadata(tmp_path / "bag", before)
    assert caught.value.filename == str(tmp_path / "bag" / "metadata.yaml")
    assert sorted(each.name for each in (tmp_path / "bag").iterdir()) == ["bag_0.mcap", "metadata.yaml"]
