"""Notes all that a system publishes: how much on each topic, and one hash of it all, in its order."""

from __future__ import annotations

import struct
from collections.abc import Callable
from hashlib import sha256

from robolink.transport.base import Outlet
from robolink.wire import parse_key

ROSOUT = "/rosout"
MANY = 768
"""Parts that are hashed in one go: Python's price for a call of sha256 is that of a kilobyte."""

LARGE = 2**16
"""Bytes of a message that is hashed at once, so that none of a camera's pictures are kept."""

_HEAD = struct.Struct("<III")
_TRACEBACK = "Traceback (most recent call last)"


class Trace:
    """All that has been published: its hash, and how many messages and bytes there were on each topic.

    The hash is over topic names, types, payloads and attachments (who sent it, as which of its own, and when by its
    own clock), in the order in which they were published. What depends on where and on which Python something runs is
    left out: a line of the log counts by its time, level, name and words, not by its file and line nor its traceback.
    """

    def __init__(self) -> None:
        self._digest = sha256()
        self._parts: list[bytes] = []
        self._topics: dict[str, _Topic] = {}

    def tapped(self, key: str, outlet: Outlet) -> Outlet:
        """Give the way out for a publisher of this key: it notes what is sent, and sends it by `outlet`."""
        parsed = parse_key(key)
        topic = self._topics.get(parsed.name)
        if topic is None:
            topic = self._topics[parsed.name] = _Topic(len(self._topics))
            named = f"{parsed.name} {parsed.type_name}".encode()
            self._parts += [_HEAD.pack(topic.number, len(named), 0), named]
        return _TappedOutlet(outlet, self._noting(topic, outlet.put, _steadied(parsed.name)))

    def _noting(self, topic: _Topic, send: _Put, steadied: Callable[[bytes], bytes] | None) -> _Put:
        """Give what is called for each message, hence a closure: all that it needs is at hand."""
        note, pack, parts, flush, number = self._parts.extend, _HEAD.pack, self._parts, self._flush, topic.number

        def put(payload: bytes, attachment: bytes) -> None:
            send(payload, attachment)
            noted = payload if steadied is None else steadied(payload)
            size = len(noted)
            note((pack(number, size, len(attachment)), noted, attachment))
            topic.messages += 1
            topic.bytes += size
            if len(parts) > MANY or size > LARGE:
                flush()

        return put

    def _flush(self) -> None:
        self._digest.update(b"".join(self._parts))
        self._parts.clear()

    @property
    def messages(self) -> dict[str, int]:
        """How many messages each topic has had, by name; those of which there was a publisher and no message too."""
        return {name: topic.messages for name, topic in sorted(self._topics.items())}

    @property
    def bytes(self) -> dict[str, int]:
        """How many bytes of payload each topic has had, by name."""
        return {name: topic.bytes for name, topic in sorted(self._topics.items())}

    def hexdigest(self) -> str:
        """Give the hash of all so far, SHA-256 in hex."""
        self._flush()
        return self._digest.hexdigest()


_Put = Callable[[bytes, bytes], None]


class _Topic:
    __slots__ = ("bytes", "messages", "number")

    def __init__(self, number: int) -> None:
        self.number, self.messages, self.bytes = number, 0, 0


class _TappedOutlet:
    """A publisher's way out on which somebody listens."""

    def __init__(self, outlet: Outlet, put: _Put) -> None:
        self._outlet = outlet
        self.put, self.close = put, outlet.close

    @property
    def matched(self) -> bool:
        """Whether anybody subscribes."""
        return self._outlet.matched


def _steadied(topic: str) -> Callable[[bytes], bytes] | None:
    """Give what leaves out of a topic's payloads all that is not the same everywhere; None if nothing is to be."""
    if topic != ROSOUT:
        return None
    from robolink.interfaces.rcl_interfaces.msg import Log
    from robolink.message import decoder

    decode = decoder(Log)

    def words(payload: bytes) -> bytes:
        line = decode(payload)
        text = line.msg.partition(_TRACEBACK)[0]
        return f"{line.stamp.sec}.{line.stamp.nanosec:09} {line.level} {line.name}\0{text}".encode(errors="replace")

    return words
