"""Cache of a publisher's last messages, for those who ask for what a lost link has cost them."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import msgspec

from robolink.system import clocks
from robolink.wire import fields_of

MOST_RETAINED = 4096
"""Most messages that a publisher retains: with KEEP_ALL, 40 s of 100 Hz."""

MOST_BYTES = 1 << 24
"""Most bytes that a publisher retains; of larger messages there are fewer."""

PART = 1 << 16
"""Size in bytes from which an answer is sent in several parts."""


class Asked(NamedTuple):
    """State of one subscription, for the publishers of its topic."""

    key: str
    age: int
    """Nanoseconds since it was made: messages of unknown publishers that are older are none of its own."""
    last: dict[bytes, int]
    """Number of the last message of each publisher, by its gid."""


class Answer(NamedTuple):
    """Messages of one topic, in their order: payloads and attachments."""

    key: str
    messages: list[tuple[bytes, bytes]]


def newer(retained: Iterable[tuple[bytes, bytes]], asked: Asked) -> list[tuple[bytes, bytes]]:
    """Return what is newer than what a subscription has, in the order of its numbers."""
    since = clocks.now() - asked.age
    found = [(number, each) for each in retained if (number := _newer(each[1], asked, since)) is not None]
    return [each for _, each in sorted(found, key=_number)]  # threads that publish may overtake each other


def _newer(attachment: bytes, asked: Asked, since: int) -> int | None:
    """Return the number of a message; None if it is not newer than what has come."""
    try:
        number, at, _, gid = fields_of(attachment)
    except struct.error:  # not ROS 2's: without a number nothing can be asked for
        return None
    last = asked.last.get(gid)
    is_newer = at >= since if last is None else number > last
    return number if is_newer else None


def _number(found: tuple[int, tuple[bytes, bytes]]) -> int:
    return found[0]


def together(asked: Iterable[Asked]) -> list[Asked]:
    """Return one question for each topic: for what any of its subscriptions lacks."""
    found = dict[str, Asked]()
    for each in asked:
        other = found.get(each.key, each)
        last = other.last | {gid: min(number, other.last.get(gid, number)) for gid, number in each.last.items()}
        found[each.key] = Asked(each.key, max(each.age, other.age), last)
    return list(found.values())


def parts(key: str, messages: Iterable[tuple[bytes, bytes]]) -> Iterator[bytes]:
    """Yield answers with these messages, each of PART bytes or one message more."""
    part, size = list[tuple[bytes, bytes]](), 0
    for each in messages:
        part.append(each)
        size += len(each[0])
        if size >= PART:
            yield msgspec.msgpack.encode(Answer(key, part))
            part, size = [], 0
    if part:
        yield msgspec.msgpack.encode(Answer(key, part))
