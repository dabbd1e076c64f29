"""Reindexing: metadata.yaml is made anew from the files, and files of killed recorders are made whole."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from robolink.bag.converting import reindex
from robolink.bag.metadata import read_metadata
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from robolink.bag.writer import BagWriter
from robolink.cli.main import main
from tests.support.bags import CHATTER, MAP, START, read, read_by_rosbags, ten_messages, text, write, write_theirs

MESSAGES = ten_messages()
Captured = pytest.CaptureFixture[str]


@pytest.mark.parametrize("mode", ["none", "file", "message", "storage"])
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_metadata_is_made_anew(tmp_path: Path, storage: str, mode: str) -> None:
    if (storage, mode) == ("sqlite3", "storage"):
        return  # there is none
    bag = tmp_path / "bag"
    write_theirs(bag, MESSAGES, storage=storage, mode=mode)
    before = read_metadata(bag)
    (bag / "metadata.yaml").unlink()
    reindex(bag)
    after = read_metadata(bag)
    assert after.version == 8
    after.version = before.version
    assert after == before
    assert read(bag) == MESSAGES == read_by_rosbags(bag).messages


def killed(tmp_path: Path, storage: str) -> Path:
    """Return a bag as it is when its recorder is killed."""
    writer = BagWriter(tmp_path / "live" / "bag", storage=storage, max_size=3000, custom_data={"robot": "r2"})
    numbers = {each.name: writer.add_topic(each) for each in (CHATTER, MAP)}
    for number, each in enumerate(MESSAGES):
        writer.write(numbers[each.topic], each.stamp, each.stamp, number, each.data)
        writer.write(numbers["/chatter"], each.stamp, each.stamp, number, text("x" * 900))
        writer.flush()
    shutil.copytree(tmp_path / "live" / "bag", tmp_path / "bag")
    writer.close()
    return tmp_path / "bag"


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_killed_recorders_bag_is_made_whole(tmp_path: Path, storage: str) -> None:
    bag = killed(tmp_path, storage)
    before = read(bag)
    assert len(before) == 20
    lines: list[str] = []
    metadata = reindex(bag, lines.append)
    assert read(bag) == before == read_by_rosbags(bag).messages
    assert metadata.message_count == 20
    assert metadata.custom_data == {"robot": "r2"}
    assert sum(each.stat().st_size for each in bag.iterdir()) < 100_000, "no room is left for what will not come"
    assert {each.suffix for each in bag.iterdir()} == {".yaml", ".mcap" if storage == "mcap" else ".db3"}
    if storage == "mcap":
        assert len(lines) == 1, "the files before the last are whole"


def test_a_file_that_is_cut_is_made_whole(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    file = tmp_path / "bag" / "bag_0.mcap"
    os.truncate(file, file.stat().st_size - 100)
    reindex(tmp_path / "bag")
    assert read(tmp_path / "bag") == MESSAGES == read_by_rosbags(tmp_path / "bag").messages


def test_a_single_file_is_made_whole(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    file = tmp_path / "bag" / "bag_0.mcap"
    os.truncate(file, file.stat().st_size - 100)
    reindex(file)
    assert read_by_rosbags(file).messages == MESSAGES


def test_files_that_cannot_be_read_are_told_and_stay(
    tmp_path: Path, capsys: Captured, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write(Path("bag"), MESSAGES, max_duration=5.0)
    Path("bag/bag_1.mcap").write_bytes(b"nothing")
    assert main(["bag", "reindex", "bag"]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "Beginning reindexing bag in directory: bag",
        f"{Path('bag/bag_1.mcap')} is neither an MCAP file nor a sqlite3 database",
        "Reindexing complete.",
    ]
    assert read(Path("bag")) == MESSAGES[:5]
    assert Path("bag/bag_1.mcap").read_bytes() == b"nothing"


def test_more_files_than_metadata_names_are_taken_in(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES[:5])
    write(tmp_path / "other", MESSAGES[5:])
    shutil.copy(tmp_path / "other" / "other_0.mcap", tmp_path / "bag" / "bag_1.mcap")
    with open_bag(tmp_path / "bag") as bag:
        assert bag.metadata.message_count == 5
    assert reindex(tmp_path / "bag").message_count == 10
    assert read(tmp_path / "bag") == MESSAGES


def test_what_is_no_bag_is_refused(tmp_path: Path) -> None:
    for path in (tmp_path, tmp_path / "nothing"):
        with pytest.raises(BagError):
            reindex(path)
    assert list(tmp_path.iterdir()) == []


def test_the_start_of_a_bag_that_begins_with_nothing_is_that_of_its_messages(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        number = writer.add_topic(CHATTER)
        writer.split()
        writer.write(number, START, START, 0, text("x"))
    assert reindex(tmp_path / "bag").starting_time == START
