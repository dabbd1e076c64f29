"""Scan of a file whose index is missing or broken: records are searched byte by byte."""

from __future__ import annotations

import re
from collections.abc import Callable, Container

from robolink.bag.limits import PIECE_RATIO, most_of_file, refusal_of_piece
from robolink.bag.mcap.blocks import Block, Catalog, Source, chunk_data, messages_of
from robolink.bag.mcap.chunk import LARGEST_PART, unpack_partly
from robolink.bag.mcap.records import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    DATA_END,
    FILLER,
    FOOTER,
    HEADER,
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    METADATA,
    OPENING,
    SCHEMA,
    Buffer,
    ChunkHead,
    Fields,
    Malformed,
    Statistics,
    channel_record,
    metadata_record,
    read_attachment,
    read_channel,
    read_chunk_head,
    read_metadata,
    read_schema,
    records,
    schema_record,
)

WINDOW = 1 << 20
"""Bytes that are searched at a time, and the size of a run of messages outside of chunks."""
CANDIDATE = re.compile(rb"(?=[\x03-\x06\x0c].{5}\0\0\0)", re.DOTALL)
"""Bytes that may begin a schema, a channel, a message, a chunk or metadata: an opcode, and a length below 2**40."""
LONGEST_HEAD = 64
"""Bytes in which all is that stands before a chunk's data."""
LONGEST_DECLARATION = 4 << 20
"""Length of the longest schema, channel or metadata that is found, in bytes."""
LARGEST = 1 << 32
"""Length of the longest record that is read into memory, in bytes."""
TEXTS = ("ros2msg", "ros2idl", "ros1msg", "omgidl", "jsonschema")
"""Encodings of schemas that are texts: zeros in one are a part of the file that was never written."""
AGAIN: dict[int, Callable[[bytes], bytes]] = {
    SCHEMA: lambda content: schema_record(read_schema(content)),
    CHANNEL: lambda content: channel_record(read_channel(content)),
    METADATA: lambda content: metadata_record(*read_metadata(content)),
}
"""Functions that read a record and write it again: what comes out as it went in is one."""


def next_record(source: Source, at: int, channels: Container[int]) -> int | None:
    """Return the place of the next record that seems good, None if there is none.

    Args:
        source: The file.
        at: Place from which on it is searched.
        channels: Channels of which messages outside of chunks are looked for.
    """
    while at < source.size:
        window = source.read(at, WINDOW + OPENING)
        for found in CANDIDATE.finditer(window):
            if _seems_good(source, at + found.start(), channels):
                return at + found.start()
        at += WINDOW
    return None


def _seems_good(source: Source, at: int, channels: Container[int]) -> bool:
    opcode, length = source.opening(at)
    end = at + OPENING + length
    if end > source.size or length > LARGEST:
        return False
    if opcode in AGAIN:
        return length <= LONGEST_DECLARATION and is_intact(opcode, source.content(at, length))
    if length < MESSAGE_HEAD:
        return False
    if opcode == CHUNK:
        try:
            head = read_chunk_head(source.read(at + OPENING, min(length, LONGEST_HEAD)))
        except Malformed:
            return False
        return head.head - OPENING + head.packed == length
    return int.from_bytes(source.read(at + OPENING, 2), "little") in channels and _may_be_record(source, end)


def is_intact(opcode: int, content: bytes) -> bool:
    """True if the content of a schema, a channel or metadata is such a record's, with nothing odd in it."""
    try:
        if opcode == SCHEMA and (schema := read_schema(content)).encoding in TEXTS and "\0" in schema.data.decode():
            return False
        return AGAIN[opcode](content)[OPENING:] == content
    except (Malformed, UnicodeError):
        return False


def _may_be_record(source: Source, at: int) -> bool:
    """True if a record may begin at a place, or the file ends there."""
    try:
        opcode, length = source.opening(at)
    except Malformed:
        return True
    return (0 < opcode <= DATA_END and length < LARGEST) or opcode >= FILLER


def scan(source: Source) -> Catalog:
    """Return the catalogue of a file, by reading all of it. Broken parts are left out and named in its problems."""
    return _Scan(source).run()


