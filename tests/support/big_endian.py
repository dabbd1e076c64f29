"""What a big-endian machine would send: rewrites a datagram of RTPS in the other byte order."""

from __future__ import annotations

import struct

from robolink.rtps import ids

_WORDS_AFTER = {0x06: 8, 0x07: 8, 0x08: 8, 0x09: 0, 0x12: 8, 0x13: 8}
"""Where the 32-bit words of a submessage begin, by its kind."""
_OCTETS = {ids.PID_PARTICIPANT_GUID, ids.PID_ENDPOINT_GUID, ids.PID_KEY_HASH, ids.PID_STATUS_INFO}
_OCTETS |= {ids.PID_VENDOR, ids.PID_PROTOCOL_VERSION}
_LOCATORS = {ids.PID_UNICAST, ids.PID_DEFAULT_UNICAST, ids.PID_METATRAFFIC_UNICAST}
_SEQUENCES = {ids.PID_TOPIC, ids.PID_TYPE, ids.PID_ENTITY_NAME, ids.PID_USER_DATA}
_IDENTITIES = {ids.PID_RELATED_SAMPLE, ids.PID_RELATED_SAMPLE_FASTDDS}


def big_endian(raw: bytes) -> bytes:
    """Return a little-endian datagram in big-endian; payloads that are not lists stay as they are."""
    out, at = raw[:20], 20
    while at < len(raw):
        kind, flags, size = struct.unpack_from("<BBH", raw, at)
        end = at + 4 + size if size or kind == 0x09 else len(raw)
        body = raw[at + 4 : end]
        if kind in _WORDS_AFTER:
            body = body[: _WORDS_AFTER[kind]] + _words(body[_WORDS_AFTER[kind] :])
        elif kind in {0x15, 0x16}:
            body = _data(body, kind, flags)
        out += struct.pack(">BBH", kind, flags & ~1, size) + body
        at = end
    return out


def _words(raw: bytes) -> bytes:
    return b"".join(raw[at : at + 4][::-1] for at in range(0, len(raw), 4))


def _data(body: bytes, kind: int, flags: int) -> bytes:
    out = struct.pack(">HH", *struct.unpack_from("<HH", body)) + body[4:12] + _words(body[12:20])
    at = 20
    if kind == 0x16:
        out += struct.pack(">IHHI", *struct.unpack_from("<IHHI", body, 20))
        at = 32
    if flags & 2:
        inline, at = _list(body, at)
        out += inline
    payload = body[at:]
    if payload[:2] == b"\0\3":
        payload = b"\0\2\0\0" + _list(payload, 4)[0]
    return out + payload


def _list(raw: bytes, at: int) -> tuple[bytes, int]:
    out = b""
    while True:
        pid, size = struct.unpack_from("<HH", raw, at)
        value = raw[at + 4 : at + 4 + size]
        at += 4 + size
        if pid in _LOCATORS:
            value = _words(value[:8]) + value[8:]
        elif pid in _SEQUENCES:
            value = _words(value[:4]) + value[4:]
        elif pid in _IDENTITIES:
            value = value[:16] + _words(value[16:])
        elif pid == ids.PID_REPRESENTATION:
            value = _words(value[:4]) + value[4:6][::-1] + value[6:]
        elif pid not in _OCTETS:
            value = _words(value)
        out += struct.pack(">HH", pid, size) + value
        if pid == ids.PID_SENTINEL:
            return out, at
