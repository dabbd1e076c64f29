"""Tokens of bridges: by them two bridges between the same networks find each other, and tools what came through one."""

from __future__ import annotations

from typing import NamedTuple

from robolink.exceptions import WireError
from robolink.system.patterns import late
from robolink.wire.keys import format_number, matched, not_too_long, parse_number, quoted

# Not with an @, which ** does not match: sessions that are confined to loopback let through what ** matches.
_BRIDGE = "robolink_bridge"
_FIELDS = 7
_SESSION = late(r"[0-9a-f]{1,32}")
_WORD = late(r"[A-Za-z0-9_.-]{1,253}")
_OTHER = late(r"[^A-Za-z0-9_.-]+")

STARTING, RUNNING = "starting", "running"
"""States of a bridge: whether it still looks for another one, or mirrors."""


class BridgeToken(NamedTuple):
    """Announcement of a bridge on one of its networks, beside the tokens of what it mirrors there."""

    domain: int
    session: str
    """Session on this network: the tokens of what comes through the bridge have it, too."""
    network: str
    """Network on the other side, such as `dds`."""
    host: str
    """Name of the machine that it runs on."""
    state: str = RUNNING
    mark: str = ""
    """Id of the bridge, the same on all its networks; "" is the session."""


def bridge_pattern(domain: int) -> str:
    """Return the key expression that the tokens of all bridges of a domain match."""
    return f"{_BRIDGE}/{format_number(domain)}/**"


def format_bridge(token: BridgeToken) -> str:
    """Return the text of a bridge's token; what a host's name may not have in a key becomes a dash."""
    fields = [token.session, token.mark or token.session, token.network, token.state, _key_name(token.host)]
    matched(_SESSION, token.session, "a session id")
    for each in fields[1:]:
        matched(_WORD, each, "a word")
    return "/".join([_BRIDGE, format_number(token.domain), *fields])


def parse_bridge(text: str) -> BridgeToken:
    """Parse the text of `format_bridge`; raises WireError for any other."""
    fields = not_too_long(text, "a token").split("/")
    if len(fields) != _FIELDS or not text.startswith(f"{_BRIDGE}/"):
        raise WireError(f"expected a bridge's token, got {quoted(text)}")
    domain, session, *words = fields[1:]
    mark, network, state, host = (matched(_WORD, each, "a word") for each in words)
    return BridgeToken(parse_number(domain), matched(_SESSION, session, "a session id"), network, host, state, mark)


_MARK = late(rb"robolink_bridge=([0-9a-f]{1,32}),([A-Za-z0-9_.-]{1,253});")


class Mark(NamedTuple):
    """Mark of a bridge in its participant's user data on DDS, where there are no tokens."""

    mark: str
    """Id of the bridge: its session on the other network."""
    host: str
    """Name of the machine that it runs on."""


def mark_data(mark: Mark) -> bytes:
    """Return the mark as user data."""
    return f"robolink_bridge={mark.mark},{_key_name(mark.host)};".encode()


def mark_in(user_data: bytes) -> Mark | None:
    """Return the mark in a participant's user data; None if it is not that of a bridge."""
    match = _MARK.search(user_data)
    return Mark(match[1].decode(), match[2].decode()) if match else None


def _key_name(host: str) -> str:
    """Return the name of a host as keys have it: what they may not have becomes a dash."""
    return _OTHER.sub("-", host)[:253] or "-"
