"""The two forms in which DDS identifies a call: by inline QoS (Fast DDS), and by a header in the payload (Cyclone).

rmw_fastrtps, rmw_connextdds and robolink send the identity of the request beside the payload (RTPS 2.5's
PID_RELATED_SAMPLE_IDENTITY). rmw_cyclonedds, and so zenoh-bridge-ros2dds, has 16 bytes behind the encapsulation header
of both: u64, the client; i64, its number. Neither reads the other's, so each peer gets its own, by its vendor.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

CYCLONE_VENDOR = b"\x01\x10"
"""Vendor id of Eclipse Cyclone DDS, RTPS 2.5's table of vendors."""

_ENCAPSULATION_BYTES = 4
_HEADER_BYTES = 16


class Header(NamedTuple):
    """Header of Cyclone's requests and replies."""

    client: int
    number: int


def has_header(vendor: bytes) -> bool:
    """Return whether peers of this vendor have the header in their payloads."""
    return vendor == CYCLONE_VENDOR


def with_header(payload: bytes, header: Header) -> bytes:
    """Return a payload with a header, in the payload's own byte order."""
    at = _ENCAPSULATION_BYTES
    return payload[:at] + struct.pack(_order(payload) + "Qq", *header) + payload[at:]


def split_header(payload: bytes) -> tuple[Header, bytes] | None:
    """Return the header of a payload, and the payload without it; None if it is too short to have one."""
    at, end = _ENCAPSULATION_BYTES, _ENCAPSULATION_BYTES + _HEADER_BYTES
    if len(payload) < end:
        return None
    return Header(*struct.unpack_from(_order(payload) + "Qq", payload, at)), payload[:at] + payload[end:]


def _order(payload: bytes) -> str:
    return "<" if len(payload) > 1 and payload[1] & 1 else ">"
