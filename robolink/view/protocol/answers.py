"""Words and messages of the server: Foxglove's numbers, JSON operations as text, binary ones and batches as bytes."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import msgspec

_message = struct.Struct("<BIQ")

_entry = struct.Struct("<IIQ")

_time = struct.Struct("<BQ")

_service = struct.Struct("<BIII")

_asset = struct.Struct("<BIBI")

_playback = struct.Struct("<BBQfBI")

TEXT, BINARY = 0x81, 0x82
"""First bytes of a WebSocket frame that is whole."""

ROBOLINK = "robolink.v1"
"""Subprotocol of the page: Foxglove's, with batches, credits, rates, statistics and recording."""

FOXGLOVE_SDK = "foxglove.sdk.v1"

FOXGLOVE_WEBSOCKET = "foxglove.websocket.v1"

SUBPROTOCOLS = (ROBOLINK, FOXGLOVE_SDK, FOXGLOVE_WEBSOCKET)
"""All of them, the preferred one first."""

INFO, WARNING, ERROR = 0, 1, 2
"""Levels of a status."""

PLAYING, PAUSED, BUFFERING, ENDED = 0, 1, 2, 3
"""States of playback."""

ENCODINGS = ("cdr", "json")
"""Encodings in which clients may publish and call."""


class Entry(NamedTuple):
    """Message on its way to a client."""

    subscription: int
    at: int
    """Time of arrival, in ns since the epoch."""
    payload: bytes
    sender: bytes
    """Attachment or gid of its publisher, by which messages of several are told apart."""


def text(op: str, **fields: Any) -> str:
    """Return a JSON operation; a field that is None is left out."""
    given = {name: value for name, value in fields.items() if value is not None}
    return msgspec.json.encode({"op": op, **given}).decode()


def status(level: int, message: str, id_: str | None = None) -> str:
    """Return a status: `level` 0 info, 1 warning, 2 error; one of the same id replaces the one before."""
    return text("status", level=level, message=message, id=id_)


def service_call_failure(service_id: int, call_id: int, message: str) -> str:
    """Return the answer to a service call that failed."""
    return text("serviceCallFailure", serviceId=service_id, callId=call_id, message=message)


def service_response(service_id: int, call_id: int, encoding: str, payload: bytes) -> bytes:
    """Return the answer to a service call."""
    name = encoding.encode()
    return _service.pack(3, service_id, call_id, len(name)) + name + payload


def asset_refusal(request_id: int, message: str) -> bytes:
    """Return the answer to `fetchAsset` where there is none."""
    words = message.encode()
    return _asset.pack(4, request_id, ERROR - 1, len(words)) + words


def time(now: int) -> bytes:
    """Return the time of the system, in ns, when it is not the clock's."""
    return _time.pack(2, now)


def playback_state(state: int, now: int, speed: float, did_seek: bool, request_id: str = "") -> bytes:
    """Return the state of the playback of a bag; `now` in ns, `request_id` of the command that it answers."""
    name = request_id.encode()
    return _playback.pack(5, state, now, speed, did_seek, len(name)) + name


def head(length: int, first: int = BINARY) -> bytes:
    """Return the head of a whole WebSocket frame from a server, for `length` bytes of payload."""
    if length < 126:
        return bytes((first, length))
    if length < 1 << 16:
        return struct.pack(">BBH", first, 126, length)
    return struct.pack(">BBQ", first, 127, length)


def message_frames(entries: Iterable[Entry]) -> bytes:
    """Return WebSocket frames of Foxglove's message data, one for each message."""
    parts: list[bytes] = []
    add, pack = parts.append, _message.pack
    for subscription, at, payload, _ in entries:
        add(head(len(payload) + 13))
        add(pack(1, subscription, at))
        add(payload)
    return b"".join(parts)


def batch(entries: Sequence[Entry]) -> bytes:
    """Return a batch of messages (robolink.v1), without its frame."""
    parts = [b"\x80"]
    add, pack = parts.append, _entry.pack
    for subscription, at, payload, _ in entries:
        add(pack(len(payload), subscription, at))
        add(payload)
    return b"".join(parts)
