"""Index of a file: what its summary tells, found from the footer."""

from __future__ import annotations

import contextlib
import zlib
from collections.abc import Iterator

from robolink.bag.limits import PIECE_RATIO, most_of_file
from robolink.bag.mcap.blocks import Block, Catalog, Source, load
from robolink.bag.mcap.chunk import MissingCompressionError
from robolink.bag.mcap.records import (
    ATTACHMENT,
    ATTACHMENT_INDEX,
    CHANNEL,
    CHUNK_INDEX,
    DATA_END,
    END_SIZE,
    FILLER,
    FOOTER,
    FOOTER_SIZE,
    HEADER,
    MAGIC,
    METADATA,
    METADATA_INDEX,
    OPENING,
    PAGE,
    SCHEMA,
    SEAL_SIZE,
    SLOTS,
    STATISTICS,
    ChunkIndex,
    Fields,
    Malformed,
    Unindexed,
    read_attachment,
    read_channel,
    read_chunk_index,
    read_metadata,
    read_schema,
    read_statistics,
    seal,
)

UNSURE = 48 << 20
"""Bytes at the end of a file that was not closed in which chunks are read when it is opened."""
LARGEST_SUMMARY = 256 << 20
"""Size of the largest record of a summary that is read, in bytes."""


def read_index(source: Source) -> Catalog:
    """Return the catalogue of a summary. Raises Malformed if the file has none, or one that cannot be relied on."""
    head = Catalog()
    _read_head(source, head)
    start, crc = _read_footer(source)
    if crc:
        _check_crc(source, start, crc)
    if not _is_open(source, start):
        return _read_summary(source, start, head)
    return _newest(source, start, head)


def _newest(source: Source, start: int, head: Catalog) -> Catalog:
    """Return the catalogue that the newest summary has of a file that was not closed.

    The summary that the footer leads to is one of four, by turns. After a power cut any part of what was written last
    may lack: the newest is the one that counts the most messages, if the chunks that it names are there.
    """
    half = start & -start
    base = source.size - PAGE - SLOTS * 2 * half
    starts = [start, *(base + (2 * slot + 1) * half for slot in range(SLOTS) if base > 0)]
    found = []
    for each in starts:
        with contextlib.suppress(Malformed):
            if source.opening(each - OPENING - 4) == (DATA_END, 4):
                _check_seal(source, each)
                found.append(_read_summary(source, each, head))
    for catalog in sorted(found, key=lambda each: -each.statistics.message_count):
        with contextlib.suppress(Malformed):
            _check_chunks(source, catalog)
            return catalog
    raise Malformed("no summary of it fits")


def _check_seal(source: Source, start: int) -> None:
    """Raise Malformed if part of a summary is of another moment. One without a seal is of another writer."""
    at, end = start, source.size - END_SIZE
    while at < end:
        opcode, length = source.opening(at)
        if opcode == 0 or at - start > LARGEST_SUMMARY:
            break
        if opcode >= FILLER:
            found = source.read(at + OPENING, SEAL_SIZE)
            if found[:8] == seal(b"")[:8] and found != seal(source.read(start, at - start)):
                raise Malformed("its summary is broken")
            return
        at += OPENING + length
    raise Malformed("its summary has no end")


def _check_chunks(source: Source, catalog: Catalog) -> None:
    """Raise Malformed if one of the last chunks is not there; keep the last, whose place is used again in a moment."""
    unsure = source.size - UNSURE
    last = len(catalog.blocks) - 1
    for number, block in enumerate(catalog.blocks):
        if block.at >= unsure or number == last:
            with contextlib.suppress(MissingCompressionError):
                data = load(source, block)
                if number == last:
                    catalog.blocks[-1] = block._replace(data=data)


def _read_summary(source: Source, start: int, head: Catalog) -> Catalog:
    catalog = Catalog()
    catalog.profile, catalog.library = head.profile, head.library
    chunks: list[ChunkIndex] = []
    places: list[tuple[int, int, int]] = []
    counted = None
    for opcode, content in _summary(source, start):
        if opcode == SCHEMA:
            schema = read_schema(content)
            catalog.schemas[schema.id] = schema
        elif opcode == CHANNEL:
            channel = read_channel(content)
            catalog.channels[channel.id] = channel
        elif opcode == STATISTICS:
            counted = read_statistics(content)
        elif opcode == CHUNK_INDEX:
            chunks.append(read_chunk_index(content))
        elif opcode in (ATTACHMENT_INDEX, METADATA_INDEX):
            at, length = Fields(content).numbers("QQ")
            places.append((opcode, at, length))
    if counted is None:
        raise Malformed("its summary has no statistics")
    catalog.statistics = counted
    catalog.blocks = [_block(source, each) for each in sorted(chunks, key=lambda each: each.at)]
    _leave_out_bombs(source, catalog)
    _read_places(source, catalog, places)
    _check(catalog, chunks)
    return catalog


