"""Records of the MCAP format: their opcodes, and the bytes that each is made of, as pure functions."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from robolink.exceptions import RobolinkError

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)
FILLER = 0x80
"""Opcode of the fillers: from here on opcodes are private, and readers skip what they do not know."""
OPENING = 9
"""Size of a record's opcode and length."""
FOOTER_SIZE = OPENING + 20
END_SIZE = FOOTER_SIZE + len(MAGIC)
"""Size of what a file ends with: footer and magic."""
MESSAGE_HEAD = 22
"""Size of a message's fields before its data."""
LARGEST_ID = 65_535

PAGE = 4096
"""Size of what operating systems write whole; a write within such a page is never seen half."""
SLOTS = 4
"""Summaries of a file that is being written, which take turns: a reader has a flush of time to read one, or two."""
SEAL_SIZE = 12
"""Size of the seal behind the summary of a file that is being written, at the beginning of a filler's content."""

Buffer = bytes | bytearray | memoryview

_opening = struct.Struct("<BQ")
_u16, _u32, _u64 = (struct.Struct(f"<{code}") for code in "HIQ")
_chunk_head = struct.Struct("<QQQI")


class McapError(RobolinkError, ValueError):
    """An MCAP file that is not what it should be, or cannot be written; the text begins with its path."""


class Schema(NamedTuple):
    """Definition of the type of a channel's messages."""

    id: int
    name: str
    encoding: str
    data: bytes


class Channel(NamedTuple):
    """A topic of one type; `schema` is 0 where the messages have none."""

    id: int
    schema: int
    topic: str
    encoding: str
    metadata: dict[str, str]


class Message(NamedTuple):
    """A message as it was recorded; times are in nanoseconds."""

    channel: int
    sequence: int
    log_time: int
    publish_time: int
    data: memoryview


class Statistics(NamedTuple):
    """Number of messages, in all and by channel, and the first and last log time in nanoseconds (0 without any)."""

    message_count: int
    counts: dict[int, int]
    start_time: int
    end_time: int


class Attachment(NamedTuple):
    """A file within the file; times are in nanoseconds."""

    log_time: int
    create_time: int
    name: str
    media_type: str
    data: bytes


class ChunkIndex(NamedTuple):
    """Place of a chunk in the file, and what is in it."""

    first: int
    last: int
    at: int
    length: int
    index_offsets: dict[int, int]
    """Place of the message index of each channel; empty if the writer made none."""
    index_length: int
    compression: str
    packed: int
    size: int


class Malformed(Exception):  # noqa: N818 - it never leaves this room
    """Bytes that are not a record, or not the one that they should be."""


class Unindexed(Malformed):
    """A summary that lacks what is needed to read by it, though it is whole: reading it again is of no use."""


def record(opcode: int, content: Buffer) -> bytes:
    """Return a record."""
    return _opening.pack(opcode, len(content)) + content


def opening(opcode: int, length: int) -> bytes:
    """Return the first bytes of a record, whose content has this length."""
    return _opening.pack(opcode, length)


def filler(start: int, end: int) -> bytes:
    """Return the first bytes of a filler that goes from one place in the file to another."""
    return _opening.pack(FILLER, end - start - OPENING)


def seal(summary: bytes) -> bytes:
    """Return the seal of a summary, which tells whether all of it is of one moment: a mark and its CRC."""
    return b"robolink" + _u32.pack(zlib.crc32(summary))


def footer(summary_start: int, offsets_start: int = 0, crc: int = 0) -> bytes:
    """Return a footer, without the magic behind it."""
    return _opening.pack(FOOTER, 20) + struct.pack("<QQI", summary_start, offsets_start, crc)


def text(value: str | bytes) -> bytes:
    """Return a string, or bytes, with its length before it."""
    content = value.encode() if isinstance(value, str) else value
    return _u32.pack(len(content)) + content


def mapping(values: Mapping[str, str]) -> bytes:
    """Return a map of strings to strings."""
    return text(b"".join(text(key) + text(value) for key, value in values.items()))


def header_record(profile: str, library: str) -> bytes:
    """Return the record with which a file begins, behind the magic."""
    return record(HEADER, text(profile) + text(library))


def schema_record(schema: Schema) -> bytes:
    """Return the record of a schema."""
    return record(SCHEMA, _u16.pack(schema.id) + text(schema.name) + text(schema.encoding) + text(schema.data))


def channel_record(channel: Channel) -> bytes:
    """Return the record of a channel."""
    ids = struct.pack("<HH", channel.id, channel.schema)
    return record(CHANNEL, ids + text(channel.topic) + text(channel.encoding) + mapping(channel.metadata))


def statistics_record(statistics: Statistics, numbers: tuple[int, int, int, int, int]) -> bytes:
    """Return the statistics. `numbers` are those of schemas, channels, attachments, metadata and chunks."""
    counts = b"".join(struct.pack("<HQ", channel, count) for channel, count in sorted(statistics.counts.items()))
    times = statistics.start_time, statistics.end_time
    return record(STATISTICS, struct.pack("<QHIIIIQQ", statistics.message_count, *numbers, *times) + text(counts))


def chunk_index_record(index: ChunkIndex) -> bytes:
    """Return the index of a chunk."""
    offsets = b"".join(struct.pack("<HQ", channel, at) for channel, at in index.index_offsets.items())
    return record(
        CHUNK_INDEX,
        struct.pack("<QQQQ", index.first, index.last, index.at, index.length)
        + text(offsets)
        + _u64.pack(index.index_length)
        + text(index.compression)
        + struct.pack("<QQ", index.packed, index.size),
    )


