"""Chunks of MCAP files: their compression, and their records packed."""

from __future__ import annotations

import functools
import importlib
import struct
import zlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

from robolink.bag.limits import refusal_of_piece
from robolink.bag.mcap.records import (
    MESSAGE_INDEX,
    Buffer,
    ChunkIndex,
    Malformed,
    McapError,
    chunk_index_record,
    chunk_opening,
    opening,
)

COMPRESSIONS = ("", "zstd", "lz4")
"""Names of MCAP's compressions; '' is none."""
LEVEL = 1
"""Level of zstd: the fastest of the usual ones, since a recorder shares the computer with a robot's programs."""
MODULES = {"zstd": ("compression.zstd", "backports.zstd"), "lz4": ("lz4.frame",)}
"""Modules that can, the first that is there: Python has zstd itself from 3.14 on."""
LARGEST_PART = 64 << 20
"""Most that is unpacked of a chunk without an end, in bytes."""


class MissingCompressionError(McapError):
    """A compression whose package is not installed."""


@functools.cache
def _module(name: str) -> Any:
    for each in MODULES[name]:
        try:
            return importlib.import_module(each)
        except ImportError:
            continue
    package = MODULES[name][-1].removesuffix(".frame")
    raise MissingCompressionError(f"compression '{name}' needs a package that is not here: pip install {package}")


def compressor(name: str) -> Callable[[bytes], bytes]:
    """Return the function that packs a chunk's data.

    Raises McapError for a name that is none of MCAP's, and MissingCompressionError.
    """
    if name not in COMPRESSIONS:
        raise McapError(f"no compression '{name}': MCAP has zstd and lz4, and '' for none")
    if not name:
        return bytes
    module = _module(name)
    compress: Callable[..., bytes] = module.compress
    return functools.partial(compress, level=LEVEL) if name == "zstd" else compress


def unpack(name: str, packed: Buffer, size: int) -> Buffer:
    """Return a chunk's data, which is `size` bytes.

    Raises Malformed if it is not, or claims more than its packed size is good for, and MissingCompressionError.
    """
    if reason := refusal_of_piece(len(packed), size):
        raise Malformed(reason)
    found: Buffer
    if not name:
        found = packed
    elif name == "zstd":
        found = _decompressed(_module(name).ZstdDecompressor(), packed, size)
    elif name == "lz4":
        found = _decompressed(_module(name).LZ4FrameDecompressor(), packed, size)
    else:
        raise Malformed(f"its compression is '{name}', which MCAP does not have")
    if len(found) != size:
        raise Malformed(f"it unpacks to {len(found)} bytes instead of {size}")
    return found


def unpack_partly(name: str, packed: bytes) -> bytes:
    """Return the readable part of a chunk's data whose end is missing. Raises MissingCompressionError."""
    if name == "zstd":
        decompressor = _module(name).ZstdDecompressor()
    elif name == "lz4":
        decompressor = _module(name).LZ4FrameDecompressor()
    else:
        return b"" if name else packed
    try:
        return _decompressed(decompressor, packed, LARGEST_PART)
    except Malformed:
        return b""


def _decompressed(decompressor: Any, packed: Buffer, size: int) -> bytes:
    """Unpack at most one byte more than there should be, so that a hostile file fills no memory."""
    try:
        found: bytes = decompressor.decompress(packed, size + 1)
    except Exception as error:  # noqa: BLE001 - each package has errors of its own
        raise Malformed(f"it does not unpack ({error})") from None
    return found


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
