"""Message cache between the thread that takes messages from the network and the one that writes them.

It is bounded in bytes and in time. What does not fit is dropped, and counted by its topic: the newest, since the oldest
are just being written; of a snapshot the oldest, which are not counted, as nobody wants them any more.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Sequence
from operator import itemgetter

from robolink.bag.recording.topics import Arrived

OVERHEAD = 200
"""Memory that a message takes beside its bytes, about."""


class Cache:
    """Queue of messages.

    Args:
        size: Limit in bytes, 0 for none.
        duration: Limit of the time from the first to the last message, in ns; 0 for none.
        is_ring: True to drop the oldest messages when it is full: for snapshots.
    """

    def __init__(self, size: int, duration: int = 0, *, is_ring: bool = False) -> None:
        self._size, self._duration, self._is_ring = size, duration, is_ring
        self._waiting: deque[Arrived] = deque()
        self._held = 0
        self._changed = threading.Condition()
        self._woken = False

    @property
    def held(self) -> int:
        """Bytes of what waits, and of what was taken and is not released yet."""
        return self._held

    def put(self, messages: list[Arrived]) -> None:
        """Add messages, as far as there is room."""
        size = size_of(messages)
        with self._changed:
            if self._is_ring or (not self._duration and not (self._size and self._held + size > self._size)):
                self._held += size
                self._waiting += messages
            else:
                self._put_each(messages)
            if self._is_ring:
                self._forget()
            else:
                self._changed.notify()

    def _put_each(self, messages: list[Arrived]) -> None:
        for each in messages:
            if self._has_room(each):
                self._held += len(each.data) + OVERHEAD
                self._waiting.append(each)
            else:
                each.topic.dropped += 1

    def take(self, timeout: float) -> list[Arrived]:
        """Wait until something is there, `wake` was called or the timeout, in seconds, has passed; return all of it."""
        with self._changed:
            if not (self._waiting and not self._is_ring) and not self._woken:
                self._changed.wait(timeout)
            self._woken = False
            return [] if self._is_ring else self._all()

    def take_ring(self) -> list[Arrived]:
        """Return all that a snapshot has."""
        with self._changed:
            return self._all()

    def release(self, size: int) -> None:
        """Make room again for messages that were taken: so many bytes, with their overhead."""
        with self._changed:
            self._held -= size

    def wake(self) -> None:
        """Wake whoever is in `take`."""
        with self._changed:
            self._woken = True
            self._changed.notify()

    def _all(self) -> list[Arrived]:
        taken = list(self._waiting)
        self._waiting.clear()
        return taken

    def _has_room(self, message: Arrived) -> bool:
        if self._size and self._held and self._held + len(message.data) + OVERHEAD > self._size:
            return False
        first = self._waiting[0] if self._duration and self._waiting else None
        return first is None or message.log_time - first.log_time <= self._duration

    def _forget(self) -> None:
        waiting, last = self._waiting, self._waiting[-1].log_time if self._waiting else 0
        while len(waiting) > 1 and (
            (self._size and self._held > self._size) or (self._duration and last - waiting[0].log_time > self._duration)
        ):
            self._held -= len(waiting.popleft().data) + OVERHEAD


def size_of(messages: Sequence[Arrived]) -> int:
    """Return the bytes that messages take in a cache."""
    return sum(map(len, map(_DATA, messages))) + OVERHEAD * len(messages)


_DATA = itemgetter(4)
