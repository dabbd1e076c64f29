"""Tokens by which a publisher asserts its liveliness without a message: each is announced and withdrawn at once.

rmw_zenoh has nothing for it: an assertion of one of its publishers does not leave its process.
"""

from __future__ import annotations

from robolink.exceptions import WireError
from robolink.system.patterns import late
from robolink.wire.keys import checked_topic, format_number, matched, not_too_long, quoted

# Not with an @, which ** does not match: sessions that are confined to loopback let through what ** matches.
_ALIVE = "robolink_alive"
_FIELDS = 5
_GID = late(r"[0-9a-f]{32}")


def format_assertion(domain: int, topic: str, gid: bytes, number: int) -> str:
    """Return the token of a publisher's assertion; `number` makes each of them another one."""
    return f"{_of_topic(domain, topic)}/{gid.hex()}/{format_number(number)}"


def assertion_pattern(domain: int, topic: str) -> str:
    """Return the key expression that the assertions of all publishers of a topic match."""
    return f"{_of_topic(domain, topic)}/*/*"


def parse_assertion(text: str) -> bytes:
    """Return the gid of the publisher that asserts its liveliness; raises WireError for any other token."""
    fields = not_too_long(text, "a token").split("/")
    if len(fields) != _FIELDS or fields[0] != _ALIVE:
        raise WireError(f"expected an assertion of liveliness, got {quoted(text)}")
    return bytes.fromhex(matched(_GID, fields[3], "a gid"))


def _of_topic(domain: int, topic: str) -> str:
    return f"{_ALIVE}/{format_number(domain)}/{checked_topic(topic)[1:].replace('/', '%')}"
