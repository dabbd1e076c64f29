"""Records in which users of the room see endpoints, samples and other participants."""

from __future__ import annotations

from typing import NamedTuple


class Qos(NamedTuple):
    """Profile that an endpoint offers or requests. Times are in seconds, None is infinite."""

    reliable: bool = True
    transient_local: bool = False
    depth: int = 10
    """Samples kept; 0: all; -1, of another participant's endpoint only: it does not say. (Fast DDS never says.)"""
    deadline: float | None = None
    lifespan: float | None = None
    """Of writers; readers have none."""
    liveliness: int = 0
    """0 automatic, 1 manual by participant, 2 manual by topic."""
    lease: float | None = None
    """Of liveliness."""


class Info(NamedTuple):
    """Facts of a sample beside its payload."""

    writer: bytes
    """GUID."""
    number: int
    timestamp: int
    """Nanoseconds since 1970; 0: unknown."""
    related: tuple[bytes, int] | None = None
    """GUID and number of the sample that this one answers, as services have it; number 0: none is named."""


class Endpoint(NamedTuple):
    """Endpoint of another participant."""

    guid: bytes
    is_writer: bool
    topic: str
    type_name: str
    qos: Qos
    user_data: bytes
    vendor: bytes


class Peer(NamedTuple):
    """Another participant."""

    prefix: bytes
    vendor: bytes
    name: str
    user_data: bytes
    lease: float
    """Seconds after which it is gone if nothing comes from it; infinity: never."""
    address: tuple[str, int]
    """Where it is met."""
