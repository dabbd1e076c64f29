"""Bags that rosbags wrote are read, and rosbags reads ours: versions 8 and 9, sqlite3 and MCAP, compressed or not."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.bag.reader import open_bag
from tests.support.bags import (
    CHATTER,
    LATCHED,
    MAP,
    START,
    STRING,
    read,
    read_by_rosbags,
    ten_messages,
    write,
    write_theirs,
)

MESSAGES = ten_messages()


@pytest.mark.parametrize("mode", ["none", "file", "message", "storage"])
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
@pytest.mark.parametrize("version", [8, 9])
def test_a_bag_that_rosbags_wrote_is_read(tmp_path: Path, version: int, storage: str, mode: str) -> None:
    if (storage, mode) == ("sqlite3", "storage"):
        return  # rosbags refuses it, since sqlite3 has no compression of its own
    write_theirs(tmp_path / "bag", MESSAGES, version=version, storage=storage, mode=mode)
    assert read(tmp_path / "bag") == MESSAGES
    with open_bag(tmp_path / "bag") as bag:
        assert bag.topics == [CHATTER, MAP]
        assert bag.counts == {"/chatter": 6, "/map": 4}
        assert (bag.start_time, bag.end_time) == (START, START + 9 * 10**9)
        assert bag.metadata.version == version
        assert bag.metadata.custom_data == {"robot": "r2"}
        assert bag.metadata.ros_distro == "rosbags"
        assert bag.metadata.compression_mode == (mode if mode in {"file", "message"} else "")
        assert bag.topics[1].offered_qos == (LATCHED,)


@pytest.mark.parametrize("mode", ["", "file", "message"])
@pytest.mark.parametrize("compression", ["", "zstd", "lz4"])
@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_of_ours_is_read_by_rosbags(tmp_path: Path, storage: str, compression: str, mode: str) -> None:
    if (mode and compression != "zstd") or (storage == "sqlite3" and compression and not mode):
        return  # such a bag cannot be: see test_writer.py
    write(
        tmp_path / "bag", MESSAGES, storage=storage, compression=compression, compression_mode=mode,
        custom_data={"robot": "c3po", "number": "012", "empty": ""},
    )  # fmt: skip
    assert read(tmp_path / "bag") == MESSAGES
    theirs = read_by_rosbags(tmp_path / "bag")
    assert theirs.messages == MESSAGES
    assert theirs.definitions == {"/chatter": STRING, "/map": STRING}
    assert theirs.hashes == {"/chatter": CHATTER.type_hash, "/map": MAP.type_hash}
    assert theirs.counts == {"/chatter": 6, "/map": 4}
    assert theirs.custom_data == {"robot": "c3po", "number": "012", "empty": ""}
    assert theirs.qos["/chatter"] == []
    (latched,) = theirs.qos["/map"]
    assert (latched.history.name, latched.depth, latched.durability.name) == ("KEEP_LAST", 1, "TRANSIENT_LOCAL")
    assert (latched.deadline.sec, latched.deadline.nsec) == (9223372036, 854775807)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_of_several_files_is_read_by_rosbags(tmp_path: Path, storage: str) -> None:
    write(tmp_path / "bag", MESSAGES, storage=storage, max_duration=3.0)
    assert len(list((tmp_path / "bag").glob("bag_*"))) == 4
    assert read_by_rosbags(tmp_path / "bag").messages == MESSAGES
    assert read(tmp_path / "bag") == MESSAGES


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_file_without_its_folder_is_read(tmp_path: Path, storage: str) -> None:
    write_theirs(tmp_path / "bag", MESSAGES, storage=storage)
    (file,) = (each for each in (tmp_path / "bag").iterdir() if each.suffix != ".yaml")
    with open_bag(file) as bag:
        assert bag.topics == [CHATTER, MAP]
        assert bag.counts == {"/chatter": 6, "/map": 4}
        assert bag.metadata.storage_identifier == storage
    (tmp_path / "bag" / "metadata.yaml").unlink()
    assert read(tmp_path / "bag") == MESSAGES
    assert read(file) == MESSAGES
