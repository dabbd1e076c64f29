"""Streams: what the key of a topic or service stands for on DDS."""

from __future__ import annotations

import functools
from typing import NamedTuple

from robolink.dds.names import Role, dds_topic, dds_type, user_data_of
from robolink.exceptions import TransportError, WireError
from robolink.wire import buffer_key, format_key, parse_key

Place = tuple[str, str]
"""DDS topic and DDS type: what readers and writers have in common that match."""


class Stream(NamedTuple):
    """A topic or service with its type, and its names on DDS."""

    key: str
    name: str
    type_name: str
    type_hash: str
    is_buffers: bool
    """True for the key on which only Lyrical sends over Zenoh: DDS has nothing of it."""

    @property
    def topic(self) -> str:
        """DDS topic of a topic."""
        return dds_topic(Role.TOPIC, self.name)

    @property
    def dds_type(self) -> str:
        """DDS type of a topic."""
        return dds_type(Role.TOPIC, self.type_name)

    @property
    def place(self) -> Place:
        """DDS topic and type of a topic."""
        return self.topic, self.dds_type

    def place_of(self, role: Role) -> Place:
        """Return the DDS topic and type of a service's requests or replies."""
        return dds_topic(role, self.name), dds_type(role, self.type_name)

    @property
    def user_data(self) -> bytes:
        """User data of an endpoint of a topic."""
        return user_data_of(self.type_hash)


@functools.lru_cache(maxsize=1024)
def stream_of(key: str) -> Stream:
    """Return the stream of a key; raises TransportError if it is not one."""
    try:
        parsed = parse_key(key)
    except WireError as error:
        raise TransportError(f"{key[:200]}: {error}") from None
    plain = format_key(parsed)
    return Stream(key, parsed.name, parsed.type_name, parsed.type_hash, key == buffer_key(plain))
