"""Attachments: the header that rmw_zenoh sends beside every payload, and the sender's gid in it.

The layout is known here only: other modules ask `is_attachment`, `check_attachment`, `gid_in` and `unpack_attachment`.
"""

from __future__ import annotations

import functools
import itertools
import operator
import struct
from collections.abc import Callable
from typing import Any, NamedTuple

import xxhash

from robolink.exceptions import WireError

_LAYOUT = struct.Struct("<qqB16s")
_BY_SENDER = struct.Struct("<qq17s")
"""The same layout, of what differs from message to message, and the rest, which is the sender's."""

_LENGTH = _LAYOUT.size
GID_BYTES = 16
_GID_LENGTH_AT = 16
"""Offset of the byte that holds the gid's length."""
_TIME_AT = 8
"""Offset of the time."""


class Attachment(NamedTuple):
    """The fields of an attachment: who sent a payload, when, and as which of its own."""

    sequence: int
    """Number of the payload at its sender, from 1."""
    timestamp: int
    """Time of sending, in nanoseconds since the epoch."""
    gid: bytes
    """Global id of the sender's endpoint, 16 bytes: `gid_of` its token."""


_make: Callable[[tuple[int, int, bytes]], Attachment] = functools.partial(tuple.__new__, Attachment)
"""Fast constructor of Attachment, whose `__new__` is Python: for once a message."""


def pack_attachment(sequence: int, timestamp: int, gid: bytes) -> bytes:
    """Return the 33 bytes of an attachment; `timestamp` in nanoseconds since the epoch, `gid` of 16 bytes."""
    return _LAYOUT.pack(sequence, timestamp, GID_BYTES, gid)


def attachments(gid: bytes, now: Callable[[], int]) -> Callable[[], bytes]:
    """Return a function that packs a sender's next attachment, numbered from 1 and stamped with `now()`.

    It runs for every message, hence C: `map` takes a number, then the time, and packs them.
    """
    times, sender = iter(now, None), itertools.repeat(bytes((GID_BYTES,)) + gid)
    return map(_BY_SENDER.pack, itertools.count(1), times, sender).__next__


fields_of: Callable[[bytes], tuple[int, int, int, bytes]] = _LAYOUT.unpack
"""Fields of 33 bytes in C: sequence number, time, length of the gid (16, or it is none), gid; raises struct.error."""


def is_attachment(raw: bytes) -> bool:
    """True if `unpack_attachment` can read this; for hot paths, since it is three times as fast."""
    return len(raw) == _LENGTH and raw[_GID_LENGTH_AT] == GID_BYTES


def check_attachment(raw: bytes) -> None:
    """Raise WireError, as `unpack_attachment` does, unless that can read this; for hot paths."""
    if len(raw) != _LENGTH or raw[_GID_LENGTH_AT] != GID_BYTES:
        unpack_attachment(raw)  # it says what is wrong


def pair_opener(
    check: Callable[[bytes], object], decode: Callable[[bytes], Any]
) -> Callable[[tuple[bytes, bytes]], Any]:
    """Return a function of a payload and its attachment that decodes the payload if `check` lets it.

    `check_attachment` is written out, and all of it one call, since in virtual time every message comes here.
    """
    if check is not check_attachment:

        def checked(pair: tuple[bytes, bytes]) -> Any:
            payload, raw = pair
            check(raw)
            return decode(payload)

        return checked

    def opened(pair: tuple[bytes, bytes]) -> Any:
        payload, raw = pair
        if len(raw) != _LENGTH or raw[_GID_LENGTH_AT] != GID_BYTES:
            unpack_attachment(raw)  # it says what is wrong
        return decode(payload)

    return opened


gid_in: Callable[[bytes], bytes] = operator.itemgetter(slice(_GID_LENGTH_AT + 1, _LENGTH))
"""Return the sender's gid in an attachment; of other bytes something that is not a sender's. In C, for hot paths."""

numbers_in: Callable[[bytes], bytes] = operator.itemgetter(slice(_GID_LENGTH_AT))
"""Return the beginning of an attachment, its number and time: with `sender_part` of another gid it is that one's."""


def sender_part(gid: bytes) -> bytes:
    """Return the end of the attachments of a sender: its gid, and the length of that."""
    return bytes((GID_BYTES,)) + gid


def answer_to(request: bytes, answered: bytes) -> bytes:
    """Return the attachment of an answer that is passed on: number and caller of `request`, time of `answered`."""
    when = answered if is_attachment(answered) else request
    return request[:_TIME_AT] + when[_TIME_AT:_GID_LENGTH_AT] + request[_GID_LENGTH_AT:]


def unpack_attachment(raw: bytes) -> Attachment:
    """Parse an attachment; raises WireError for anything but its 33 bytes."""
    if len(raw) != _LENGTH:
        raise WireError(f"an attachment has {_LENGTH} bytes, got {len(raw)}")
    sequence, timestamp, gid_length, gid = _LAYOUT.unpack(raw)
    if gid_length != GID_BYTES:
        raise WireError(f"an attachment's gid has {GID_BYTES} bytes, got {gid_length}")
    return _make((sequence, timestamp, gid))


def gid_of(token: str) -> bytes:
    """Return the 16-byte global id of an endpoint: XXH3-128 of its token, the low half first."""
    raw = token.encode(errors="surrogatepass")
    return xxhash.xxh3_128_intdigest(raw).to_bytes(GID_BYTES, "little")
