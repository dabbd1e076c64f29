"""Limits of the requests that any stranger may send to every node: what is beyond them is refused undecoded."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

MOST_NAMES = 10_000
"""Most names, parameters or loggers of one request. Each costs time and memory, and a parameter that is set may be new,
which costs as much as all those before it."""

LARGEST = 3 * 2**20
"""Largest request in bytes: 10,000 names of 300 letters. Once decoded and set, empty texts take fifty times as much."""

_HEADER = 4
"""Size in bytes of the CDR header before the first field; its second byte is the byte order."""

Refusal = Callable[[str], dict[str, Any]]
"""Function from the reason to the fields of the response that refuses a request."""


def no_room(reason: str) -> dict[str, Any]:
    """Refuse with an empty response, which has no field for a reason."""
    return {}


def look_at(srv_type: type[Any], refusal: Refusal, payload: bytes) -> tuple[Any, str]:
    """Return a service's response that refuses a request, and the reason; (None, '') for what is within the limits."""
    reason = why_refused(payload)
    return (srv_type.Response(**refusal(reason)), reason) if reason else (None, "")


def why_refused(payload: bytes) -> str:
    """Return why a request is refused whose first field is a sequence, or nothing. It is looked at, not decoded.

    >>> why_refused(b"\\0\\1\\0\\0" + (10_001).to_bytes(4, "little"))
    'one request may name 10,000, this one names 10,001'
    """
    if len(payload) > LARGEST:
        return f"one request may have {LARGEST:,} bytes, this one has {len(payload):,}"
    order: Literal["little", "big"] = "little" if payload[1:2] == b"\1" else "big"
    count = int.from_bytes(payload[_HEADER : _HEADER + 4], order)
    if count > MOST_NAMES:
        return f"one request may name {MOST_NAMES:,}, this one names {count:,}"
    return ""
