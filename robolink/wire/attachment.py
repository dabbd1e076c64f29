"""Attachments, which travel beside every payload, and the gid that stands for an endpoint in them."""

from __future__ import annotations

import itertools
import struct
from collections.abc import Callable
from typing import NamedTuple

import xxhash

from robolink.exceptions import WireError

_ATTACHMENT = struct.Struct("<qqB16s")
ATTACHMENT_BYTES = _ATTACHMENT.size
GID_BYTES = 16


class Attachment(NamedTuple):
    """The attachment of a payload: who sent it, when, and as which of its own."""

    sequence: int
    timestamp: int
    """Nanoseconds since the epoch."""
    gid: bytes
    """The 16 bytes of `gid_of` the sender's token."""


def pack_attachment(sequence: int, timestamp: int, gid: bytes) -> bytes:
    """The 33 bytes of an attachment; `timestamp` in nanoseconds since the epoch, `gid` of 16 bytes."""
    return _ATTACHMENT.pack(sequence, timestamp, GID_BYTES, gid)


def attachments(gid: bytes, now: Callable[[], int]) -> Callable[[], bytes]:
    """A function that makes a sender's next attachment, numbered from 1 and stamped with `now()`.

    It runs for every message, hence a closure: all that it needs is at hand.
    """
    pack, number = _ATTACHMENT.pack, itertools.count(1).__next__
    return lambda: pack(number(), now(), GID_BYTES, gid)


def unpack_attachment(raw: bytes) -> Attachment:
    """Read an attachment; raises WireError for anything but its 33 bytes."""
    if len(raw) != _ATTACHMENT.size:
        raise WireError(f"an attachment has {_ATTACHMENT.size} bytes, got {len(raw)}")
    sequence, timestamp, gid_length, gid = _ATTACHMENT.unpack(raw)
    if gid_length != GID_BYTES:
        raise WireError(f"an attachment's gid has {GID_BYTES} bytes, got {gid_length}")
    return Attachment(sequence, timestamp, gid)


def gid_of(token: str) -> bytes:
    """The 16 bytes that stand for an endpoint: XXH3-128 of its token, the low half first."""
    raw = token.encode(errors="surrogatepass")
    return xxhash.xxh3_128_intdigest(raw).to_bytes(GID_BYTES, "little")
