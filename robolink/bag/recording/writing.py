"""The cache of messages that wait, and the thread that writes them into the bag.

The cache is bounded in bytes and in time. What does not fit is dropped, and counted by its topic: the newest, since the
oldest are just being written; of a snapshot the oldest, which are not counted, as nobody needs them any more.

Only the thread touches the bag. When the disk is full, or another error of the file comes up, it closes the bag with
what is good and ends.
"""

from __future__ import annotations

import queue
import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Future
from operator import itemgetter
from pathlib import Path
from typing import Any, Protocol

from robolink.bag.recording.topics import Arrived, RecordedTopic
from robolink.bag.topic import BagTopic
from robolink.exceptions import RobolinkError
from robolink.system import clocks, waits
from robolink.wire import NO_HASH

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


TICK = 0.05
"""Time in seconds between two looks of the bag at what is due."""

PERIOD = 1.0
"""Time in seconds between two looks at what is to be told."""


class WritableBag(Protocol):
    """Bag that is being written: a `BagWriter`."""

    on_split: Callable[[Path, Path], object]

    def add_topic(self, topic: BagTopic) -> int:
        """Add a topic; return its number."""

    def write(self, topic: int, log_time: int, publish_time: int, sequence: int, data: bytes | memoryview) -> None:
        """Write a message."""

    def tick(self) -> None:
        """Show what is due."""

    def split(self) -> None:
        """Close the file and begin the next one."""

    def close(self) -> Any:
        """Close it, and return its metadata."""


class Writing:
    """Thread that writes a bag.

    Args:
        bag: Bag, open.
        cache: Cache of the messages.
        now: Function that returns the time for messages that are repeated, in ns.
        on_split: Called with the paths of the file that was closed and of the next one.
        on_error: Called once when the bag can no longer be written, with the reason in one line.
        every_second: Called about once a second.
    """

    def __init__(
        self,
        bag: WritableBag,
        cache: Cache,
        now: Callable[[], int],
        on_split: Callable[[Path, Path], object],
        on_error: Callable[[str], object],
        every_second: Callable[[], object],
    ) -> None:
        self.topics: list[RecordedTopic] = []
        """Topics of the bag, in their order."""
        self.messages = self.bytes = 0
        """Number of messages in the bag, and their bytes."""
        self.metadata: Any = None
        """Result of the bag's `close`."""
        self._bag, self._cache, self._now = bag, cache, now
        self._on_split, self._on_error, self._every_second = on_split, on_error, every_second
        self._commands: queue.SimpleQueue[tuple[Callable[[], object], Future[Any]]] = queue.SimpleQueue()
        self._has_split = self._closes = self._failed = False
        self._second = clocks.monotonic()
        self._thread = threading.Thread(target=self._run, name="robolink bag writer", daemon=True)
        bag.on_split = self._note_split

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def do(self, command: Callable[[], object]) -> Future[Any]:
        """Call `command()` on the thread, between two messages; the future has its result."""
        future: Future[Any] = Future()
        self._commands.put((command, future))
        self._cache.wake()
        return future

    def close(self) -> None:
        """Write the messages of the cache, close the bag and end the thread."""
        self._closes = True
        self._cache.wake()
        waits.join(self._thread)

    # On the thread

    def add_topic(self, topic: RecordedTopic, text: str) -> None:
        """Add a topic whose type is known now, and write what has waited for that."""
        type_hash = "" if topic.token.type_hash == NO_HASH else topic.token.type_hash
        described = BagTopic(topic.name, topic.type_name, "cdr", type_hash, topic.profiles, text)
        topic.number = self._bag.add_topic(described)
        self.topics.append(topic)
        waiting, topic.pending = topic.pending, []
        self._write(waiting)

    def write_again(self, messages: Iterable[Arrived], now: int) -> None:
        """Write messages that are kept of latched topics, at the time `now`."""
        for each in messages:
            if each.topic.number >= 0:
                self._bag.write(each.topic.number, now, each.publish_time, each.sequence, each.data)
                self._count(each)

    def write_snapshot(self, messages: list[Arrived]) -> None:
        """Write the messages of a snapshot, into a file of its own."""
        if self.messages:
            self._bag.split()
        if messages:
            self._repeat(messages[0].log_time, {id(each) for each in messages})
        self._write(messages)

    def split(self) -> None:
        """Close the file and begin the next one."""
        self._bag.split()
        self._repeat_if_split(self._now())

    def _run(self) -> None:
        try:
            while not self._closes:
                self._step()
            while self._step():
                pass
        except Exception as error:  # noqa: BLE001 - whatever it is, it is told, and what is recorded is closed
            self._fail(error)
        try:
            self.metadata = self._bag.close()
        except Exception as error:  # noqa: BLE001
            self._fail(error)

    def _step(self) -> bool:
        """Write the messages that wait, and do what was requested; return whether there was anything."""
        batch = self._cache.take(0.0 if self._closes else TICK)
        self._write(batch)
        commanded = self._obey()
        self._bag.tick()
        if clocks.monotonic() - self._second >= PERIOD:
            self._second = clocks.monotonic()
            self._every_second()
        return bool(batch) or commanded

    def _write(self, messages: list[Arrived]) -> None:
        write, tick = self._bag.write, self._bag.tick
        count = size = pending = 0
        for each in messages:
            topic, log_time, publish_time, sequence, data = each
            if topic.number < 0:
                topic.pending.append(each)
                pending += len(data) + OVERHEAD
                continue
            write(topic.number, log_time, publish_time, sequence & 0xFFFFFFFF, data)
            count += 1
            size += len(data)
            if self._has_split:
                self._repeat_if_split(log_time)
            if not count & 63:
                tick()
        if messages:
            self.messages += count
            self.bytes += size
            self._cache.release(size_of(messages) - pending)

    def _count(self, message: Arrived) -> None:
        self.messages += 1
        self.bytes += len(message.data)

    def _repeat_if_split(self, now: int) -> None:
        if self._has_split:
            self._has_split = False
            self._repeat(now, set())

    def _repeat(self, now: int, but: set[int]) -> None:
        """Begin a file with the last messages of the topics that are repeated."""
        for topic in self.topics:
            self.write_again([each for each in list(topic.retained or ()) if id(each) not in but], now)

    def _obey(self) -> bool:
        did = False
        while not self._commands.empty():
            command, future = self._commands.get()
            did = True
            try:
                future.set_result(command())
            except Exception as error:
                future.set_exception(error)
                raise
        return did

    def _fail(self, error: Exception) -> None:
        if not self._failed:
            self._failed = True
            self._on_error(reason_of(error))
        while not self._commands.empty():
            self._commands.get()[1].set_exception(error)

    def _note_split(self, closed: Path, opened: Path) -> None:
        self._has_split = True
        self._on_split(closed, opened)


def reason_of(error: Exception) -> str:
    """Return why a bag cannot be written, in one line."""
    if isinstance(error, OSError) and error.strerror:
        place = f"{error.filename}: " if error.filename else ""
        return f"{place}{error.strerror}"
    return str(error) if isinstance(error, RobolinkError) else f"{type(error).__name__}: {error}"