def chunk_opening(first: int, last: int, size: int, crc: int, compression: str, packed: int) -> bytes:
    """Return the head of a chunk: the bytes before its `size` bytes of packed data."""
    content = _chunk_head.pack(first, last, size, crc) + text(compression) + _u64.pack(packed)
    return opening(CHUNK, len(content) + packed) + content


def attachment_record(attachment: Attachment) -> bytes:
    """Return the record of an attachment."""
    content = struct.pack("<QQ", attachment.log_time, attachment.create_time)
    content += text(attachment.name) + text(attachment.media_type) + _u64.pack(len(attachment.data)) + attachment.data
    return record(ATTACHMENT, content + _u32.pack(zlib.crc32(content)))


def attachment_index_record(at: int, length: int, size: int, attachment: Attachment) -> bytes:
    """Return the index of an attachment of `size` bytes, whose record is at a place and has a length."""
    numbers = at, length, attachment.log_time, attachment.create_time, size
    return record(ATTACHMENT_INDEX, struct.pack("<5Q", *numbers) + text(attachment.name) + text(attachment.media_type))


def metadata_record(name: str, values: Mapping[str, str]) -> bytes:
    """Return a record of metadata."""
    return record(METADATA, text(name) + mapping(values))


def metadata_index_record(at: int, length: int, name: str) -> bytes:
    """Return the index of metadata, whose record is at a place and has a length."""
    return record(METADATA_INDEX, struct.pack("<QQ", at, length) + text(name))


def summary_offset_record(opcode: int, at: int, length: int) -> bytes:
    """Return the place of the summary's records of one kind."""
    return record(SUMMARY_OFFSET, struct.pack("<BQQ", opcode, at, length))


class Fields:
    """Reader of the fields of a record's content, one after the other. Raises Malformed where they end too early."""

    def __init__(self, content: Buffer) -> None:
        self.content = memoryview(content)
        self.at = 0

    def numbers(self, layout: str) -> tuple[int, ...]:
        """Return numbers of a layout of `struct`, which are little-endian."""
        try:
            found = struct.unpack_from("<" + layout, self.content, self.at)
        except struct.error:
            raise Malformed("it is too short") from None
        self.at += struct.calcsize("<" + layout)
        return found

    def data(self, layout: str = "I") -> bytes:
        """Return bytes that stand behind their length."""
        (length,) = self.numbers(layout)
        end = self.at + length
        if end > len(self.content):
            raise Malformed("a length reaches beyond its end")
        found = bytes(self.content[self.at : end])
        self.at = end
        return found

    def text(self) -> str:
        """Return a string; bytes that are not UTF-8 are replaced."""
        return self.data().decode("utf-8", "replace")

    def mapping(self) -> dict[str, str]:
        """Return a map of strings to strings."""
        inner = Fields(self.data())
        found = {}
        while inner.at < len(inner.content):
            key = inner.text()
            found[key] = inner.text()
        return found

    def pairs(self) -> dict[int, int]:
        """Return a map of ids to large numbers."""
        inner = Fields(self.data())
        found = {}
        while inner.at < len(inner.content):
            key, value = inner.numbers("HQ")
            found[key] = value
        return found


def read_schema(content: Buffer) -> Schema:
    """Return the schema of a record's content."""
    fields = Fields(content)
    return Schema(fields.numbers("H")[0], fields.text(), fields.text(), fields.data())


def read_channel(content: Buffer) -> Channel:
    """Return the channel of a record's content."""
    fields = Fields(content)
    number, schema = fields.numbers("HH")
    return Channel(number, schema, fields.text(), fields.text(), fields.mapping())


def read_statistics(content: Buffer) -> Statistics:
    """Return the statistics of a record's content."""
    fields = Fields(content)
    count, _, _, _, _, _, first, last = fields.numbers("QHIIIIQQ")
    return Statistics(count, fields.pairs(), first, last)


def read_chunk_index(content: Buffer) -> ChunkIndex:
    """Return the chunk index of a record's content."""
    fields = Fields(content)
    first, last, at, length = fields.numbers("QQQQ")
    offsets = fields.pairs()
    (index_length,) = fields.numbers("Q")
    compression = fields.text()
    packed, size = fields.numbers("QQ")
    return ChunkIndex(first, last, at, length, offsets, index_length, compression, packed, size)


def read_attachment(content: Buffer) -> Attachment:
    """Return the attachment of a record's content."""
    fields = Fields(content)
    log_time, create_time = fields.numbers("QQ")
    return Attachment(log_time, create_time, fields.text(), fields.text(), fields.data("Q"))


def read_metadata(content: Buffer) -> tuple[str, dict[str, str]]:
    """Return the name and the values of a metadata record's content."""
    fields = Fields(content)
    return fields.text(), fields.mapping()


class ChunkHead(NamedTuple):
    """Fields of a chunk before its packed data, and the size of the record up to there."""

    first: int
    last: int
    size: int
    crc: int
    compression: str
    packed: int
    head: int


def read_chunk_head(content: Buffer) -> ChunkHead:
    """Return the head of a chunk, which stands before the packed data, of its content or its first bytes."""
    fields = Fields(content)
    first, last, size, crc = fields.numbers("QQQI")
    compression = fields.text()
    (packed,) = fields.numbers("Q")
    return ChunkHead(first, last, size, crc, compression, packed, OPENING + fields.at)


def records(content: Buffer) -> Iterator[tuple[int, int, int]]:
    """Iterate over records: opcode, and start and end of the content.

    Raises Malformed where one reaches too far, or there is none.
    """
    at, end = 0, len(content)
    while at < end:
        if at + OPENING > end:
            raise Malformed("a record is cut")
        opcode, length = _opening.unpack_from(content, at)
        if not opcode:
            raise Malformed("a record is missing")
        start = at + OPENING
        at = start + length
        if at > end:
            raise Malformed("a record reaches beyond its end")
        yield opcode, start, at
