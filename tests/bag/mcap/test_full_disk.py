"""Full disks, limits and failing media: the writer stops with one line, and the file keeps what was shown before."""

from __future__ import annotations

import errno
import itertools
import subprocess
import sys
from collections.abc import Iterable
from pathlib import Path

import pytest

from robolink.bag.mcap import McapError, Writer, reindex
from robolink.bag.mcap.disk import DiskFile
from robolink.bag.mcap.records import Buffer
from tests.support.mcap_files import Sent, add_channels, count_by_rosbags, read, read_by_mcap, some_messages

LIMITED = """
import resource, signal, sys
from pathlib import Path
from robolink.bag.mcap import McapError, Writer
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
path, limit = Path(sys.argv[1]), int(sys.argv[2])
writer = Writer(path, flush_every=0.0)
channel = writer.add_channel(writer.add_schema("a/msg/A", "ros2msg", b"uint8[] data"), "/a", "cdr")
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
number = 0
try:
    while number < 100_000:
        writer.write(channel, number, number, number, bytes(10_000))
        number += 1
        writer.tick()
except McapError as error:
    print(error)
for again in (writer.tick, writer.flush, writer.close, lambda: writer.write(channel, 1, 1, 1, b"")):
    try:
        again()
    except McapError as error:
        print(error)
print(number)
"""


class Failing(DiskFile):
    """A file on a disk that is full after some bytes."""

    left = 0
    error = errno.ENOSPC

    def put(self, data: Buffer, at: int) -> None:
        if self.left < len(data):
            super().put(memoryview(data)[: self.left], at)  # as disks do: some of it is there
            self.left = 0
            raise OSError(self.error, "No space left on device")
        self.left -= len(data)
        super().put(data, at)


def full_after(left: int, writer_path: Path) -> Writer:
    def create(path: Path, pieces: Iterable[tuple[int, Buffer]], durable: bool) -> DiskFile:
        file = Failing.create(path, pieces, durable)
        assert isinstance(file, Failing)
        file.left = left
        return file

    return Writer(writer_path, chunk_size=20_000, room=1 << 16, flush_every=0.0, sync_every=0.0, create=create)


def write_until_full(writer: Writer, messages: list[Sent], shown: list[int]) -> None:
    """Write messages and close the file; note how many have been shown."""
    for number, each in enumerate(messages):
        writer.write(each.channel, each.log_time, each.publish_time, each.sequence, each.data)
        if number % 32 == 0:
            writer.flush()
            shown.append(number + 1)
    writer.close()


def write_for_ever(writer: Writer, channel: int) -> None:
    """Write messages until that fails."""
    for number in itertools.count():
        writer.write(channel, number, number, number, b"data")
        writer.tick()


@pytest.mark.parametrize("left", [0, 10, 1_000, 5_003, 77_777, 200_001, 300_000, 431_000, 512_345, 900_000, 1_300_000])
def test_a_full_disk_costs_nothing_that_was_shown(tmp_path: Path, left: int) -> None:
    path = tmp_path / "full.mcap"
    writer = full_after(left, path)
    messages = some_messages(5_000, add_channels(writer, 3))
    shown: list[int] = [0]
    with pytest.raises(McapError) as caught:
        write_until_full(writer, messages, shown)
    assert str(caught.value) == f"{path} cannot be written: No space left on device"
    for call in (writer.tick, writer.flush, lambda: writer.write(1, 1, 1, 1, b"")):
        with pytest.raises(McapError, match="No space left on device"):
            call()
    writer.close()  # says nothing more
    found = read(path)
    assert found == messages[: len(found)]
    assert len(found) >= shown[-1]
    assert read_by_mcap(path) == list(range(len(found)))
    assert count_by_rosbags(path) == len(found)
    assert reindex(path).messages == len(found)
    assert read(path) == found


@pytest.mark.processes
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no limit of a file's size")
@pytest.mark.parametrize("limit", [300_000, 17_000_000, 30_000_001])
def test_the_largest_size_of_a_file(tmp_path: Path, limit: int) -> None:
    path = tmp_path / "limited.mcap"
    command = [sys.executable, "-c", LIMITED, str(path), str(limit)]
    *errors, number = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    assert errors == [f"{path} cannot be written: File too large"] * 4  # the first, tick, flush and write; not close
    found = read_by_mcap(path)
    assert found == list(range(len(found)))
    assert len(found) >= int(number) - 1
    assert count_by_rosbags(path) == len(found)


def test_a_disk_that_fails_in_the_background_is_told(tmp_path: Path) -> None:
    class Broken(DiskFile):
        def save(self) -> None:
            raise OSError(errno.EIO, "Input/output error")

    path = tmp_path / "broken.mcap"
    writer = Writer(path, flush_every=0.0, sync_every=1e-9 * 2, create=Broken.create)
    (channel,) = add_channels(writer, 1)
    with pytest.raises(McapError, match=r"broken.mcap cannot be written: Input/output error"):
        write_for_ever(writer, channel)
    writer.close()
    assert len(read(path)) >= 1


def test_a_repair_that_fails_leaves_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "cut.mcap"
    with Writer(path) as writer:
        channels = add_channels(writer, 2)
        for each in some_messages(100, channels):
            writer.write(each.channel, each.log_time, each.publish_time, each.sequence, each.data)
    path.write_bytes(path.read_bytes()[:-10])
    before = path.read_bytes()

    def full(file: DiskFile, data: Buffer, at: int) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(DiskFile, "put", full)
        with pytest.raises(McapError, match=r"cannot be written: No space left on device"):
            reindex(path)
    assert path.read_bytes() == before
    assert [each.name for each in tmp_path.iterdir()] == ["cut.mcap"]
    assert reindex(path)[1:3] == (100, 2)


def test_a_file_that_is_being_recorded_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "open.mcap"
    with Writer(path) as writer:
        (channel,) = add_channels(writer, 1)
        writer.write(channel, 1, 1, 0, b"data")
        writer.flush()
        with pytest.raises(McapError, match="it is being recorded now"):
            reindex(path)
    assert reindex(path).was_whole
