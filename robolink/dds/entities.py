"""ros_discovery_info: the topic on which each participant of ROS 2 tells its nodes, and what belongs to which.

The message is rmw_dds_common/msg/ParticipantEntitiesInfo in CDR. An id has 16 bytes since Iron (rmw_dds_common 2.0) and
24 in Humble, whose last eight are zero; messages of both are read, those of 16 written.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from robolink.exceptions import WireError

TOPIC = "ros_discovery_info"
TYPE = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"

GUID_BYTES = 16
_HUMBLE_BYTES = 24

MOST_NODES, MOST_IDS = 1000, 20_000
"""Most nodes of one participant, and most ids of one node's: a message with more is refused."""

LONGEST_NAME = 4096
"""Longest namespace or name, in bytes."""

_LITTLE, _BIG = b"\0\1", b"\0\0"
_PADDING = 3
"""Most bytes behind a message: RTPS pads payloads to multiples of four."""


class NodeEntities(NamedTuple):
    """A node, and the GUIDs of its endpoints."""

    namespace: str
    name: str
    readers: tuple[bytes, ...]
    writers: tuple[bytes, ...]


class ParticipantEntities(NamedTuple):
    """All nodes of one participant."""

    guid: bytes
    """GUID of the participant, 16 bytes."""
    nodes: tuple[NodeEntities, ...]


def encode(entities: ParticipantEntities) -> bytes:
    """Return the payload of a message, little-endian, with its 4-byte header."""
    body = bytearray(entities.guid)
    _put_number(body, len(entities.nodes))
    for node in entities.nodes:
        for text in (node.namespace, node.name):
            raw = text.encode() + b"\0"
            _put_number(body, len(raw))
            body += raw
        for ids in (node.readers, node.writers):
            _put_number(body, len(ids))
            body += b"".join(ids)
    return _LITTLE + b"\0\0" + bytes(body)


def _put_number(body: bytearray, number: int) -> None:
    body += bytes(-len(body) % 4)
    body += struct.pack("<I", number)


def decode(payload: bytes) -> ParticipantEntities:
    """Read a message of either byte order, with ids of 16 or 24 bytes. Raises WireError for anything else."""
    # No field says how long an id is: read with the wrong length, a message does not end where its payload does.
    try:
        return _Reading(payload, GUID_BYTES).message()
    except WireError as error:
        try:
            return _Reading(payload, _HUMBLE_BYTES).message()
        except WireError:
            raise error from None


class _Reading:
    """Position in a message that is being read."""

    def __init__(self, payload: bytes, id_bytes: int) -> None:
        if payload[:2] not in (_LITTLE, _BIG):
            raise WireError(f"{TOPIC}: expected plain CDR, got a message that begins with {payload[:4].hex(' ')}")
        self._body, self._at, self._id_bytes = payload[4:], 0, id_bytes
        self._number = struct.Struct("<I" if payload[:2] == _LITTLE else ">I")

    def message(self) -> ParticipantEntities:
        guid = self._id()
        nodes = tuple(self._node() for _ in range(self._count(MOST_NODES)))
        if len(self._body) - self._at > _PADDING:
            raise WireError(f"{TOPIC}: {len(self._body) - self._at} bytes too many")
        return ParticipantEntities(guid, nodes)

    def _node(self) -> NodeEntities:
        return NodeEntities(self._text(), self._text(), self._ids(), self._ids())

    def _ids(self) -> tuple[bytes, ...]:
        return tuple(self._id() for _ in range(self._count(MOST_IDS)))

    def _id(self) -> bytes:
        return self._take(self._id_bytes)[:GUID_BYTES]

    def _text(self) -> str:
        raw = self._take(self._count(LONGEST_NAME))
        try:
            return raw.rstrip(b"\0").decode()
        except UnicodeDecodeError as error:
            raise WireError(f"{TOPIC}: a name that is not UTF-8: {error}") from None

    def _count(self, most: int) -> int:
        self._at += -self._at % 4
        (count,) = self._number.unpack(self._take(4))
        if count > most:
            raise WireError(f"{TOPIC}: {count:,} elements where {most:,} are the most")
        return int(count)

    def _take(self, size: int) -> bytes:
        taken = self._body[self._at : self._at + size]
        if len(taken) < size:
            raise WireError(f"{TOPIC}: it ends early, after {len(self._body)} bytes")
        self._at += size
        return taken
