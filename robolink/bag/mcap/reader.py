"""Reader of MCAP files: by their index, or by a scan of those that are broken or have none."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from operator import attrgetter
from pathlib import Path

from robolink.bag.mcap.blocks import Block, Catalog, Source, in_log_order, load, loaded, messages_of
from robolink.bag.mcap.chunk import MissingCompressionError
from robolink.bag.mcap.index import read_index
from robolink.bag.mcap.records import (
    MAGIC,
    Attachment,
    Buffer,
    Channel,
    Malformed,
    McapError,
    Message,
    Schema,
    Statistics,
    Unindexed,
)
from robolink.bag.mcap.scan import scan

OTHERS = {
    b"SQLite format 3": "an SQLite database, as rosbag2's .db3 files are",
    b"#ROSBAG V": "a bag of ROS 1",
    b"\x28\xb5\x2f\xfd": "packed with zstd as a whole: unpack it first",
    b"\x04\x22\x4d\x18": "packed with LZ4 as a whole: unpack it first",
    b"rosbag2_bagfile": "the metadata.yaml of a bag",
}
"""Beginnings of other files that are given in an MCAP's place."""
ATTEMPTS = 5
"""Times that the index is read when it does not fit: a writer may have changed it meanwhile."""


class Reader:
    """An MCAP file that is read, whole or not, also while it is written.

    It is for one thread; iterators of its messages may be used by turns.

    Args:
        path: Path of the file.

    Raises McapError if there is no such file, it is none of MCAP's, or it is empty; and MissingCompressionError for a
    broken file whose chunks cannot be unpacked here.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._broken: set[int] = set()
        """Places of chunks whose faults are among the problems."""
        try:
            self._source = Source(self.path)
        except OSError as error:
            raise McapError(f"{self.path} cannot be read: {error.strerror or error}") from None
        try:
            self._catalog = self._read()
        except OSError as error:
            self._source.close()
            raise McapError(f"{self.path} cannot be read: {error.strerror or error}") from None
        except McapError as error:
            self._source.close()
            raise type(error)(f"{self.path}: {error}") from None

    def __enter__(self) -> Reader:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def profile(self) -> str:
        """Kind of messages it holds, such as ``ros2``."""
        return self._catalog.profile

    @property
    def library(self) -> str:
        """Name of the program that wrote it."""
        return self._catalog.library

    @property
    def schemas(self) -> dict[int, Schema]:
        """Schemas by id."""
        return self._catalog.schemas

    @property
    def channels(self) -> dict[int, Channel]:
        """Channels by id."""
        return self._catalog.channels

    @property
    def statistics(self) -> Statistics:
        """Number and time of the messages."""
        return self._catalog.statistics

    @property
    def metadata(self) -> list[tuple[str, dict[str, str]]]:
        """Names and values of the metadata, in the order in which they were written."""
        return self._catalog.metadata

    @property
    def attachments(self) -> list[Attachment]:
        """Files within the file."""
        return self._catalog.attachments

    @property
    def is_whole(self) -> bool:
        """True if the file has its end and nothing in it was found to be broken when it was opened."""
        return self._catalog.is_whole

    @property
    def problems(self) -> list[str]:
        """Broken places that were found until now, a line each; messages there are left out."""
        return self._catalog.problems

    @property
    def compression(self) -> str:
        """Compression of its chunks, that of the most data: ``""``, ``"zstd"`` or ``"lz4"``."""
        sizes: dict[str, int] = {}
        for block in self._catalog.blocks:
            sizes[block.compression] = sizes.get(block.compression, 0) + block.size
        return max(sizes, key=sizes.__getitem__, default="")

    def messages(
        self,
        channels: Collection[int] | None = None,
        start: int | None = None,
        end: int | None = None,
        *,
        in_log_order: bool = True,
        reverse: bool = False,
    ) -> Iterator[Message]:
        """Iterate over messages.

        Args:
            channels: Ids of their channels; None for all.
            start: First log time, in nanoseconds; None for all from the beginning.
            end: Log time before which they are, in nanoseconds; None for all up to the end.
            in_log_order: False for the order in which they are in the file, which is faster.
            reverse: True for the last one first.

        What is broken is left out and added to `problems`. Raises McapError if the file can no longer be read, and
        MissingCompressionError.
        """
        selected = set(self.channels) if channels is None else set(self.channels).intersection(channels)
        low, high = start or 0, (1 << 64) if end is None else end
        blocks = [
            each
            for each in self._catalog.blocks
            if each.last >= low
            and each.first < high
            and (each.channels is None or not selected.isdisjoint(each.channels))
        ]
        if not in_log_order:
            return self._in_file_order(blocks, selected, low, high, reverse)
        return self._in_log_order(blocks, selected, low, high, reverse)

    def close(self) -> None:
        """Close the file."""
        self._source.close()

    def _in_file_order(
        self, blocks: list[Block], selected: set[int], low: int, high: int, reverse: bool
    ) -> Iterator[Message]:
        for data in loaded(blocks[::-1] if reverse else blocks, self._load):
            found = self._messages(data, selected, low, high)
            yield from reversed(found) if reverse else found

    def _in_log_order(
        self, blocks: list[Block], selected: set[int], low: int, high: int, reverse: bool
    ) -> Iterator[Message]:
        """Iterate in order of log time, over chunks that may overlap."""
        time = attrgetter("last" if reverse else "first")
        blocks = sorted(blocks, key=time, reverse=reverse)
        chunks = (self._messages(data, selected, low, high) for data in loaded(blocks, self._load))
        times = [*map(time, blocks[1:]), None]
        return in_log_order(zip(chunks, times, strict=False), reverse=reverse)

    def _messages(self, data: Buffer | None, selected: set[int], low: int, high: int) -> list[Message]:
        return [] if data is None else messages_of(data, selected, low, high)

    def _load(self, block: Block) -> Buffer | None:
        """Return the records of a block; None if it is broken, which is noted. A thread may call it."""
        try:
            return load(self._source, block)
        except Malformed as error:
            if block.at not in self._broken:
                self._broken.add(block.at)
                self.problems.append(f"byte {block.at}: a chunk: {error}; its messages are left out")
            return None
        except OSError as error:
            raise McapError(f"{self.path} cannot be read: {error.strerror or error}") from None
        except MissingCompressionError as error:
            raise MissingCompressionError(f"{self.path}: {error}") from None

    def _read(self) -> Catalog:
        self._check_magic()
        for _ in range(ATTEMPTS):
            try:
                return read_index(self._source)
            except Malformed as error:
                is_final = isinstance(error, Unindexed)
            size = self._source.size
            self._source.measure()
            if self._source.size == size and is_final:
                break
        return scan(self._source)

    def _check_magic(self) -> None:
        begin = self._source.read(0, 64)
        if not begin:
            raise McapError("it is empty: no bag was written here")
        if begin.startswith(MAGIC):
            return
        if begin[:5] == MAGIC[:5] and len(begin) >= len(MAGIC) and begin[6:8] == MAGIC[6:8]:
            version = chr(begin[5]) if chr(begin[5]).isalnum() else f"0x{begin[5]:02x}"
            raise McapError(f"its format is MCAP version {version}; robolink reads version 0: update robolink")
        if MAGIC.startswith(begin):
            raise McapError(f"it is cut after {len(begin)} bytes: no message is in it")
        other = next((words for start, words in OTHERS.items() if begin.startswith(start)), "")
        raise McapError("it is not an MCAP file" + (f", but {other}" if other else f": it begins with {begin[:8]!r}"))


def open_mcap(path: str | Path) -> Reader:
    """Open an MCAP file. Raises McapError as Reader does."""
    return Reader(path)
