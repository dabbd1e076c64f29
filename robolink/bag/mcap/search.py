"""Search for the next good record behind a broken place of a file."""

from __future__ import annotations

import re
from collections.abc import Callable, Container

from robolink.bag.mcap.blocks import Source
from robolink.bag.mcap.records import (
    CHANNEL,
    CHUNK,
    DATA_END,
    FILLER,
    MESSAGE_HEAD,
    METADATA,
    OPENING,
    SCHEMA,
    Malformed,
    channel_record,
    metadata_record,
    read_channel,
    read_chunk_head,
    read_metadata,
    read_schema,
    schema_record,
)

WINDOW = 1 << 20
"""Bytes that are searched at a time."""
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
