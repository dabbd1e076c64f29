"""Numbers that RTPS gives to things: entity ids, parameters, vendors, and the error of this room.

A GUID is `bytes` of 16: the 12 of its participant's prefix, then the 4 of its entity id. Source: RTPS 2.5, 9.3 and 9.6.
"""

from __future__ import annotations


class RtpsError(ValueError):
    """Nonsense in what another participant sent: it says what was found, where."""


PREFIX_BYTES = 12
GUID_BYTES = 16

VENDOR_EPROSIMA = b"\x01\x0f"
"""Fast DDS."""
VENDOR_ECLIPSE = b"\x01\x10"
"""Cyclone DDS."""
VENDOR_ROBOLINK = b"\x01\xee"

PROTOCOL_VERSION = b"\x02\x03"
"""Version that we announce. Others of version 2 are read whatever their minor number is."""

UNKNOWN_ENTITY = b"\0\0\0\0"
"""As the reader of a submessage: all readers of the participant that are matched with its writer."""
PARTICIPANT_ENTITY = b"\0\0\x01\xc1"

SPDP_WRITER, SPDP_READER = b"\0\x01\0\xc2", b"\0\x01\0\xc7"
"""Of the Simple Participant Discovery Protocol: who is here."""
PUBLICATIONS_WRITER, PUBLICATIONS_READER = b"\0\0\x03\xc2", b"\0\0\x03\xc7"
SUBSCRIPTIONS_WRITER, SUBSCRIPTIONS_READER = b"\0\0\x04\xc2", b"\0\0\x04\xc7"
"""Of the Simple Endpoint Discovery Protocol: what writers and readers a participant has."""
MESSAGE_WRITER, MESSAGE_READER = b"\0\x02\0\xc2", b"\0\x02\0\xc7"
"""Of the Writer Liveliness Protocol: ParticipantMessageData."""

KEYLESS_WRITER, KEYLESS_READER = 0x03, 0x04
"""Kinds (the last byte of an entity id) of a program's endpoints of types without keys, as those of ROS are. A DDS does
not match them with keyed ones (0x02, 0x07)."""

BUILTIN_ENDPOINTS = 0x3F
"""Bits of PID_BUILTIN_ENDPOINTS: that we announce and detect participants, publications and subscriptions."""

STATUS_DISPOSED, STATUS_UNREGISTERED = 1, 2
"""Bits of PID_STATUS_INFO: what a sample says of its instance. Both: it is gone."""

PID_SENTINEL = 0x0001
PID_LEASE = 0x0002
PID_TOPIC = 0x0005
PID_TYPE = 0x0007
PID_DOMAIN = 0x000F
PID_PROTOCOL_VERSION = 0x0015
PID_VENDOR = 0x0016
PID_RELIABILITY = 0x001A
PID_LIVELINESS = 0x001B
PID_DURABILITY = 0x001D
PID_DEADLINE = 0x0023
PID_LIFESPAN = 0x002B
PID_USER_DATA = 0x002C
PID_UNICAST = 0x002F
PID_DEFAULT_UNICAST = 0x0031
PID_METATRAFFIC_UNICAST = 0x0032
PID_HISTORY = 0x0040
PID_PARTICIPANT_GUID = 0x0050
PID_BUILTIN_ENDPOINTS = 0x0058
PID_ENDPOINT_GUID = 0x005A
PID_ENTITY_NAME = 0x0062
PID_KEY_HASH = 0x0070
PID_STATUS_INFO = 0x0071
PID_REPRESENTATION = 0x0073
PID_RELATED_SAMPLE = 0x0083
"""Of RTPS 2.5 and DDS-RPC: GUID and number of the sample that a sample answers."""
PID_RELATED_SAMPLE_FASTDDS = 0x800F
"""The same where Fast DDS had it before, and still reads it."""
