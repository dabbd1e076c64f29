"""Contents of a file that is being written, apart from its open chunk: what its summary tells of it."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from robolink.bag.mcap.chunk import ChunkData, pack_chunk, span
from robolink.bag.mcap.records import (
    ATTACHMENT_INDEX,
    CHANNEL,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    LARGEST_ID,
    MAGIC,
    METADATA_INDEX,
    SCHEMA,
    STATISTICS,
    Attachment,
    Buffer,
    Channel,
    McapError,
    Schema,
    Statistics,
    attachment_index_record,
    attachment_record,
    channel_record,
    metadata_index_record,
    metadata_record,
    opening,
    record,
    schema_record,
    statistics_record,
    summary_offset_record,
)


class Waiting(NamedTuple):
    """A record that comes before the next chunk."""

    content: bytes
    kind: int = 0
    """Opcode of its index in the summary; 0 if it has none."""
    indexed: Callable[[int], bytes] | None = None
    """Maker of that index, from the record's place in the file."""


class Packed(NamedTuple):
    """Messages and other records that are in no closed chunk yet, as bytes for one place in the file."""

    pieces: list[Buffer]
    records: dict[int, list[bytes]]
    """Records for the summary, by opcode."""
    statistics: Statistics
    """Statistics of all messages, these included."""

    @property
    def size(self) -> int:
        """Size of all pieces in bytes."""
        return sum(map(len, self.pieces))


class Contents:
    """Schemas, channels, attachments, metadata and closed chunks of a file.

    Args:
        path: Path of the file, for errors.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.changed = False
        """True if there is something that was not shown yet."""
        kinds = SCHEMA, CHANNEL, STATISTICS, CHUNK_INDEX, ATTACHMENT_INDEX, METADATA_INDEX
        self._records: dict[int, list[bytes]] = {each: [] for each in kinds}
        self._statistics = Statistics(0, {}, 0, 0)
        self._waiting: list[Waiting] = []
        self._ids: dict[tuple[str, str, bytes], int] = {}

    def add_schema(self, name: str, encoding: str, data: bytes) -> int:
        """Add a schema, and return its id; the same one again has the same id. Raises McapError beyond 65,535."""
        number = self._ids.get((name, encoding, data))
        if number is None:
            number = self._ids[name, encoding, data] = self._next_id("schemas", self.schemas)
            self.schemas[number] = schema = Schema(number, name, encoding, data)
            self._declare(SCHEMA, schema_record(schema))
        return number

    def add_channel(self, schema: int, topic: str, encoding: str, metadata: Mapping[str, str]) -> int:
        """Add a channel, and return its id. Raises McapError beyond 65,535, and for a schema that is not there."""
        if schema and schema not in self.schemas:
            raise McapError(f"{self.path}: channel {topic} has schema {schema}, which was not added")
        number = self._next_id("channels", self.channels)
        self.channels[number] = channel = Channel(number, schema, topic, encoding, dict(metadata))
        self._declare(CHANNEL, channel_record(channel))
        return number

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Add a record of metadata."""
        content = metadata_record(name, values)
        length = len(content)
        self._add(Waiting(content, METADATA_INDEX, lambda at: metadata_index_record(at, length, name)))

    def add_attachment(self, attachment: Attachment) -> None:
        """Add a file within the file."""
        content = attachment_record(attachment)
        length, size, bare = len(content), len(attachment.data), attachment._replace(data=b"")
        self._add(Waiting(content, ATTACHMENT_INDEX, lambda at: attachment_index_record(at, length, size, bare)))

    def pack(self, at: int, data: ChunkData, entries: Mapping[int, list[int]]) -> Packed:
        """Return the records that wait, and a chunk of messages behind them, as they are at a place of the file.

        Args:
            at: Place in the file.
            data: Message records; an empty one for no chunk.
            entries: Log time (ns) and place in the unpacked data of each message, one after the other, by channel.
        """
        head = b"".join(each.content for each in self._waiting)
        pieces: list[Buffer] = [head] if head else []
        found: dict[int, list[bytes]] = {}
        place = at
        for waiting in self._waiting:
            if waiting.indexed is not None:
                found.setdefault(waiting.kind, []).append(waiting.indexed(place))
            place += len(waiting.content)
        if not data.size:
            return Packed(pieces, found, self._statistics)
        chunk = pack_chunk(data, entries, place)
        pieces += chunk.pieces
        found[CHUNK_INDEX] = [chunk.summary]
        return Packed(pieces, found, self.statistics(entries))

    def keep(self, packed: Packed) -> None:
        """Take what was packed as written for good."""
        for kind, found in packed.records.items():
            self._records[kind] += found
        self._statistics = packed.statistics
        self._waiting = []
        self.changed = True

    def statistics(self, entries: Mapping[int, list[int]]) -> Statistics:
        """Return the statistics of all closed chunks and of an open one, whose entries are as `pack` has them."""
        if not entries:
            return self._statistics
        total, counts, start, end = self._statistics
        first, last = span(entries)
        if total:
            first, last = min(start, first), max(end, last)
        counts = dict(counts)
        for channel, each in entries.items():
            counts[channel] = counts.get(channel, 0) + len(each) // 2
            total += len(each) // 2
        return Statistics(total, counts, first, last)

    def summary(self, packed: Packed | None = None) -> bytes:
        """Return the records of a summary, with those of what is packed."""
        return b"".join(b"".join(each) for each in self._summarized(packed).values())

    def end(self, at: int) -> bytes:
        """Return the end of an ordinary file: DataEnd, the summary with offsets and CRC, footer and magic."""
        before = record(DATA_END, bytes(4))
        start = place = at + len(before)
        offsets = b""
        groups = {kind: b"".join(found) for kind, found in self._summarized(None).items() if found}
        for kind, found in groups.items():
            offsets += summary_offset_record(kind, place, len(found))
            place += len(found)
        body = b"".join(groups.values()) + offsets + opening(FOOTER, 20) + struct.pack("<QQ", start, place)
        return before + body + struct.pack("<I", zlib.crc32(body)) + MAGIC

    def _summarized(self, packed: Packed | None) -> dict[int, list[bytes]]:
        found = dict(self._records)
        for kind, records in packed.records.items() if packed else ():
            found[kind] = found[kind] + records
        kinds = SCHEMA, CHANNEL, ATTACHMENT_INDEX, METADATA_INDEX, CHUNK_INDEX
        schemas, channels, attachments, metadata, chunks = (len(found[each]) for each in kinds)
        numbers = schemas, channels, attachments, metadata, chunks
        found[STATISTICS] = [statistics_record(packed.statistics if packed else self._statistics, numbers)]
        return found

    def _next_id(self, what: str, known: Mapping[int, object]) -> int:
        if len(known) >= LARGEST_ID:
            raise McapError(f"{self.path}: {LARGEST_ID} {what} are all that an MCAP file can have")
        return len(known) + 1

    def _declare(self, kind: int, content: bytes) -> None:
        """Add a schema or a channel: outside of chunks, so that a broken chunk costs none."""
        self._records[kind].append(content)
        self._add(Waiting(content))

    def _add(self, waiting: Waiting) -> None:
        self._waiting.append(waiting)
        self.changed = True
