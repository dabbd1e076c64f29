"""Damaged bags: whatever is in a folder, reading gives messages or a line, and what is whole is never lost."""

from __future__ import annotations

import contextlib
import errno
import shutil
import sqlite3
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.bag import reader as reading
from robolink.bag.converting import reindex
from robolink.bag.metadata import FILE_NAME
from robolink.bag.reader import open_bag
from robolink.bag.topic import BagError
from tests.support.bags import Said, read, ten_messages, write, write_theirs

MESSAGES = ten_messages()


@pytest.fixture(scope="module")
def bags(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """Bags of three files each, and one that rosbags compressed."""
    folder = tmp_path_factory.mktemp("bags")
    write(folder / "mcap", MESSAGES, max_duration=4.0)
    write(folder / "packed", MESSAGES, max_duration=4.0, compression="zstd")
    write(folder / "sqlite3", MESSAGES, max_duration=4.0, storage="sqlite3")
    write(folder / "message", MESSAGES, max_duration=4.0, compression="zstd", compression_mode="message")
    write_theirs(folder / "file", MESSAGES, storage="sqlite3", mode="file")
    return sorted(folder.iterdir())


DAMAGE = st.tuples(
    st.sampled_from(["cut", "overwrite", "insert", "zeros", "delete", "empty"]),
    st.floats(0, 1, exclude_max=True),
    st.binary(min_size=1, max_size=20),
)


def damage(path: Path, kind: str, place: float, other: bytes) -> None:
    """Damage a file in one of a few ways, at a place from 0 to 1."""
    raw = path.read_bytes()
    at = int(len(raw) * place)
    if kind == "delete":
        path.unlink()
    elif kind == "empty":
        path.write_bytes(b"")
    elif kind == "cut":
        path.write_bytes(raw[:at])
    elif kind == "insert":
        path.write_bytes(raw[:at] + other + raw[at:])
    else:
        path.write_bytes(raw[:at] + (other if kind == "overwrite" else bytes(len(other) * 50)) + raw[at + len(other) :])


def tried(path: Path) -> list[Said]:
    """Return what can be read; errors and problems are single lines."""
    try:
        with open_bag(path) as bag:
            found = [Said(each.topic, each.log_time, bytes(each.data)) for each in bag.messages()]
            assert all("\n" not in each for each in bag.problems)
            return found
    except BagError as error:
        assert "\n" not in str(error)  # noqa: PT017
        return []


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::robolink.documents.foreign.FileWarning")  # a key of the metadata is damaged, too
@given(st.data())
def test_a_damaged_bag_is_read_as_far_as_it_is_good(bags: list[Path], data: st.DataObject) -> None:
    source = data.draw(st.sampled_from(bags))
    path = source.parent.parent / "damaged"
    shutil.rmtree(path, ignore_errors=True)
    shutil.copytree(source, path)
    files = sorted(path.iterdir())
    hit = data.draw(st.sampled_from(files))
    damage(hit, *data.draw(DAMAGE))
    found = tried(path)
    if hit.name == FILE_NAME:
        if source.name not in {"message", "file"}:  # which metadata alone tells how to read
            assert found == MESSAGES
    else:
        saved = [each for each in MESSAGES if each in found]
        expected = {4: 6, 2: 0}.get(len(files), 0)  # three files of which one is hit, or a single one
        assert len(saved) >= expected - 1
    with_errors_as_lines(path)


def with_errors_as_lines(path: Path) -> None:
    try:
        reindex(path)
    except BagError as error:
        assert "\n" not in str(error)  # noqa: PT017
    tried(path)


NAMES = st.sampled_from(["a.mcap", "a_0.db3", "b.db3.zstd", "metadata.yaml", "c"])
Folders = pytest.TempPathFactory


@given(st.dictionaries(NAMES, st.binary(max_size=60)))
def test_a_folder_of_anything_is_a_bag_or_a_line(tmp_path_factory: Folders, files: dict[str, bytes]) -> None:
    folder = tmp_path_factory.mktemp("any")
    for name, content in files.items():
        (folder / name).write_bytes(content)
    assert tried(folder) == []
    with_errors_as_lines(folder)


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_future_version_is_read_as_far_as_it_is_the_same(tmp_path: Path, storage: str) -> None:
    write(tmp_path / "bag", MESSAGES, storage=storage)
    text = (tmp_path / "bag" / FILE_NAME).read_text(encoding="utf-8")
    (tmp_path / "bag" / FILE_NAME).write_text(text.replace("version: 8", "version: 31"), encoding="utf-8")
    assert read(tmp_path / "bag") == MESSAGES
    strange = text.replace("version: 8", "version: 31").replace("message_count: 10", "message_count: many")
    (tmp_path / "bag" / FILE_NAME).write_text(strange, encoding="utf-8")
    with open_bag(tmp_path / "bag") as bag:
        assert len(list(bag.messages())) == 10
        (problem,) = bag.problems
        assert "(it is version 31; 1 to 9 are known)" in problem


def test_a_path_out_of_the_folder_is_not_followed(tmp_path: Path) -> None:
    write(tmp_path / "secret", MESSAGES)
    write(tmp_path / "bag", MESSAGES[:2])
    metadata = tmp_path / "bag" / FILE_NAME
    text = metadata.read_text(encoding="utf-8").replace("bag_0.mcap", "../secret/secret_0.mcap")
    metadata.write_text(text, encoding="utf-8")
    assert tried(tmp_path / "bag") == MESSAGES[:2]


def test_a_message_that_cannot_be_decompressed_is_told(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    metadata = tmp_path / "bag" / FILE_NAME
    text = metadata.read_text(encoding="utf-8").replace('compression_mode: ""', "compression_mode: MESSAGE")
    metadata.write_text(text, encoding="utf-8")
    with open_bag(tmp_path / "bag") as bag:
        assert list(bag.messages()) == []
        assert [each.partition(": ")[2].partition(":")[0] for each in bag.problems] == [
            "a message of /map cannot be decompressed",
            "a message of /chatter cannot be decompressed",
        ]


def test_messages_of_a_broken_chunk_are_told_and_not_left_out_in_silence(tmp_path: Path) -> None:
    big = [Said(each.topic, each.stamp, each.data + bytes(300_000)) for each in MESSAGES]
    write(tmp_path / "bag", big)
    (file,) = (tmp_path / "bag").glob("*.mcap")
    raw = bytearray(file.read_bytes())
    raw[200_000] ^= 0xFF
    file.write_bytes(raw)
    with open_bag(tmp_path / "bag") as bag:
        found = list(bag.messages())
        assert 0 < len(found) < len(big)
        (problem,) = bag.problems
        assert problem.startswith(f"{file}: byte ")
        assert "its messages are left out" in problem
        list(bag.messages())
        assert bag.problems == [problem]


def test_rows_of_sqlite_that_are_no_messages_are_left_out_and_told(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES, storage="sqlite3")
    (file,) = (tmp_path / "bag").glob("*.db3")
    with contextlib.closing(sqlite3.connect(file)) as database:
        for stamp, data in (("soon", b"a"), (1.5, b"a"), (MESSAGES[4].stamp, "text"), (MESSAGES[5].stamp, 7)):
            database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (1, ?, ?)", (stamp, data))
        database.commit()
    with open_bag(tmp_path / "bag") as bag:
        assert [each.log_time for each in bag.messages()] == [each.stamp for each in MESSAGES]
        assert (bag.start_time, bag.end_time) == (MESSAGES[0].stamp, MESSAGES[-1].stamp)
        assert bag.problems == [f"{file}: 4 rows are not messages: they are left out"]


def test_a_file_that_metadata_names_twice_is_read_once(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES)
    path = tmp_path / "bag" / FILE_NAME
    line = "    - bag_0.mcap\n"
    text = path.read_text(encoding="utf-8")
    assert line in text
    path.write_text(text.replace(line, f"{line}    - ./bag_0.mcap\n    - elsewhere\\bag_0.mcap\n", 1), encoding="utf-8")
    assert read(tmp_path / "bag") == MESSAGES


def test_a_folder_that_may_not_be_looked_into_is_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise PermissionError(errno.EACCES, "Permission denied", "bag")

    monkeypatch.setattr(reading, "contents", refuse)
    with pytest.raises(BagError, match="cannot be read: Permission denied"):
        open_bag(tmp_path)


def test_a_file_that_was_compressed_when_its_recorder_was_killed_is_found(tmp_path: Path) -> None:
    write(tmp_path / "bag", MESSAGES, max_duration=4.0, compression="zstd", compression_mode="file")
    path = tmp_path / "bag" / FILE_NAME
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("bag_2.mcap.zstd", "bag_2.mcap"), encoding="utf-8")
    assert read(tmp_path / "bag") == MESSAGES


@pytest.mark.skipif(sys.platform == "win32", reason="no name has a backslash there")
def test_a_backslash_in_the_name_of_a_bag_is_one(tmp_path: Path) -> None:
    write(tmp_path / "C:\\bags\\run", MESSAGES)
    assert read(tmp_path / "C:\\bags\\run") == MESSAGES
