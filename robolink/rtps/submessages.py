"""Submessages: what a datagram of RTPS consists of, read in both byte orders, written in little-endian.

`parse` reads a datagram; it copies no payload, so what it gives is valid as long as the datagram is. Each `encode_*`
function gives one submessage; `encode_header` begins a datagram. Source: RTPS 2.5, 8.3.8 and 9.4.5.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import NamedTuple

from robolink.rtps import ids
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import SENTINEL, Buffer, Parameters, parameter

HEADER_BYTES = 20
DATA_BYTES = 24
"""Bytes that a DATA adds to its payload and inline QoS."""
DATA_FRAG_BYTES = 36
"""Bytes that a DATA_FRAG adds to its payload and inline QoS."""
MOST_IN_SET = 256
"""Numbers that a set can span."""

_MAGIC = b"RTPS"
_PAD, _ACKNACK, _HEARTBEAT, _GAP, _INFO_TS = 0x01, 0x06, 0x07, 0x08, 0x09
_INFO_SRC, _INFO_DST, _NACK_FRAG, _HEARTBEAT_FRAG, _DATA, _DATA_FRAG = 0x0C, 0x0E, 0x12, 0x13, 0x15, 0x16
_LITTLE, _INLINE = 1, 2
_FINAL, _LIVELINESS, _INVALIDATE = 2, 4, 2
_DATA_PRESENT, _DATA_KEY, _FRAG_KEY = 4, 8, 4
_UNKNOWN_TIME = (0xFFFFFFFF, 0xFFFFFFFF)
_BILLION = 1_000_000_000


class Inline(NamedTuple):
    """Inline QoS of a sample, as far as it matters here."""

    status: int = 0
    """STATUS_DISPOSED, STATUS_UNREGISTERED."""
    key_hash: bytes | None = None
    """Of 16 bytes; in discovery, the GUID of what is gone."""
    related: tuple[bytes, int] | None = None
    """GUID and number of the sample that this one answers; number 0 where none is named."""


NO_INLINE = Inline()


class Data(NamedTuple):
    """A sample."""

    reader: bytes
    writer: bytes
    number: int
    payload: memoryview | None
    """Serialized, with its header of 4 bytes. It may end with up to 3 bytes more than were put: DATA is filled up to a
    multiple of 4. None: there is only what `inline` says."""
    inline: Inline = NO_INLINE
    is_key: bool = False
    """The payload is a key: of something that is gone."""


class DataFrag(NamedTuple):
    """Fragments of a sample, in a row."""

    reader: bytes
    writer: bytes
    number: int
    first: int
    """Number of the first fragment here; they count from 1."""
    fragments: int
    """Number of them."""
    fragment_size: int
    sample_size: int
    """Bytes of the whole sample, as the writer says: check it before you make room."""
    payload: memoryview
    """Exactly those bytes that belong at (first - 1) * fragment_size."""
    inline: Inline = NO_INLINE
    is_key: bool = False


class Heartbeat(NamedTuple):
    """The samples that a writer has: those from `first` to `last`, none if last is first - 1."""

    reader: bytes
    writer: bytes
    first: int
    last: int
    serial: int
    """Rises with each; one that does not is a repetition."""
    final: bool
    """No answer is expected from those who have everything."""
    liveliness: bool = False
    """The writer's program says that it is alive."""


class HeartbeatFrag(NamedTuple):
    """The fragments that a writer has of a sample: those up to `last`."""

    reader: bytes
    writer: bytes
    number: int
    last: int
    serial: int


class AckNack(NamedTuple):
    """The samples that a reader has: all before `base`; it requests the `missing` ones."""

    reader: bytes
    writer: bytes
    base: int
    missing: list[int]
    serial: int
    final: bool
    """No heartbeat is expected."""


class NackFrag(NamedTuple):
    """Fragments of a sample that a reader requests."""

    reader: bytes
    writer: bytes
    number: int
    missing: list[int]
    serial: int


