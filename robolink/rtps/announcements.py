"""Announcements of participants: themselves (SPDP) and their endpoints (SEDP), to and from parameter lists.

Source: RTPS 2.5, 8.5.3, 8.5.4 and 9.6.3; the defaults of absent QoS: DDS 1.4, 2.2.3.
"""

from __future__ import annotations

import math
import struct
from typing import NamedTuple

from robolink.rtps import ids
from robolink.rtps.ids import RtpsError
from robolink.rtps.parameters import (
    LIST_HEADER,
    SENTINEL,
    Buffer,
    Locator,
    Parameters,
    locators,
    number,
    octets,
    parameter,
    read_list,
    seconds,
    text,
)
from robolink.rtps.types import Qos

MOST_ANNOUNCED = 64 << 10
"""Bytes of an announcement. Those of ROS have some 500: a larger one is refused, since its words are kept."""
NO_DEPTH = -1
"""Depth of an endpoint that does not say how many samples it keeps."""

_BEST_EFFORT, _RELIABLE = 1, 2
_MANUAL_BY_TOPIC = 2
_KEEP_LAST, _KEEP_ALL = 0, 1
_XCDR1 = struct.pack("<Ih", 1, 0)
_BLOCKING = seconds(0.1)
_USUAL_LEASE = 100.0


class ParticipantData(NamedTuple):
    """A participant, as it announces itself."""

    prefix: bytes
    vendor: bytes = ids.VENDOR_ROBOLINK
    metatraffic: tuple[Locator, ...] = ()
    """Where its discovery is reached: UDP over IPv4, in its own order."""
    default: tuple[Locator, ...] = ()
    """Where those of its endpoints are reached that do not say it themselves."""
    lease: float = _USUAL_LEASE
    """Seconds after which it is gone if nothing comes from it; infinity: never."""
    name: str = ""
    user_data: bytes = b""
    domain: int | None = None
    """None: it does not say; then its port does."""
    builtin_endpoints: int = ids.BUILTIN_ENDPOINTS


class EndpointData(NamedTuple):
    """An endpoint, as its participant announces it."""

    guid: bytes
    is_writer: bool
    topic: str
    type_name: str
    qos: Qos = Qos()
    locators: tuple[Locator, ...] = ()
    """Where it is reached; empty: at its participant's."""
    user_data: bytes = b""


def encode_participant(data: ParticipantData) -> bytes:
    """Return the sample by which a participant announces itself."""
    found = [
        LIST_HEADER,
        parameter(ids.PID_PROTOCOL_VERSION, ids.PROTOCOL_VERSION),
        parameter(ids.PID_VENDOR, data.vendor),
        parameter(ids.PID_PARTICIPANT_GUID, data.prefix + ids.PARTICIPANT_ENTITY),
        locators(ids.PID_METATRAFFIC_UNICAST, data.metatraffic),
        locators(ids.PID_DEFAULT_UNICAST, data.default),
        parameter(ids.PID_LEASE, seconds(data.lease)),
        parameter(ids.PID_BUILTIN_ENDPOINTS, number(data.builtin_endpoints)),
        parameter(ids.PID_ENTITY_NAME, text(data.name)),
    ]
    if data.domain is not None:
        found.append(parameter(ids.PID_DOMAIN, number(data.domain)))
    if data.user_data:
        found.append(parameter(ids.PID_USER_DATA, octets(data.user_data)))
    return b"".join((*found, SENTINEL))


def read_participant(payload: Buffer) -> ParticipantData:
    """Return the announcement of a participant.

    Raises:
        RtpsError: if it is nonsense, or does not say who it is.
    """
    found = _read(payload)
    guid = found.raw(ids.PID_PARTICIPANT_GUID, ids.GUID_BYTES)
    if guid is None:
        raise RtpsError("a participant without a GUID")
    lease = found.seconds(ids.PID_LEASE)
    if ids.PID_LEASE not in found:
        lease = _USUAL_LEASE
    return ParticipantData(
        prefix=guid[: ids.PREFIX_BYTES],
        vendor=found.raw(ids.PID_VENDOR, 2) or b"\0\0",
        metatraffic=found.locators(ids.PID_METATRAFFIC_UNICAST),
        default=found.locators(ids.PID_DEFAULT_UNICAST),
        lease=math.inf if lease is None else lease,
        name=found.text(ids.PID_ENTITY_NAME),
        user_data=found.octets(ids.PID_USER_DATA),
        domain=found.number(ids.PID_DOMAIN, 0) if ids.PID_DOMAIN in found else None,
        builtin_endpoints=found.number(ids.PID_BUILTIN_ENDPOINTS, ids.BUILTIN_ENDPOINTS),
    )


