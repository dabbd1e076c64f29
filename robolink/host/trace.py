"""Trace of all that a system publishes: counts by topic, and one hash of it all, in its order."""

from __future__ import annotations

import struct
from collections import Counter
from collections.abc import Callable
from hashlib import sha256

from robolink.transport.base import NumberingOutlet
from robolink.wire import parse_key

ROSOUT = "/rosout"
COMPRESSED = "sensor_msgs/msg/CompressedImage"
MANY = 768
"""Number of parts that are hashed in one go: Python's overhead of a call of sha256 is that of a kilobyte."""

LARGE = 2**16
"""Size in bytes from which a message is hashed at once, so that no camera's pictures are kept."""

_HEAD = struct.Struct("<III")
TRACEBACK = "Traceback (most recent call last)"
"""First words of a traceback, which differs between Pythons."""


class Trace:
    """Hash of all that has been published, and the number of messages and bytes on each topic.

    The hash is over topic names, types, payloads and attachments (who sent it, as which of its own, and when by its
    own clock), in the order in which they were published. What depends on where and on which Python something runs is
    left out: a line of the log counts by its time, level, name and words, not by its file and line nor its traceback;
    of a compressed image only that it was published.
    """

    def __init__(self) -> None:
        self._digest = sha256()
        self._parts: list[bytes] = []
        """Three for each message that is not hashed yet: its head, its payload, its attachment."""
        self._topics: dict[str, _Topic] = {}

    def tapped(self, key: str, outlet: NumberingOutlet) -> NumberingOutlet:
        """Return the outlet of a publisher of this key: it notes what is sent, and sends it by `outlet`."""
        parsed = parse_key(key)
        topic = self._topics.get(parsed.name)
        if topic is None:
            topic = self._topics[parsed.name] = _Topic(len(self._topics))
            named = f"{parsed.name} {parsed.type_name}".encode()
            self._flush()
            self._digest.update(_HEAD.pack(topic.number, len(named), 0) + named)
        return _TappedOutlet(outlet, self._noting(topic, outlet.put_numbered, _steadied(parsed.name, parsed.type_name)))

    def _noting(self, topic: _Topic, send: _PutNumbered, steadied: Callable[[bytes], bytes] | None) -> _PutNumbered:
        """Return the function that is called for each message, hence a closure: all that it needs is at hand."""
        note, pack, parts, flush, number = self._parts.extend, _HEAD.pack, self._parts, self._flush, topic.number
        last = (-1, -1, b"")  # most topics have messages of one size, and so one head

        def put_numbered(payload: bytes, attachment: Callable[[], bytes]) -> bytes:
            nonlocal last
            sent = send(payload, attachment)
            if steadied is not None:
                payload = steadied(payload)
            size, of_all, head = last
            if len(payload) != size or len(sent) != of_all:
                size, of_all = len(payload), len(sent)
                head = pack(number, size, of_all)
                last = (size, of_all, head)
            note((head, payload, sent))
            if size > LARGE or len(parts) > MANY:
                flush()
            return sent

        return put_numbered

    def _flush(self) -> None:
        """Hash what was noted, and count it by the heads: of each topic all messages of one size at once."""
        self._digest.update(b"".join(self._parts))
        topics = list(self._topics.values())
        for head, count in Counter(self._parts[::3]).items():
            number, size, _ = _HEAD.unpack(head)
            topics[number].messages += count
            topics[number].bytes += count * size
        self._parts.clear()

    @property
    def messages(self) -> dict[str, int]:
        """Number of messages by topic; topics with a publisher and no message, too."""
        self._flush()
        return {name: topic.messages for name, topic in sorted(self._topics.items())}

    @property
    def bytes(self) -> dict[str, int]:
        """Number of bytes of payload by topic."""
        self._flush()
        return {name: topic.bytes for name, topic in sorted(self._topics.items())}

    def hexdigest(self) -> str:
        """Return the hash of all so far, SHA-256 in hex."""
        self._flush()
        return self._digest.hexdigest()


_PutNumbered = Callable[[bytes, Callable[[], bytes]], bytes]


class _Topic:
    __slots__ = ("bytes", "messages", "number")

    def __init__(self, number: int) -> None:
        self.number, self.messages, self.bytes = number, 0, 0


class _TappedOutlet:
    """Outlet of a publisher that notes what it sends."""

    def __init__(self, outlet: NumberingOutlet, put_numbered: _PutNumbered) -> None:
        self._outlet = outlet
        self.put_numbered, self.close = put_numbered, outlet.close

    def put(self, payload: bytes, attachment: bytes) -> None:
        """Send, and note it."""
        self.put_numbered(payload, lambda: attachment)

    @property
    def matched(self) -> bool:
        """True if anybody subscribes."""
        return self._outlet.matched


def _steadied(topic: str, type_name: str) -> Callable[[bytes], bytes] | None:
    """Return a function that strips from payloads what differs between machines; None if nothing does."""
    if type_name == COMPRESSED:
        return lambda payload: b""  # by OpenCV, whose versions differ
    if topic != ROSOUT:
        return None
    from robolink.interfaces.rcl_interfaces.msg import Log
    from robolink.message import decoder

    decode = decoder(Log)

    def words(payload: bytes) -> bytes:
        line = decode(payload)
        text = line.msg.partition(TRACEBACK)[0]
        return f"{line.stamp.sec}.{line.stamp.nanosec:09} {line.level} {line.name}\0{text}".encode(errors="replace")

    return words