class Gap(NamedTuple):
    """Samples that will not come: from `first` to base - 1 (which may be 2^63 of them), and the `others`."""

    reader: bytes
    writer: bytes
    first: int
    base: int
    others: list[int]


class InfoTimestamp(NamedTuple):
    """When the samples that follow were written: nanoseconds since 1970, 0 where it is unknown."""

    timestamp: int


class InfoDestination(NamedTuple):
    """Whom the submessages that follow are for: a participant's prefix, zeros for everybody."""

    prefix: bytes


class InfoSource(NamedTuple):
    """The sender of the submessages that follow, as somebody says who passes them on."""

    prefix: bytes
    vendor: bytes


Submessage = (
    Data
    | DataFrag
    | Heartbeat
    | HeartbeatFrag
    | AckNack
    | NackFrag
    | Gap
    | InfoTimestamp
    | InfoDestination
    | InfoSource
)


class Message(NamedTuple):
    """A datagram."""

    prefix: bytes
    """Of the participant that sent it."""
    vendor: bytes
    submessages: list[Submessage]


class _Layouts(NamedTuple):
    """The structures of one byte order."""

    little: bool
    data: struct.Struct
    fragments: struct.Struct
    heartbeat: struct.Struct
    heartbeat_frag: struct.Struct
    ids_number: struct.Struct
    gap: struct.Struct
    number: struct.Struct
    word: struct.Struct
    two_words: struct.Struct


def _layouts(order: str) -> _Layouts:
    shapes = ("HH4s4siI", "IHHI", "4s4siIiII", "4s4siIII", "4s4siI", "4s4siIiI", "iI", "I", "II")
    return _Layouts(order == "<", *(struct.Struct(order + shape) for shape in shapes))


_LITTLE_ENDIAN, _BIG_ENDIAN = _layouts("<"), _layouts(">")
_HEAD, _BIG_SIZE = struct.Struct("<BBH"), struct.Struct(">H")


def parse(datagram: Buffer) -> Message:
    """Read a datagram. What this version of the protocol does not know is left out.

    Args:
        datagram: what came; the payloads are views of it.

    Raises:
        RtpsError: if it is not RTPS 2, or anything in it is cut or contradicts itself.
    """
    if len(datagram) < HEADER_BYTES or datagram[:4] != _MAGIC or datagram[4] != 2:
        raise RtpsError(f"not RTPS 2: {len(datagram)} bytes that begin with {bytes(datagram[:6]).hex() or 'nothing'}")
    view = memoryview(datagram)
    found: list[Submessage] = []
    at, size = HEADER_BYTES, len(view)
    try:
        while at < size:
            kind, flags, length = _HEAD.unpack_from(view, at)
            layouts = _LITTLE_ENDIAN
            if not flags & _LITTLE:
                layouts = _BIG_ENDIAN
                (length,) = _BIG_SIZE.unpack_from(view, at + 2)
            at += 4
            # A length of 0 means "up to the end of the datagram", so that the last may be longer than 64 kB.
            end = at + length if length or kind in {_PAD, _INFO_TS} else size
            if end > size:
                raise RtpsError(f"submessage {kind:#04x} of {length} bytes, of which {size - at} came")
            read = _READERS.get(kind)
            if read is not None:
                found.append(read(view[at:end], flags, layouts))
            at = end
    except struct.error as error:
        raise RtpsError(f"a submessage that is cut: {error}") from None
    return Message(bytes(view[8:20]), bytes(view[6:8]), found)


def _read_inline(body: memoryview, at: int, layouts: _Layouts) -> tuple[Inline, int]:
    """Read the inline QoS; return where the payload begins, too."""
    found = Parameters(body, at, little=layouts.little)
    related = found.raw(ids.PID_RELATED_SAMPLE, 24) or found.raw(ids.PID_RELATED_SAMPLE_FASTDDS, 24)
    # The status is 4 octets, not a number: its bits are in the last one in both byte orders.
    status = found.raw(ids.PID_STATUS_INFO, 4)
    return Inline(
        status[3] if status else 0,
        found.raw(ids.PID_KEY_HASH, 16),
        None if related is None else (related[:16], max(_join(*layouts.number.unpack_from(related, 16)), 0)),
    ), found.end


