"""Writing of bags: a folder with storage files, which are split, and a metadata.yaml that is always whole."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import TracebackType
from typing import NamedTuple

from robolink.bag import zstd
from robolink.bag.metadata import BagMetadata, FileInformation, metadata_of, write_metadata
from robolink.bag.storage.base import StorageWriter, Written
from robolink.bag.storage.opening import STORAGES, check_storage, storage_writer
from robolink.bag.topic import BagError, BagTopic
from robolink.exceptions import nearest
from robolink.system import clocks
from robolink.system.processes import ROS_DISTRO
from robolink.system.terminal import shown

LARGEST_SUMMARY = 1 << 20
"""Size of a file's index, in bytes, at which a new file begins: the index is written again with each flush."""
LEAST_SPAN = 10 * 10**9
"""Recorded time of a file, in nanoseconds, before it ends for its index: thousands of topics alone may be 1 MiB."""
REFRESH = 2.0
"""Seconds after which metadata.yaml is written again while messages come."""
MODES = ("", "file", "message")
"""Ways to compress: chunks within the file (the default), the whole file once it is closed, or each message."""


class _Finished(NamedTuple):
    """File that is closed: its path, its messages, and its size in bytes."""

    path: Path
    written: Written
    size: int


def _ignore_split(closed: Path, opened: Path) -> object:
    return None


