"""Collector: the thread that takes arrivals from the network's queue, counts what was lost, and fills the cache.

It is woken by the first arrival and then waits for a moment, so that it takes many in one go: a wake-up for each of
6,000 messages a second would cost more than the messages.
"""

from __future__ import annotations

import queue
import struct
import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

from robolink.bag.recording.cache import Cache
from robolink.bag.recording.topics import Arrived, RecordedTopic, make_arrived
from robolink.exceptions import OverwrittenError, RobolinkError, WireError
from robolink.system import waits
from robolink.transport.base import Sample
from robolink.wire import Attachment, unpack_attachment

MOMENT = 0.02
"""Time in seconds that arrivals are gathered."""

_STAMP = {1: struct.Struct("<4xiI"), 0: struct.Struct(">4xiI")}
"""Layouts of a rosgraph_msgs/msg/Clock, by its byte for the byte order."""


class SimClock:
    """Target of the arrivals of /clock."""


class Switch(NamedTuple):
    """Target of an arrival that begins or ends a pause: what has come before it is not concerned."""

    paused: bool
    done: Callable[[], object]
    """Called on the collector's thread when it holds."""


class Collector:
    """Takes arrivals until it is closed.

    Args:
        read: `Transport.read`, which copies a message out of the network's memory.
        cache: Cache that gets the messages.
        on_clock: Called with the first message of /clock, before what comes behind it is taken; None where messages
            have the time of their arrival.
    """

    def __init__(
        self, read: Callable[[Any], Sample], cache: Cache, on_clock: Callable[[], object] | None = None
    ) -> None:
        self.queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        """Queue of arrivals; `put` is what the network calls."""
        self.paused = False
        """True while messages are let pass; the last ones of latched topics are kept."""
        self.malformed = 0
        """Number of messages without ROS 2's attachment."""
        self._read, self._cache, self._on_clock = read, cache, on_clock
        self._sim_time: int | None = None
        self._thread = threading.Thread(target=self._run, name="robolink bag collector", daemon=True)

    @property
    def sim_time(self) -> int | None:
        """Newest time of /clock, in ns; None before the first, and where nobody asks for it."""
        return self._sim_time

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def close(self) -> None:
        """Take what has arrived so far, and end the thread."""
        self.queue.put(None)
        waits.join(self._thread)

    def _run(self) -> None:
        get = self.queue.get_nowait
        while True:
            batch = [self.queue.get()]
            if batch[0] is not None:
                time.sleep(MOMENT)
            for _ in range(self.queue.qsize()):
                batch.append(get())
            ends = None in batch
            self._take([each for each in batch if each is not None] if ends else batch)
            if ends:
                return

    def _take(self, batch: list[Any]) -> None:
        read, taken, has_clock = self._read, list[Arrived](), self._on_clock is not None
        for arrival in batch:
            topic = arrival.target
            if type(topic) is not RecordedTopic:
                taken = self._obey(topic, arrival.content, taken)
                continue
            try:
                data, attachment = read(arrival.content)
                sender = unpack_attachment(attachment)
            except RobolinkError as error:
                self._refuse(topic, error)
                continue
            sequence, published, gid = sender
            last = topic.last
            if last.get(gid) == sequence - 1:  # the usual case of `before`, without the call
                last[gid] = sequence
            elif self._is_copy(topic, sender):
                continue
            at = self._sim_time if has_clock else arrival.at
            if at is not None:
                sent = published if published > 0 else 0  # of a wrong clock: no MCAP has times before 1970
                taken.append(make_arrived((topic, at, sent, sequence, data)))
                if topic.kept is not None:
                    topic.kept.append(taken[-1])
        self._pass_on(taken)

    def _pass_on(self, taken: list[Arrived]) -> None:
        if taken and not self.paused:
            self._cache.put(taken)

    def _obey(self, target: Any, content: Any, taken: list[Arrived]) -> list[Arrived]:
        """Set the time, or begin or end a pause; return the messages that are still to be passed on."""
        if isinstance(target, SimClock):
            self._set_time(content)
            return taken
        self._pass_on(taken)
        self.paused = target.paused
        target.done()
        return []

    def _is_copy(self, topic: RecordedTopic, sender: Attachment) -> bool:
        """Count what is missing before a message; return whether it has come before, by another subscription."""
        last = topic.gaps.last.get(sender.gid)
        missing = topic.gaps.before(sender)
        topic.lost += missing
        return topic.comes_twice and missing == 0 and last is not None and sender.sequence <= last

    def _refuse(self, topic: RecordedTopic, error: RobolinkError) -> None:
        if isinstance(error, OverwrittenError) and error.attachment:
            topic.lost += 1
            try:
                topic.lost += topic.gaps.before(unpack_attachment(error.attachment))
            except WireError:
                self.malformed += 1
        else:
            self.malformed += 1

    def _set_time(self, content: Any) -> None:
        try:
            data = self._read(content).payload
            seconds, nanoseconds = _STAMP[data[1] & 1].unpack_from(data)
        except (RobolinkError, struct.error, IndexError):
            self.malformed += 1
            return
        is_first, self._sim_time = self._sim_time is None, max(0, seconds * 10**9 + nanoseconds)
        if is_first and self._on_clock is not None:
            self._on_clock()