def _read_data(body: memoryview, flags: int, layouts: _Layouts) -> Data:
    _, skip, reader, writer, high, low = layouts.data.unpack_from(body)
    number = _sequence_number(high, low)
    at, inline = 4 + skip, NO_INLINE  # what a later version adds to the head is skipped
    if at < layouts.data.size or at > len(body):
        raise RtpsError(f"DATA whose payload begins at {at} of {len(body)} bytes")
    if flags & _INLINE:
        inline, at = _read_inline(body, at, layouts)
    payload = body[at:] if flags & (_DATA_PRESENT | _DATA_KEY) else None
    return Data(reader, writer, number, payload, inline, bool(flags & _DATA_KEY))


def _read_fragments(body: memoryview, flags: int, layouts: _Layouts) -> DataFrag:
    head = layouts.data.size
    _, skip, reader, writer, high, low = layouts.data.unpack_from(body)
    number = _sequence_number(high, low)
    first, count, size, total = layouts.fragments.unpack_from(body, head)
    at, inline = 4 + skip, NO_INLINE
    if at < head + layouts.fragments.size:
        raise RtpsError(f"DATA_FRAG whose payload begins at {at}")
    if flags & _INLINE:
        inline, at = _read_inline(body, at, layouts)
    begin = (first - 1) * size
    length = min(count * size, total - begin)
    # Also: the last fragment of the row begins inside the sample. Who keeps fragments by number relies on it.
    if not first or not count or not size or length <= (count - 1) * size or at + length > len(body):
        raise RtpsError(
            f"DATA_FRAG with {len(body) - at} bytes for fragments {first} to {first + count - 1}"
            f" of {size} bytes, of a sample of {total}"
        )
    payload = body[at : at + length]
    return DataFrag(reader, writer, number, first, count, size, total, payload, inline, bool(flags & _FRAG_KEY))


def _read_heartbeat(body: memoryview, flags: int, layouts: _Layouts) -> Heartbeat:
    reader, writer, high, low, last_high, last_low, serial = layouts.heartbeat.unpack_from(body)
    first, last = _join(high, low), _join(last_high, last_low)
    if first < 0 or last < first - 1:
        raise RtpsError(f"HEARTBEAT of samples {first} to {last}")
    # The numbers begin at 1; some say 0 to 0 before their first sample, which is not a sample that one could wait for.
    return Heartbeat(
        reader, writer, max(first, 1), max(last, 0), serial, bool(flags & _FINAL), bool(flags & _LIVELINESS)
    )


def _read_heartbeat_frag(body: memoryview, _: int, layouts: _Layouts) -> HeartbeatFrag:
    reader, writer, high, low, last, serial = layouts.heartbeat_frag.unpack_from(body)
    return HeartbeatFrag(reader, writer, _sequence_number(high, low), last, serial)


def _read_acknack(body: memoryview, flags: int, layouts: _Layouts) -> AckNack:
    reader, writer, high, low = layouts.ids_number.unpack_from(body)
    base = _join(high, low)
    if base < 0:  # 0 is what Fast DDS sends, and expects, of a reader that has heard nothing yet
        raise RtpsError(f"ACKNACK with base {base}")
    missing, at = _read_set(body, 16, base, layouts)
    (serial,) = layouts.word.unpack_from(body, at)
    return AckNack(reader, writer, base, missing, serial, bool(flags & _FINAL))


def _read_nack_frag(body: memoryview, _: int, layouts: _Layouts) -> NackFrag:
    reader, writer, high, low = layouts.ids_number.unpack_from(body)
    (base,) = layouts.word.unpack_from(body, 16)
    missing, at = _read_set(body, 20, base, layouts)
    (serial,) = layouts.word.unpack_from(body, at)
    return NackFrag(reader, writer, _sequence_number(high, low), missing, serial)