def _read_head(source: Source, catalog: Catalog) -> None:
    opcode, length = source.opening(len(MAGIC))
    if opcode != HEADER or length > LARGEST_SUMMARY:
        raise Malformed("it does not begin with a header")
    fields = Fields(source.content(len(MAGIC), length))
    catalog.profile, catalog.library = fields.text(), fields.text()


def _read_footer(source: Source) -> tuple[int, int]:
    """Return the place of the summary, and its CRC (0 if there is none)."""
    at = source.size - END_SIZE
    if source.read(source.size - len(MAGIC), len(MAGIC)) != MAGIC or source.opening(at) != (FOOTER, 20):
        raise Malformed("it has no end")
    start, _, crc = Fields(source.content(at, 20)).numbers("QQI")
    if not len(MAGIC) < start <= at:
        raise Unindexed("it has no summary")
    return start, crc


def _check_crc(source: Source, start: int, crc: int) -> None:
    end = source.size - END_SIZE + FOOTER_SIZE - 4
    found = 0
    for at in range(start, end, 1 << 20):
        found = zlib.crc32(source.read(at, min(1 << 20, end - at)), found)
    if found != crc:
        raise Malformed("its summary's CRC differs")


def _summary(source: Source, start: int) -> Iterator[tuple[int, bytes]]:
    """Iterate over the summary's records, those of interest: opcode and content."""
    end = source.size - END_SIZE
    for at, opcode, length in source.walk(start, end):
        if opcode == 0 or at + OPENING + length > end:
            raise Malformed("its summary is broken")
        if opcode < FILLER:
            if length > LARGEST_SUMMARY:
                raise Malformed("its summary is too large")
            yield opcode, source.content(at, length)


def _block(source: Source, index: ChunkIndex) -> Block:
    if index.at + index.length > source.size or index.packed > index.length:
        raise Malformed("its index reaches beyond its end")
    channels = frozenset(index.index_offsets) or None
    return Block(index.at, index.length, index.first, index.last, channels, True, index.compression, index.size)


def _leave_out_bombs(source: Source, catalog: Catalog) -> None:
    """Leave out chunks of large ratios behind those with which all claim as much as the file is good for."""
    claimed, most = sum(each.size for each in catalog.blocks), most_of_file(source.size)
    if claimed <= most:
        return
    retained, left = [], most
    for each in catalog.blocks:
        if each.size <= max(left, PIECE_RATIO * each.length):
            retained.append(each)
            left -= each.size
    left_out = len(catalog.blocks) - len(retained)
    if left_out:
        catalog.blocks = retained
        catalog.problems.append(
            f"its chunks claim to be {claimed} bytes, and {most} at most are unpacked of a file of {source.size}:"
            f" {left_out} that claim more than {PIECE_RATIO} times their size are left out"
        )


def _read_places(source: Source, catalog: Catalog, places: list[tuple[int, int, int]]) -> None:
    """Read the attachments and the metadata, to which the summary has only the places."""
    for kind, at, length in places:
        opcode, size = source.opening(at)
        if opcode != (METADATA if kind == METADATA_INDEX else ATTACHMENT) or size + OPENING != length:
            raise Malformed("its index leads to another record")
        content = source.content(at, size)
        if opcode == METADATA:
            catalog.metadata.append(read_metadata(content))
        else:
            catalog.attachments.append(read_attachment(content))


def _check(catalog: Catalog, chunks: list[ChunkIndex]) -> None:
    """Raise Malformed if the summary leaves out something that is in the file: then all of the file must be read."""
    used = set(catalog.statistics.counts).union(*(each.index_offsets for each in chunks))
    if catalog.statistics.message_count and not chunks:
        raise Unindexed("its messages have no index")
    if not used <= set(catalog.channels):
        raise Unindexed("its summary lacks channels")
    if not {each.schema for each in catalog.channels.values()} <= {0, *catalog.schemas}:
        raise Unindexed("its summary lacks schemas")
    if catalog.statistics.message_count and not catalog.statistics.counts:
        raise Malformed("its statistics count no channels")


def _is_open(source: Source, start: int) -> bool:
    """True if a filler leads from the summary to the footer: the file was not closed by its writer."""
    return any(opcode >= FILLER for _, opcode, _ in source.walk(start, source.size - END_SIZE))
