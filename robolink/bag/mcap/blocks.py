"""Blocks of a file, which are chunks or runs of records: loading, ahead of time too, and messages in order."""

from __future__ import annotations

import bisect
import contextlib
import heapq
import itertools
import struct
import threading
import zlib
from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from operator import attrgetter
from pathlib import Path
from typing import NamedTuple

from robolink.bag.limits import most_messages
from robolink.bag.mcap.chunk import unpack
from robolink.bag.mcap.records import (
    CHUNK,
    MESSAGE,
    MESSAGE_HEAD,
    OPENING,
    Attachment,
    Buffer,
    Channel,
    Malformed,
    Message,
    Schema,
    Statistics,
    read_chunk_head,
    records,
)

WINDOW = 1 << 16
"""Bytes that are read at a time where records are small."""

_opening = struct.Struct("<BQ")
_head = struct.Struct("<BQHIQQ")
_new_message = tuple.__new__


class Block(NamedTuple):
    """Place of messages in a file, and what is known of them."""

    at: int
    length: int
    first: int
    """First log time in nanoseconds."""
    last: int
    channels: frozenset[int] | None = None
    """Ids of the channels of its messages; None if they are not known."""
    is_chunk: bool = True
    compression: str = ""
    size: int = 0
    """Size of the chunk's data in bytes, when it is unpacked."""
    data: Buffer | None = None
    """Its message records, if they were read already."""


class Catalog:
    """All that is known of a file's contents, without its messages."""

    def __init__(self) -> None:
        self.profile = self.library = ""
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.statistics = Statistics(0, {}, 0, 0)
        self.blocks: list[Block] = []
        self.metadata: list[tuple[str, dict[str, str]]] = []
        self.attachments: list[Attachment] = []
        self.problems: list[str] = []
        self.is_whole = True


class Source:
    """A file that is read at any place.

    Args:
        path: Path of the file. Raises OSError if it cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("rb", buffering=1 << 16)
        self._lock = threading.Lock()
        self.measure()

    def measure(self) -> None:
        """Ask for the file's size, which changes while it is written."""
        self.size = self._file.seek(0, 2)

    def read(self, at: int, length: int) -> bytes:
        """Return bytes of the file, as many as there are. Raises OSError."""
        with self._lock:  # a place and what is read there belong together, and chunks are read ahead
            self._file.seek(at)
            return self._file.read(max(0, min(length, self.size - at)))

    def opening(self, at: int) -> tuple[int, int]:
        """Return the opcode of the record at a place, and its content's length. Raises Malformed at the end."""
        content = self.read(at, OPENING)
        if len(content) < OPENING:
            raise Malformed("the file ends within a record")
        opcode, length = _opening.unpack(content)
        return opcode, length

    def walk(self, at: int, end: int) -> Iterator[tuple[int, int, int]]:
        """Iterate over records from a place to another: place, opcode and length. Raises Malformed at the file's end.

        The file is read in large parts: a summary may have a hundred thousand records.
        """
        window, begin = b"", at
        while at < end:
            if at + OPENING > begin + len(window):
                window, begin = self.read(at, WINDOW), at
                if len(window) < OPENING:
                    raise Malformed("the file ends within a record")
            opcode, length = _opening.unpack_from(window, at - begin)
            yield at, opcode, length
            at += OPENING + length

    def content(self, at: int, length: int) -> bytes:
        """Return the content of the record at a place. Raises Malformed if it is cut."""
        found = self.read(at + OPENING, length)
        if len(found) < length:
            raise Malformed("the file ends within a record")
        return found

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def load(source: Source, block: Block) -> Buffer:
    """Return the records of a block. Raises Malformed if its chunk is broken, or another one than is looked for."""
    if block.data is not None:
        return block.data
    content = source.read(block.at, block.length)
    if len(content) < block.length:
        raise Malformed("it is cut")
    if not block.is_chunk:
        return content
    opcode, length = _opening.unpack_from(content)
    if opcode != CHUNK or length != block.length - OPENING:
        raise Malformed("there is no chunk where the index has one")
    view = memoryview(content)  # its parts are not copied
    head = read_chunk_head(view[OPENING:])
    if (head.first, head.last, head.size, head.compression) != (*block[2:4], block.size, block.compression):
        raise Malformed("it is another chunk than the index has there")
    return chunk_data(view[head.head : head.head + head.packed], head.compression, head.size, head.crc)