def _read_gap(body: memoryview, _: int, layouts: _Layouts) -> Gap:
    reader, writer, high, low, base_high, base_low = layouts.gap.unpack_from(body)
    first, base = _sequence_number(high, low), _join(base_high, base_low)
    if base < first:
        raise RtpsError(f"GAP from {first} to before {base}")
    others, _at = _read_set(body, 24, base, layouts)
    return Gap(reader, writer, first, base, others)


def _read_timestamp(body: memoryview, flags: int, layouts: _Layouts) -> InfoTimestamp:
    if flags & _INVALIDATE:
        return InfoTimestamp(0)
    stamp = layouts.two_words.unpack_from(body)
    if stamp == _UNKNOWN_TIME:
        return InfoTimestamp(0)
    # Rounded up, as `encode_info_timestamp` rounds down: so nanoseconds come back as they were.
    return InfoTimestamp(stamp[0] * _BILLION + (stamp[1] * _BILLION + 0xFFFFFFFF >> 32))


def _read_destination(body: memoryview, _: int, _layouts: _Layouts) -> InfoDestination:
    return InfoDestination(_exactly(body[:12], 12))


def _read_source(body: memoryview, _: int, _layouts: _Layouts) -> InfoSource:
    return InfoSource(_exactly(body[8:20], 12), _exactly(body[6:8], 2))


_READERS: dict[int, Callable[[memoryview, int, _Layouts], Submessage]] = {
    _ACKNACK: _read_acknack,
    _HEARTBEAT: _read_heartbeat,
    _GAP: _read_gap,
    _INFO_TS: _read_timestamp,
    _INFO_SRC: _read_source,
    _INFO_DST: _read_destination,
    _NACK_FRAG: _read_nack_frag,
    _HEARTBEAT_FRAG: _read_heartbeat_frag,
    _DATA: _read_data,
    _DATA_FRAG: _read_fragments,
}


def _exactly(part: memoryview, size: int) -> bytes:
    if len(part) != size:
        raise RtpsError(f"{len(part)} bytes where {size} are due")
    return bytes(part)


def _join(high: int, low: int) -> int:
    return (high << 32) | low


def _sequence_number(high: int, low: int) -> int:
    """Return the number of a sample: they count from 1."""
    number = (high << 32) | low
    if number < 1:
        raise RtpsError(f"sample {number}")
    return number


def _read_set(body: memoryview, at: int, base: int, layouts: _Layouts) -> tuple[list[int], int]:
    """Read a set of numbers from a base on: its size in bits, then as many words of 32 bits, highest bit first."""
    (bits,) = layouts.word.unpack_from(body, at)
    if bits > MOST_IN_SET:
        raise RtpsError(f"a set of {bits} numbers: {MOST_IN_SET} are allowed")
    found = []
    at += 4
    for begin in range(base, base + bits, 32):
        (word,) = layouts.word.unpack_from(body, at)
        at += 4
        if word:
            found += [begin + bit for bit in range(min(32, base + bits - begin)) if word >> (31 - bit) & 1]
    return found, at


_DATA_HEAD = struct.Struct("<BBHHH4s4siI")
_FRAG_HEAD = struct.Struct("<BBHHH4s4siIIHHI")
_HEARTBEAT_WHOLE = struct.Struct("<BBH4s4siIiII")
_HEARTBEAT_FRAG_WHOLE = struct.Struct("<BBH4s4siIII")
_TIMESTAMP_WHOLE = struct.Struct("<BBHII")
_ACKNACK_HEAD = struct.Struct("<4s4siI")
_GAP_HEAD = struct.Struct("<4s4siIiI")
_SERIAL = struct.Struct("<I")
_FILLINGS = (b"", b"\0\0\0", b"\0\0", b"\0")
"""By the size modulo 4."""


