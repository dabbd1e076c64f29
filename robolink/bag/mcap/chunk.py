"""Chunks as they are written: messages packed together, with an index of each channel's messages behind them."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from robolink.bag.mcap.records import (
    MESSAGE_INDEX,
    Buffer,
    ChunkIndex,
    chunk_index_record,
    chunk_opening,
    opening,
)

FEW = 64
"""Number of pieces up to which a chunk is written piece by piece: joining large messages would copy them."""


class ChunkData(NamedTuple):
    """Message records as a chunk has them, wherever in the file it will be."""

    pieces: Sequence[Buffer]
    size: int
    """Size before it was packed, in bytes."""
    crc: int
    compression: str


class PackedChunk(NamedTuple):
    """A chunk as bytes, for one place in the file."""

    pieces: list[Buffer]
    summary: bytes
    """Its record for the summary."""
    first: int
    last: int


def span(entries: Mapping[int, list[int]]) -> tuple[int, int]:
    """Return the first and the last log time among `entries`, which are as `pack_chunk` has them and not empty."""
    return min(min(each[::2]) for each in entries.values()), max(max(each[::2]) for each in entries.values())


def chunk_data(parts: Sequence[bytes], compression: str, compress: Callable[[bytes], bytes]) -> ChunkData:
    """Return message records as a chunk has them.

    Args:
        parts: The records, in any number of pieces.
        compression: Name of the compression; '' for none.
        compress: Function that packs so.
    """
    pieces = parts if len(parts) <= FEW and not compression else [b"".join(parts)]
    crc = 0
    for piece in pieces:
        crc = zlib.crc32(piece, crc)
    size = sum(map(len, pieces))
    return ChunkData([compress(pieces[0])] if compression and size else pieces, size, crc, compression)


def pack_chunk(data: ChunkData, entries: Mapping[int, list[int]], at: int) -> PackedChunk:
    """Return a chunk of message records as it is at a place of the file, and its record for the summary.

    Args:
        data: Message records.
        entries: Log time (ns) and place in the unpacked data of each message, one after the other, by channel.
        at: Place of the chunk in the file.
    """
    first, last = span(entries)
    packed = sum(map(len, data.pieces))
    head = chunk_opening(first, last, data.size, data.crc, data.compression, packed)
    length = len(head) + packed
    indexes: list[bytes] = []
    offsets: dict[int, int] = {}
    where = at + length
    for channel, each in entries.items():
        offsets[channel] = where
        content = struct.pack(f"<HI{len(each)}Q", channel, 8 * len(each), *each)
        indexes += (opening(MESSAGE_INDEX, len(content)), content)
        where += len(indexes[-2]) + len(content)
    size = where - at - length
    index = ChunkIndex(first, last, at, length, offsets, size, data.compression, packed, data.size)
    return PackedChunk([head, *data.pieces, b"".join(indexes)], chunk_index_record(index), first, last)