def chunk_data(packed: Buffer, compression: str, size: int, crc: int) -> Buffer:
    """Return a chunk's records. Raises Malformed if they do not unpack or differ from their CRC."""
    data = unpack(compression, packed, size)
    most = most_messages(len(packed), size) if compression else None
    if most is not None and _has_more_records(data, most):
        raise Malformed(f"it is {len(packed)} bytes with more than {most} messages")
    if crc and zlib.crc32(data) != crc:
        raise Malformed("its CRC differs")
    return data


def _has_more_records(data: Buffer, most: int) -> bool:
    with contextlib.suppress(Malformed):
        return next(itertools.islice(records(data), most, None), None) is not None
    return False


def messages_of(data: Buffer, selected: Container[int], low: int, high: int) -> list[Message]:
    """Return the messages among records, of these channels and with a log time from `low` to before `high` (ns)."""
    found: list[Message] = []
    view = memoryview(data)
    at, end = 0, len(data)
    take, unpack_head, new = found.append, _head.unpack_from, _new_message
    while at + OPENING + MESSAGE_HEAD <= end:
        opcode, length, channel, sequence, log_time, publish_time = unpack_head(data, at)
        stop = at + OPENING + length
        if stop > end or not opcode:
            break
        if opcode == MESSAGE and channel in selected and low <= log_time < high and length >= MESSAGE_HEAD:
            take(new(Message, (channel, sequence, log_time, publish_time, view[at + 31 : stop])))
        at = stop
    return found


ALONE = 2
"""Number of chunks that are loaded without a thread: most look-ups need no more."""
LARGE = 1 << 20
"""Size from which on a chunk is loaded ahead, in bytes; compressed ones always are, since unpacking takes longer."""

Load = Callable[[Block], Buffer | None]


def loaded(blocks: Sequence[Block], load: Load) -> Iterator[Buffer | None]:
    """Iterate over what `load` returns for each block, in their order; a thread may call it."""
    yield from map(load, blocks[:ALONE])
    if any(_is_slow(each) for each in blocks[ALONE:]):
        with ThreadPoolExecutor(1, "bag-ahead") as pool:
            yield from _ahead(blocks[ALONE:], load, pool)
    else:
        yield from map(load, blocks[ALONE:])


def _ahead(blocks: Sequence[Block], load: Load, pool: ThreadPoolExecutor) -> Iterator[Buffer | None]:
    coming: Future[Buffer | None] = pool.submit(load, blocks[0])
    for following in blocks[1:]:
        found = coming.result()
        coming = pool.submit(load, following)
        yield found
    yield coming.result()


def _is_slow(block: Block) -> bool:
    return bool(block.compression) or block.size >= LARGE


_log_time = attrgetter("log_time")


def _backwards(message: Message) -> int:
    return -message.log_time


def in_log_order(chunks: Iterable[tuple[list[Message], int | None]], *, reverse: bool = False) -> Iterator[Message]:
    """Iterate over the messages of chunks in the order of their log times; of one time, the earlier chunk's come first.

    Args:
        chunks: Messages of each chunk, and the first log time of the chunks that follow (the last one with `reverse`);
            None behind the last chunk. The chunks come in the order of their own.
        reverse: True for the latest message first.
    """
    key: Callable[[Message], int] = _backwards if reverse else _log_time
    waiting: list[tuple[int, int, int, list[Message]]] = []
    """Chunks that are begun: key of their next message, number of the chunk, place of the message."""
    for number, (chunk, following) in enumerate(chunks):
        messages = sorted(reversed(chunk) if reverse else chunk, key=key)
        if messages:
            heapq.heappush(waiting, (key(messages[0]), number, 0, messages))
        bound = None if following is None else -following if reverse else following
        while waiting and (bound is None or waiting[0][0] <= bound):  # those of one time are not held together
            yield from _next_run(waiting, bound, key)


def _next_run(
    waiting: list[tuple[int, int, int, list[Message]]], bound: int | None, key: Callable[[Message], int]
) -> list[Message]:
    """Take the messages of the chunk that comes next, up to the bound or to the next message of another chunk."""
    _, number, at, messages = heapq.heappop(waiting)
    end = len(messages) if bound is None else bisect.bisect_right(messages, bound, at, key=key)
    if waiting:
        time, other = waiting[0][:2]
        find = bisect.bisect_right if number < other else bisect.bisect_left
        end = find(messages, time, at, end, key=key)
    if end < len(messages):
        heapq.heappush(waiting, (key(messages[end]), number, end, messages))
    return messages[at:end]