class _Scan:
    def __init__(self, source: Source) -> None:
        self.source = source
        self.catalog = Catalog()
        self.catalog.is_whole = False
        self.counts: dict[Block, dict[int, int]] = {}
        self.is_salvaging = False
        """True behind a broken place: fillers and ends are no more believed, and chunks may be there twice."""
        self.slots = 1 << 64
        """Place from which on chunks are not in the order in which they were written."""
        self.known: dict[tuple[object, ...], Block] = {}
        """Blocks by their first message: the versions of an open chunk have the same."""
        self.chunks: set[int] = set()
        """Places of all chunks, the broken ones too."""
        self.left = most_of_file(source.size)
        """Bytes that may still be unpacked."""

    def run(self) -> Catalog:
        at: int | None = len(MAGIC)
        while at is not None and at < self.source.size:
            at = self._step(at)
        self._count()
        return self.catalog

    def _step(self, at: int) -> int | None:
        """Take the record at a place, and return the place of the next; None at the end."""
        try:
            opcode, length = self.source.opening(at)
        except Malformed:
            return self._broken(at, "the file ends within a record")
        if opcode == 0 or (opcode == MESSAGE and length < MESSAGE_HEAD):
            return self._broken(at, "there is no record")
        if at + OPENING + length > self.source.size or (length > LARGEST and opcode < FILLER):
            return self._cut(at, opcode)
        end = at + OPENING + length
        if opcode == FILLER and self.is_salvaging:
            return self._next(at + OPENING)
        if opcode == FILLER and length:
            return self._slots(at)
        if opcode in (DATA_END, FOOTER) and not self.is_salvaging:
            self._end()
            return None
        if opcode == MESSAGE:
            return self._next(at + 1) if self.is_salvaging and self.chunks else self._run_of_messages(at)
        try:
            self._take(at, opcode, length)
        except Malformed as error:
            self._problem(at, f"{NAMES.get(opcode, 'a record')}: {error}; it is left out")
        return end

    def _slots(self, at: int) -> int | None:
        """Look for the newest of all that is behind a filler: none of the slots there is believed to be that.

        A scan is made where the index does not fit, as after a power cut: any part of what was written last may lack,
        and what a slot holds may be of an earlier moment.
        """
        self.slots = at
        return self._broken(at, "the file was not closed, and its index does not fit")

    def _end(self) -> None:
        """Look whether the file ends as it should."""
        has_end = self.source.read(self.source.size - len(MAGIC), len(MAGIC)) == MAGIC
        self.catalog.is_whole = has_end and not self.catalog.problems
        if not has_end:
            self._problem(self.source.size, "the file's end is missing")

    def _take(self, at: int, opcode: int, length: int) -> None:
        if opcode == CHUNK:
            self.chunks.add(at)
            self._chunk(at, length)
        elif opcode in READ:
            content = self.source.content(at, length)
            if self.is_salvaging and opcode in AGAIN and not is_intact(opcode, content):
                raise Malformed("it is broken")
            self._declare(opcode, content)

    def _declare(self, opcode: int, content: bytes | memoryview) -> None:
        catalog = self.catalog
        if opcode == HEADER:
            fields = Fields(content)
            catalog.profile, catalog.library = fields.text(), fields.text()
        elif opcode == SCHEMA:
            schema = read_schema(content)
            if not self.is_salvaging or schema.id not in catalog.schemas:
                catalog.schemas[schema.id] = schema
        elif opcode == CHANNEL:
            channel = read_channel(content)
            if not self.is_salvaging or channel.id not in catalog.channels:
                catalog.channels[channel.id] = channel
        elif opcode == METADATA:
            found = read_metadata(content)
            if not (self.is_salvaging and found in catalog.metadata):
                catalog.metadata.append(found)
        elif opcode == ATTACHMENT:
            catalog.attachments.append(read_attachment(content))

    def _chunk(self, at: int, length: int) -> None:
        head = read_chunk_head(self.source.read(at + OPENING, min(length, LONGEST_HEAD)))
        if head.head - OPENING + head.packed > length:
            raise Malformed("its data reaches beyond its end")
        data = self._unpacked(at, head)
        self._declare_all(data)
        self._block(Block(at, OPENING + length, head.first, head.last, None, True, head.compression, head.size), data)

    def _unpacked(self, at: int, head: ChunkHead) -> Buffer:
        """Return the data of a chunk. Raises Malformed if it is broken, or all chunks together claim too much."""
        if head.compression and not refusal_of_piece(head.packed, head.size):
            if head.size > self.left and head.size > PIECE_RATIO * head.packed:
                raise Malformed(f"it claims to be {head.size} bytes, and too many were unpacked before for such a file")
            self.left -= head.size
        return chunk_data(self.source.read(at + head.head, head.packed), head.compression, head.size, head.crc)

    def _declare_all(self, data: Buffer) -> None:
        """Take the schemas and channels of a chunk."""
        try:
            for opcode, start, end in records(data):
                if opcode in (SCHEMA, CHANNEL):
                    self._declare(opcode, memoryview(data)[start:end])
        except Malformed:
            pass  # what is before the broken record has been taken

    def _run_of_messages(self, at: int) -> int:
        """Take the messages that stand at a place one behind the other, outside of a chunk."""
        window = self.source.read(at, WINDOW)
        if len(window) < OPENING + (length := self.source.opening(at)[1]):
            window = self.source.read(at, OPENING + length)
        end = 0
        try:
            for opcode, start, stop in records(window):
                if opcode != MESSAGE or stop - start < MESSAGE_HEAD:
                    break
                end = stop
        except Malformed:
            pass  # the last one is not wholly in the window
        data = window[:end]
        self._block(Block(at, end, 0, 0, is_chunk=False), data)
        return at + end

    def _block(self, block: Block, data: Buffer) -> None:
        """Keep a block, unless it is an older version of one that there is."""
        found = messages_of(data, range(LARGEST), 0, 1 << 64)
        if not found:
            return
        counts: dict[int, int] = {}
        for message in found:
            counts[message.channel] = counts.get(message.channel, 0) + 1
        times = [each.log_time for each in found]
        block = block._replace(channels=frozenset(counts))
        if not block.is_chunk or block.data is not None:
            block = block._replace(first=min(times), last=max(times), size=len(data))
        key = (*found[0][:4], bytes(found[0].data))
        before = self.known.get(key)
        if before is not None and self.is_salvaging:
            if before.size >= block.size:
                return
            del self.counts[before]
        self.known[key] = block
        self.counts[block] = counts

    def _cut(self, at: int, opcode: int) -> int | None:
        """Go on behind the opening of a record that reaches beyond the file; of a chunk what is there is taken."""
        if self.is_salvaging:
            return self._next(at + 1)
        if opcode == FILLER:
            return self._slots(at)
        if opcode != CHUNK:
            return self._broken(at, "the file ends within a record")
        self.chunks.add(at)
        try:
            head = read_chunk_head(self.source.read(at + OPENING, LONGEST_HEAD))
        except Malformed:
            return self._broken(at, "the file ends within a chunk")
        packed = self.source.read(at + head.head, min(head.packed, LARGEST_PART))
        data = unpack_partly(head.compression, packed)
        self._declare_all(data)
        self._block(Block(at, 0, 0, 0, data=data), data)
        return self._broken(at, "a chunk has no end: its messages up to there are read")

    def _broken(self, at: int, why: str) -> int | None:
        """Note a broken place, and return the next good one."""
        if not self.is_salvaging or not self.catalog.problems:
            self._problem(at, why)
        self.is_salvaging = True
        self._covered_chunk(at)
        return self._next(at + 1)

    def _covered_chunk(self, at: int) -> None:
        """Take a chunk whose first bytes are still those of the filler that was there before."""
        try:
            head = read_chunk_head(self.source.read(at + OPENING, LONGEST_HEAD))
            if not head.crc or at + head.head + head.packed > self.source.size:
                return
            data = self._unpacked(at, head)
        except Malformed:
            return
        self._declare_all(data)
        self._block(Block(at, head.head + head.packed, 0, 0, data=data), data)

    def _next(self, at: int) -> int | None:
        """Return the place of the next record that seems good, from a place on."""
        # Where there are chunks, a message outside is part of a broken one, and no CRC tells whether it is good.
        return next_record(self.source, at, () if self.chunks else self.catalog.channels)

    def _problem(self, at: int, text: str) -> None:
        self.catalog.problems.append(f"byte {at}: {text}")

    def _count(self) -> None:
        """Sum up what was found; messages of channels that are not described anywhere are left out."""
        catalog = self.catalog
        totals: dict[int, int] = {}
        lost = 0
        for counts in self.counts.values():
            for channel, count in counts.items():
                if channel in catalog.channels:
                    totals[channel] = totals.get(channel, 0) + count
                else:
                    lost += count
        if lost:
            catalog.problems.append(f"{lost} messages belong to channels that are not described: they are left out")
        closed = sorted((each for each in self.counts if each.at < self.slots), key=lambda each: each.at)
        slotted = sorted((each for each in self.counts if each.at >= self.slots), key=lambda each: each.first)
        catalog.blocks = closed + slotted
        first = min((each.first for each in catalog.blocks), default=0)
        last = max((each.last for each in catalog.blocks), default=0)
        catalog.statistics = Statistics(sum(totals.values()), totals, first, last)


READ = {HEADER, SCHEMA, CHANNEL, METADATA, ATTACHMENT}
NAMES = {CHUNK: "a chunk", SCHEMA: "a schema", CHANNEL: "a channel", METADATA: "metadata", ATTACHMENT: "an attachment"}
