"""Compressed bags: data that unpacks to far more than it should fills neither memory nor disk, and is a line."""

from __future__ import annotations

import contextlib
import errno
import shutil
import sqlite3
from pathlib import Path
from typing import Any

import pytest

from robolink.bag import limits, zstd
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from tests.support.bags import ten_messages, write

MESSAGES = ten_messages()


def bomb(size: int) -> bytes:
    """Return `size` zeros, compressed to nearly nothing."""
    return zstd.compress(bytes(size))


def test_a_message_that_unpacks_to_too_much_is_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "bag", MESSAGES, storage="sqlite3", compression="zstd", compression_mode="message")
    (file,) = (tmp_path / "bag").glob("*.db3")
    with contextlib.closing(sqlite3.connect(file)) as database:
        database.execute("UPDATE messages SET data = ? WHERE id = 5", (bomb(1 << 20),))
        database.commit()
    monkeypatch.setattr(limits, "PIECE", 1 << 19)
    with open_bag(tmp_path / "bag") as bag:
        found = [each.log_time for each in bag.messages()]
        assert found == [each.stamp for number, each in enumerate(MESSAGES, start=1) if number != 5]
        assert [each.partition(": ")[2] for each in bag.problems] == [
            "a message of /chatter cannot be decompressed: it is more than 524,288 bytes; it is left out"
        ]


@pytest.mark.parametrize("content", [b"", b"not a frame", bomb(99)[:-3], bomb(99)[:5] + b"\xff" * 20])
def test_damaged_data_is_a_line(content: bytes) -> None:
    with pytest.raises(BagError, match="it cannot be decompressed: ") as caught:
        zstd.decompress(content, "it")
    assert "\n" not in str(caught.value)


def test_messages_of_several_frames_are_whole() -> None:
    assert zstd.decompress(zstd.compress(b"one") + zstd.compress(b"two"), "it") == b"onetwo"


def test_a_file_that_unpacks_to_something_else_is_not_unpacked_as_a_whole(tmp_path: Path) -> None:
    path = tmp_path / "bag_0.mcap.zstd"
    path.write_bytes(bomb(64 << 20))
    with pytest.raises(BagError) as caught, open_bag(path):
        pass
    assert str(caught.value) == (f"{path} begins with zeros: its disk lost power, or it was never copied as a whole")


def test_a_file_that_unpacks_to_too_much_fills_no_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "bag_0.mcap.zstd"
    path.write_bytes(zstd.compress(b"\x89MCAP0\r\n" + bytes(8 << 20)))
    monkeypatch.setattr(limits, "FILE", 1 << 20)
    with pytest.raises(BagError) as caught, open_bag(path):
        pass
    most = max(1 << 20, limits.FILE_RATIO * path.stat().st_size)
    assert str(caught.value) == f"{path} cannot be decompressed: {most:,} bytes at most are unpacked of such a file"


def test_of_a_file_that_is_refused_nothing_is_unpacked(tmp_path: Path) -> None:
    def refuse(head: bytes) -> None:
        raise BagError(f"begins with {len(head)} bytes")

    (tmp_path / "packed").write_bytes(bomb(1 << 20))
    with pytest.raises(BagError, match="begins with 16 bytes"):
        zstd.decompress_file(tmp_path / "packed", tmp_path / "plain", refuse)
    assert not (tmp_path / "plain").exists()


def test_a_full_disk_for_the_copy_of_a_compressed_file_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(tmp_path / "bag", MESSAGES, compression="zstd", compression_mode="file")

    def full(*_: Any) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(shutil, "copyfileobj", full)
    (file,) = (tmp_path / "bag").glob("*.zstd")
    with pytest.raises(BagError) as caught, open_bag(tmp_path / "bag"):
        pass
    assert str(caught.value).startswith(f"{file} cannot be decompressed: No space left on device (into ")