def _read(payload: Buffer) -> Parameters:
    if len(payload) > MOST_ANNOUNCED:
        raise RtpsError(f"an announcement of {len(payload)} bytes: {MOST_ANNOUNCED} are read")
    return read_list(payload)


def encode_endpoint(data: EndpointData) -> bytes:
    """Return the sample by which a participant announces an endpoint."""
    qos = data.qos
    keep = (_KEEP_LAST, qos.depth) if qos.depth else (_KEEP_ALL, NO_DEPTH)
    found = [
        LIST_HEADER,
        parameter(ids.PID_ENDPOINT_GUID, data.guid),
        parameter(ids.PID_PARTICIPANT_GUID, data.guid[: ids.PREFIX_BYTES] + ids.PARTICIPANT_ENTITY),
        parameter(ids.PID_KEY_HASH, data.guid),
        parameter(ids.PID_TOPIC, text(data.topic)),
        parameter(ids.PID_TYPE, text(data.type_name)),
        parameter(ids.PID_RELIABILITY, number(_RELIABLE if qos.reliable else _BEST_EFFORT) + _BLOCKING),
        parameter(ids.PID_DURABILITY, number(int(qos.transient_local))),
        parameter(ids.PID_DEADLINE, seconds(qos.deadline)),
        parameter(ids.PID_LIVELINESS, number(qos.liveliness) + seconds(qos.lease)),
        parameter(ids.PID_REPRESENTATION, _XCDR1),
        locators(ids.PID_UNICAST, data.locators),
    ]
    if qos.depth != NO_DEPTH:
        found.append(parameter(ids.PID_HISTORY, struct.pack("<Ii", *keep)))
    if data.is_writer:
        found.append(parameter(ids.PID_LIFESPAN, seconds(qos.lifespan)))
    if data.user_data:
        found.append(parameter(ids.PID_USER_DATA, octets(data.user_data)))
    return b"".join((*found, SENTINEL))


def read_endpoint(payload: Buffer, *, is_writer: bool) -> EndpointData:
    """Return the announcement of an endpoint.

    Args:
        payload: the sample.
        is_writer: whether it came from the writer of publications, not of subscriptions.

    Raises:
        RtpsError: if it is nonsense, or lacks a GUID, a topic or a type.
    """
    found = _read(payload)
    guid = found.raw(ids.PID_ENDPOINT_GUID, ids.GUID_BYTES)
    topic, type_name = found.text(ids.PID_TOPIC), found.text(ids.PID_TYPE)
    if guid is None or not topic or not type_name:
        raise RtpsError(f"an endpoint without a GUID, a topic or a type (topic {topic!r}, type {type_name!r})")
    qos, user_data = _read_qos(found, is_writer), found.octets(ids.PID_USER_DATA)
    return EndpointData(guid, is_writer, topic, type_name, qos, found.locators(ids.PID_UNICAST), user_data)


def _read_qos(found: Parameters, is_writer: bool) -> Qos:
    depth = NO_DEPTH
    if ids.PID_HISTORY in found:
        keep = found.number(ids.PID_HISTORY, _KEEP_LAST)
        depth = 0 if keep == _KEEP_ALL else max(found.number(ids.PID_HISTORY, 1, at=4), 1)
    return Qos(
        # A writer that does not say is RELIABLE, a reader BEST_EFFORT.
        reliable=found.number(ids.PID_RELIABILITY, _RELIABLE if is_writer else _BEST_EFFORT) >= _RELIABLE,
        transient_local=found.number(ids.PID_DURABILITY, 0) > 0,
        depth=depth,
        deadline=found.seconds(ids.PID_DEADLINE),
        lifespan=found.seconds(ids.PID_LIFESPAN),
        liveliness=min(found.number(ids.PID_LIVELINESS, 0), _MANUAL_BY_TOPIC),
        lease=found.seconds(ids.PID_LIVELINESS, at=4),
    )


def encode_key(guid: bytes) -> bytes:
    """Return the sample that names a participant or endpoint which is gone."""
    pid = ids.PID_PARTICIPANT_GUID if guid[ids.PREFIX_BYTES :] == ids.PARTICIPANT_ENTITY else ids.PID_ENDPOINT_GUID
    return LIST_HEADER + parameter(pid, guid) + SENTINEL


def read_key(payload: Buffer) -> bytes:
    """Return the GUID of the participant or endpoint that such a sample names.

    Raises:
        RtpsError: if it is nonsense, or names none.
    """
    found = read_list(payload)
    guid = found.raw(ids.PID_ENDPOINT_GUID, ids.GUID_BYTES) or found.raw(ids.PID_PARTICIPANT_GUID, ids.GUID_BYTES)
    if guid is None:
        raise RtpsError("a key without a GUID")
    return guid