def encode_header(prefix: bytes, vendor: bytes = ids.VENDOR_ROBOLINK) -> bytes:
    """Return the beginning of a participant's datagrams."""
    return _MAGIC + ids.PROTOCOL_VERSION + vendor + prefix


def encode_info_destination(prefix: bytes) -> bytes:
    """Return INFO_DST: whom the rest of the datagram is for."""
    return b"\x0e\x01\x0c\0" + prefix


def encode_info_timestamp(timestamp: int) -> bytes:
    """Return INFO_TS: when what follows was written, in nanoseconds since 1970; 0: unknown."""
    if timestamp <= 0:
        return b"\x09\x03\0\0"
    whole, rest = divmod(timestamp, _BILLION)
    return _TIMESTAMP_WHOLE.pack(_INFO_TS, _LITTLE, 8, whole & 0xFFFFFFFF, (rest << 32) // _BILLION)


def encode_inline(inline: Inline) -> bytes:
    """Return inline QoS, b"" if it says nothing."""
    found = b""
    if inline.related is not None:
        guid, number = inline.related
        identity = guid + struct.pack("<iI", number >> 32, number & 0xFFFFFFFF)
        # Fast DDS before 3 knows only its own number for it, others only the standard's.
        found += parameter(ids.PID_RELATED_SAMPLE, identity) + parameter(ids.PID_RELATED_SAMPLE_FASTDDS, identity)
    if inline.key_hash is not None:
        found += parameter(ids.PID_KEY_HASH, inline.key_hash)
    if inline.status:
        found += parameter(ids.PID_STATUS_INFO, bytes((0, 0, 0, inline.status)))
    return found + SENTINEL if found else b""


def encode_data(
    reader: bytes, writer: bytes, number: int, payload: Buffer | None, inline: bytes = b"", *, is_key: bool = False
) -> bytes:
    """Return DATA: a sample.

    Args:
        reader: whom it is for; UNKNOWN_ENTITY for all that are matched.
        writer: who wrote it.
        number: which of the writer's samples it is, from 1 on.
        payload: serialized, with its header of 4 bytes. None: there is only what `inline` says.
        inline: what `encode_inline` gave.
        is_key: the payload is a key: of something that is gone.
    """
    flags = _LITTLE | _INLINE if inline else _LITTLE
    if payload is None:
        payload = b""
    else:
        flags |= _DATA_KEY if is_key else _DATA_PRESENT
    size = len(payload)
    # Submessages begin at multiples of 4, so what follows the payload does: its reader gets up to 3 zeros more than
    # were put, as from Fast DDS. CDR says itself where it ends.
    filling = _FILLINGS[size % 4]
    length = 20 + len(inline) + size + len(filling)
    head = _DATA_HEAD.pack(
        _DATA, flags, length if length <= 0xFFFF else 0, 0, 16, reader, writer, number >> 32, number & 0xFFFFFFFF
    )
    return b"".join((head, inline, payload, filling))


def encode_data_frag(
    reader: bytes,
    writer: bytes,
    number: int,
    fragment: int,
    fragment_size: int,
    sample: Buffer,
    inline: bytes = b"",
    *,
    is_key: bool = False,
) -> tuple[bytes, memoryview, bytes]:
    """Return DATA_FRAG, one fragment of a sample, in three pieces: what is before it, a view of it, and the filling.

    Args:
        reader: whom it is for; UNKNOWN_ENTITY for all that are matched.
        writer: who wrote it.
        number: which of the writer's samples it is, from 1 on.
        fragment: which of the sample's fragments, from 1 on.
        fragment_size: of each but the last; at most 65,535, and the same for every fragment of the sample.
        sample: the whole of it, serialized, with its header of 4 bytes.
        inline: what `encode_inline` gave.
        is_key: the sample is a key: of something that is gone.
    """
    at = (fragment - 1) * fragment_size
    piece = memoryview(sample)[at : at + fragment_size]
    filling = _FILLINGS[len(piece) % 4]
    length = 32 + len(inline) + len(piece) + len(filling)
    flags = _LITTLE | (_INLINE if inline else 0) | (_FRAG_KEY if is_key else 0)
    where = (reader, writer, number >> 32, number & 0xFFFFFFFF, fragment, 1, fragment_size, len(sample))
    head = _FRAG_HEAD.pack(_DATA_FRAG, flags, length if length <= 0xFFFF else 0, 0, 28, *where)
    return head + inline, piece, filling


def encode_heartbeat(
    reader: bytes, writer: bytes, first: int, last: int, serial: int, *, final: bool = False, liveliness: bool = False
) -> bytes:
    """Return HEARTBEAT: a writer has the samples from `first` to `last` (first - 1: none)."""
    flags = _LITTLE | (_FINAL if final else 0) | (_LIVELINESS if liveliness else 0)
    numbers = (first >> 32, first & 0xFFFFFFFF, last >> 32, last & 0xFFFFFFFF, serial)
    return _HEARTBEAT_WHOLE.pack(_HEARTBEAT, flags, 28, reader, writer, *numbers)


def encode_heartbeat_frag(reader: bytes, writer: bytes, number: int, last: int, serial: int) -> bytes:
    """Return HEARTBEAT_FRAG: a writer has the fragments up to `last` of a sample."""
    numbers = (number >> 32, number & 0xFFFFFFFF, last, serial)
    return _HEARTBEAT_FRAG_WHOLE.pack(_HEARTBEAT_FRAG, _LITTLE, 24, reader, writer, *numbers)


def encode_acknack(
    reader: bytes, writer: bytes, base: int, missing: Sequence[int], serial: int, *, final: bool = False
) -> bytes:
    """Return ACKNACK: a reader has all before `base`, and requests what is missing.

    Args:
        reader: who has them.
        writer: whose they are.
        base: the first that it does not have, or 0: it has heard nothing.
        missing: rising, from `base` on; those further than 255 from it are left out.
        serial: larger than the last time.
        final: no heartbeat is expected.
    """
    head = _ACKNACK_HEAD.pack(reader, writer, base >> 32, base & 0xFFFFFFFF)
    body = head + _encode_set(base, missing) + _SERIAL.pack(serial)
    return _HEAD.pack(_ACKNACK, _LITTLE | _FINAL if final else _LITTLE, len(body)) + body


def encode_nack_frag(reader: bytes, writer: bytes, number: int, missing: Sequence[int], serial: int) -> bytes:
    """Return NACK_FRAG: a reader requests fragments of a sample: at least one, rising, within 256 of the first."""
    head = _ACKNACK_HEAD.pack(reader, writer, number >> 32, number & 0xFFFFFFFF)
    body = head + _SERIAL.pack(missing[0]) + _encode_set(missing[0], missing) + _SERIAL.pack(serial)
    return _HEAD.pack(_NACK_FRAG, _LITTLE, len(body)) + body


def encode_gap(reader: bytes, writer: bytes, first: int, base: int, others: Sequence[int] = ()) -> bytes:
    """Return GAP: the samples from `first` to base - 1 will not come, nor the others (rising, within 256 of `base`)."""
    numbers = (first >> 32, first & 0xFFFFFFFF, base >> 32, base & 0xFFFFFFFF)
    body = _GAP_HEAD.pack(reader, writer, *numbers) + _encode_set(base, others)
    return _HEAD.pack(_GAP, _LITTLE, len(body)) + body


def _encode_set(base: int, numbers: Sequence[int]) -> bytes:
    """Return a set: its size in bits, then words; its base, of 8 bytes or 4, stands before it."""
    bits = words = 0
    for number in numbers:
        place = number - base
        if place >= MOST_IN_SET:
            break
        words |= 1 << (MOST_IN_SET - 1 - place)
        bits = place + 1
    size = (bits + 31) // 32
    whole = words.to_bytes(MOST_IN_SET // 8, "big")[: 4 * size]
    return struct.pack(f"<I{size}I", bits, *struct.unpack(f">{size}I", whole))