class BagWriter:
    """Writer of a bag. Use it as a context manager, or call `close`.

    Args:
        path: Folder of the bag, which must not exist or be empty.
        storage: mcap or sqlite3.
        compression: '', zstd or lz4 (of chunks only).
        compression_mode: '' compresses chunks, which MCAP alone has; `file` and `message` are rosbag2's other ways.
        max_size: Size of a file, in bytes, at which the next one begins; 0 is never.
        max_duration: Recorded time of a file, in seconds, at which the next one begins; 0 is never.
        max_files: Number of files to keep: the oldest is deleted when one more begins; 0 is all.
        custom_data: Texts that metadata.yaml keeps.
        ros_distro: Distribution that the bag says it is from; by default ROS_DISTRO, or jazzy.

    Raises:
        BagError: for a folder that is there, an unknown storage or compression.
        OSError: if the folder or a file in it cannot be written.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        storage: str = "mcap",
        compression: str = "",
        compression_mode: str = "",
        max_size: int = 0,
        max_duration: float = 0.0,
        max_files: int = 0,
        custom_data: Mapping[str, str] | None = None,
        ros_distro: str = "",
    ) -> None:
        self.path = Path(path)
        self.storage, self.compression, self.compression_mode = storage, compression, compression_mode
        _check(storage, compression, compression_mode)
        self.on_split: Callable[[Path, Path], object] = _ignore_split
        self.files: list[Path] = []
        self._max_size, self._max_duration, self._max_files = max_size, round(max_duration * 1e9), max_files
        self._looks_always = bool(max_size or max_duration) or compression_mode == "message"
        self._custom = dict(custom_data or {})
        self._distro = ros_distro or os.environ.get("ROS_DISTRO", ROS_DISTRO)
        self._topics: list[BagTopic] = []
        self._numbers: dict[tuple[str, str], int] = {}
        self._finished: list[_Finished] = []
        self._opened = 0
        self._is_closed = False
        self._in_file: list[int] = []
        self._begun: int | None = None
        _make_folder(self.path)
        self._open_next()
        self._refresh()

    @property
    def size(self) -> int:
        """Bytes written so far, of all files."""
        return sum(each.size for each in self._finished) + (self._file.size if self._is_writing else 0)

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of messages written so far, by the names of topics."""
        found: dict[str, int] = {}
        for topic, count in self._counted(self._written()):
            found[topic.name] = found.get(topic.name, 0) + count
        return found

    @property
    def message_count(self) -> int:
        """Number of messages written so far."""
        return sum(sum(each.counts) for each in self._written())

    def add_topic(self, topic: BagTopic) -> int:
        """Add a topic, at any time, and return its number; the same name and type again return the same number."""
        key = topic.name, topic.type_name
        if key not in self._numbers:  # later profiles do not count: a channel of an MCAP cannot be changed
            self._numbers[key] = len(self._topics)
            self._topics.append(topic)
            self._in_file.append(self._file.add_topic(topic))
            self._refresh_at = 0.0
        return self._numbers[key]

    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        """Write a message; a new file begins before it where it is time.

        Args:
            topic: Number from `add_topic`.
            log_time: Time at which it was received, in nanoseconds since 1970.
            publish_time: Time at which it was sent, in nanoseconds since 1970.
            sequence: Number that its sender gave it; 0 if unknown.
            data: The serialized message.
        """
        if self._looks:  # the hot path goes by; what was written, the file itself counts
            data = self._looked_at(log_time, data)
        self._write(self._in_file[topic], log_time, publish_time, sequence, data)

    def tick(self) -> None:
        """Do what is due: show readers what was written, and refresh metadata.yaml. Called often, as each 50 ms."""
        self._file.tick()
        self._look_at_summary()
        if clocks.monotonic() >= self._refresh_at:
            self._refresh()

    def flush(self) -> None:
        """Show readers all that was written."""
        self._file.flush()
        self._look_at_summary()
        self._refresh()

    def split(self) -> None:
        """Close the current file and begin the next one, with the same topics."""
        closed = self._close_file(None)
        self._open_next()
        while self._max_files and len(self.files) > self._max_files:
            self._forget_oldest()
        self._refresh()
        self.on_split(closed, self.files[-1])

    def close(self) -> BagMetadata:
        """Close the bag, and return its metadata."""
        if not self._is_closed:
            self._is_closed, self._final = True, self._metadata()  # if the disk fails now
            if self._is_writing:
                self._close_file(self._final)
            self._final = self._metadata()
            write_metadata(self.path, self._final)
        return self._final

    def __enter__(self) -> BagWriter:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _look_at_summary(self) -> None:
        """Note if the index, which grows when it is shown, is so large that a new file is due."""
        self._looks = self._looks_always or self._file.summary_size >= LARGEST_SUMMARY

    def _looked_at(self, log_time: int, data: bytes | memoryview) -> bytes | memoryview:
        """Begin a new file if it is time, and return the message as it is written."""
        if self._begun is None:
            written = self._file.written
            self._begun = written.start_time if any(written.counts) else None
        if self._begun is not None and self._is_full(log_time - self._begun):
            self.split()
        self._begun = log_time if self._begun is None else min(self._begun, log_time)
        return zstd.compress(data) if self.compression_mode == "message" else data

    def _is_full(self, span: int) -> bool:
        if self._max_size and self._file.size >= self._max_size:
            return True
        if self._max_duration and span >= self._max_duration:
            return True
        return span >= LEAST_SPAN and self._file.summary_size >= LARGEST_SUMMARY

    def _open_next(self) -> None:
        path = self.path / f"{self.path.resolve().name}_{self._opened}{STORAGES[self.storage]}"
        chunks = "" if self.compression_mode else self.compression
        metadata = self._metadata() if self.files else self._metadata_of([(path, Written([], 0, 0))])
        self._file: StorageWriter = storage_writer(path, self.storage, chunks, metadata)
        self._write = self._file.write
        self._opened += 1
        self.files.append(path)
        self._begun = None  # its first log time, once that matters
        self._looks = self._looks_always  # at each message
        self._in_file = [self._file.add_topic(each) for each in self._topics]

    def _close_file(self, metadata: BagMetadata | None) -> Path:
        self._file.close(metadata or self._metadata())
        path = self.files[-1]
        if self.compression_mode == "file":
            self.files[-1] = path = zstd.compress_file(path)
        self._finished.append(_Finished(path, self._file.written, path.stat().st_size))
        return path

    def _forget_oldest(self) -> None:
        """Delete the oldest file, and count no longer what was in it."""
        self._finished.pop(0)
        self.files.pop(0).unlink(missing_ok=True)

    @property
    def _is_writing(self) -> bool:
        """False between two files: when the next one cannot be made, it stays so."""
        return len(self._finished) < len(self.files)

    def _written(self) -> list[Written]:
        """Return the messages of each file."""
        found = [each.written for each in self._finished]
        return [*found, self._file.written] if self._is_writing else found

    def _counted(self, written: Iterable[Written]) -> list[tuple[BagTopic, int]]:
        """Return the topics with the numbers of their messages."""
        sums = [0] * len(self._topics)
        for each in written:
            for number, count in enumerate(each.counts):  # a file that was closed lacks the topics of later
                sums[number] += count
        return list(zip(self._topics, sums, strict=True))

    def _metadata(self) -> BagMetadata:
        return self._metadata_of(list(zip(self.files, self._written(), strict=True)))

    def _metadata_of(self, files: list[tuple[Path, Written]]) -> BagMetadata:
        mode = self.compression_mode
        return metadata_of(
            self._counted(written for _, written in files),
            [_described(path, written) for path, written in files],
            storage_identifier=self.storage,
            compression_format=self.compression if mode else "",
            compression_mode=mode,
            custom_data=self._custom,
            ros_distro=self._distro,
        )

    def _refresh(self) -> None:
        self._refresh_at = clocks.monotonic() + REFRESH
        write_metadata(self.path, self._metadata())


def _described(path: Path, written: Written) -> FileInformation:
    counts, start, end = written
    return FileInformation(path.name, start, end - start, sum(counts))


def _check(storage: str, compression: str, mode: str) -> None:
    check_storage(storage)
    if mode not in MODES:
        raise BagError(f"no compression mode '{shown(mode)}'{nearest(mode, MODES)}: there are file and message")
    if compression not in {"", "zstd", "lz4"}:
        known = ("zstd", "lz4")
        raise BagError(f"no compression '{shown(compression)}'{nearest(compression, known)}: there are zstd and lz4")
    if mode and compression != "zstd":
        raise BagError(f"the compression mode '{mode}' needs the format zstd, got '{compression or 'none'}'")
    if compression and not mode and storage == "sqlite3":
        raise BagError(
            f"a file of sqlite3 has no {compression} inside: choose mcap, or the compression mode 'file' or 'message'"
        )
    if mode:
        zstd.compress(b"")  # fails here rather than at the first message


def _make_folder(path: Path) -> None:
    if path.is_dir() and not any(path.iterdir()):
        return
    try:
        path.mkdir(parents=True)
    except FileExistsError:
        raise BagError(f"'{path}' exists already: choose another folder for the bag, or delete it") from None
