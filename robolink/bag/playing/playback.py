"""The messages of a playback in their order, and the loop that plays, pauses and seeks.

A playback knows neither nodes nor threads: somebody calls `advance`, and again when the time has come that it returned,
or when `on_change` was called. So it plays in real and in virtual time, and to publishers as well as to a page.
"""

from __future__ import annotations

import heapq
import itertools
import threading
from collections.abc import Callable, Container, Iterator, Sequence
from typing import Protocol

from robolink.bag.playing.pacing import Playhead
from robolink.bag.playing.publishers import is_latched, retained_of
from robolink.bag.playing.settings import RECEIVED, PlayError, PlaySettings, check_rate
from robolink.bag.reader import Bag, merged_messages, merged_topics
from robolink.bag.selection import Selection
from robolink.bag.topic import BagMessage


class Playlist:
    """Messages of bags, merged by their times, of the topics of a selection.

    Args:
        bags: Bags, which stay the caller's.
        selection: Topics to play.
        order: `received` or `sent`: the time that counts.
        window: Messages among which those are sorted that were sent in another order than received.

    Raises:
        BagError: (a ValueError) if the bags have two types for one topic.
    """

    def __init__(self, bags: Sequence[Bag], selection: Selection, order: str = RECEIVED, window: int = 1000) -> None:
        self._bags = [each for each in bags if each.metadata.message_count]
        self.topics = merged_topics(bags, selection.takes, "play the bags one by one, or exclude it")
        """Topics by name, with the profiles of all bags."""
        self.start_time = min((each.start_time for each in self._bags), default=0)
        self.end_time = max((each.end_time for each in self._bags), default=0)
        self._names = ", ".join(str(each.path) for each in bags)
        self._by_sent, self._window = order != RECEIVED, max(1, window)

    def checked(self) -> Playlist:
        """Return it. Raises PlayError if there is nothing to play."""
        if not self._bags:
            raise PlayError(f"{self._names}: there is no message to play")
        if not self.topics:
            raise PlayError(f"{self._names}: no topic is selected; 'robolink bag info' lists those that there are")
        return self

    def time_of(self, message: BagMessage) -> int:
        """Return the time that a message is played at, in nanoseconds since 1970."""
        return message.publish_time if self._by_sent else message.log_time

    def messages(self, start: int, end: int | None) -> Iterator[BagMessage]:
        """Yield the messages from `start` to before `end`."""
        merged = merged_messages(self._bags, self.topics.keys(), start, end)
        return self._sorted(merged) if self._by_sent else merged

    def latched(self, before: int, names: Container[str] | None = None) -> list[BagMessage]:
        """Return the messages that latched topics would have retained for a late subscription, oldest first.

        Args:
            before: The time, in nanoseconds since 1970.
            names: Names of the topics that count; None is all.
        """
        found: list[BagMessage] = []
        for name, topic in self.topics.items():
            if is_latched(topic) and (names is None or name in names):
                bags = (each for each in self._bags if each.counts.get(name))
                newest = merged_messages(bags, [name], None, before, reverse=True)
                found += [each._replace(data=bytes(each.data)) for each in itertools.islice(newest, retained_of(topic))]
        found.reverse()  # for those of one moment, which keep their order
        return sorted(found, key=lambda each: each.log_time)

    def _sorted(self, messages: Iterator[BagMessage]) -> Iterator[BagMessage]:
        """Yield messages by the times at which they were sent, as far as the window goes."""
        waiting: list[tuple[int, int, BagMessage]] = []
        for number, each in enumerate(messages):
            heapq.heappush(waiting, (each.publish_time, number, each._replace(data=bytes(each.data))))
            if len(waiting) > self._window:
                yield heapq.heappop(waiting)[2]
        while waiting:
            yield heapq.heappop(waiting)[2]


TURN = 256
"""Most messages that one `advance` delivers, so that a pause can come between."""

SHORTEST_ROUND = 10_000_000
"""Time from one message to the next when a bag of no length is looped, in nanoseconds."""


class Messages(Protocol):
    """Messages that can be played: a `Playlist`."""

    start_time: int
    end_time: int

    def time_of(self, message: BagMessage) -> int:
        """Return the time that a message is played at."""

    def messages(self, start: int, end: int | None) -> Iterator[BagMessage]:
        """Yield the messages from `start` to before `end`."""

    def latched(self, before: int) -> list[BagMessage]:
        """Return the messages that latched topics have retained at a time."""


class Playback:
    """Player of messages to a function. Every method may be called from any thread.

    Args:
        messages: What is played.
        deliver: Called with each message that is due, and the time in the bag; it must not wait for another thread
            that uses the playback.
        steady: Function that returns steady time, in nanoseconds.
        settings: From where to where, how fast, how often.
        on_change: Called, without a lock, after each change that `advance` does not know yet.
    """

    def __init__(
        self,
        messages: Messages,
        deliver: Callable[[BagMessage, int], object],
        steady: Callable[[], int],
        settings: PlaySettings,
        on_change: Callable[[], object] = lambda: None,
    ) -> None:
        self.start_time, self.end_time = messages.start_time, messages.end_time
        self.is_over, self.played = True, 0
        self._messages, self._deliver, self._steady = messages, deliver, steady
        self._settings, self._on_change = settings, on_change
        self._head = Playhead(steady, settings.rate)
        self._paused = settings.start_paused
        self._lock = threading.RLock()
        self._coming: Iterator[BagMessage] = iter(())
        self._next: BagMessage | None = None
        self._rest: int | None = None
        self._set_range(settings.start_offset, settings.duration, settings.until)

    # State

    @property
    def time(self) -> int:
        """Time in the bag, in nanoseconds since 1970."""
        return min(self._head.now(), self.last_time)

    @property
    def is_paused(self) -> bool:
        """True while it pauses."""
        return self._paused

    @property
    def is_waiting(self) -> bool:
        """True during the delay before the first message."""
        return not (self.is_over or self._paused) and self._steady() < self._head.due(self._begin)

    @property
    def rate(self) -> float:
        """Seconds of the bag in a second."""
        return self._head.rate

    # Playing

    def begin(self) -> bool:
        """Begin from the start of the range; False if it is playing already."""
        with self._lock:
            if not self.is_over:
                return False
            self.is_over, self.played = False, 0
            self._rewind()
        self._on_change()
        return True

    def begin_at(self, offset: float, duration: float | None, until: int | None) -> bool:
        """Begin with another range, as the service `play` asks; False if it is playing already.

        `offset` and `duration` are in seconds, `until` is in nanoseconds since 1970.
        """
        with self._lock:
            if not self.is_over:
                return False
            self._set_range(offset, duration, until)
            return self.begin()

    def advance(self) -> int | None:
        """Deliver what is due; return the steady time at which to call again, None to wait for `on_change`."""
        for _ in range(TURN):
            with self._lock:
                if self.is_over or self._paused:
                    return None
                if self._next is None:
                    if not self._round_ends():
                        return None
                    continue
                due = self._head.due(self._messages.time_of(self._next))
                if due > self._steady():
                    return due
                self._play_one()
        return self._steady()

    def pause(self) -> None:
        """Pause."""
        with self._lock:
            self._paused = True
            self._head.pause()
        self._on_change()

    def resume(self) -> None:
        """Go on."""
        with self._lock:
            self._paused = False
            if not self.is_over:
                self._head.resume()
        self._on_change()

    def toggle_paused(self) -> None:
        """Pause, or go on after a pause."""
        if self._paused:
            self.resume()
        else:
            self.pause()

    def set_rate(self, rate: float) -> None:
        """Set the rate. Raises PlayError (a ValueError) for one that is not above 0."""
        check_rate(rate)
        with self._lock:
            self._head.rate = rate
        self._on_change()

    def seek(self, time: int) -> bool:
        """Go on from another time of the bag, in nanoseconds since 1970; False if the bag has no such time."""
        with self._lock:
            if not self.start_time <= time <= self.end_time:
                return False
            if self.is_over:
                self.is_over = False
                self._head.pause()
            self._jump(time)
            if not self._paused:
                self._head.resume()
        self._on_change()
        return True

    def play_next(self) -> bool:
        """Deliver the next message, while it pauses; False if it does not pause, or has come to the end."""
        return self.burst(1) == 1

    def burst(self, count: int, *, around: bool = True) -> int:
        """Deliver messages as fast as possible, while it pauses, and return their number.

        Args:
            count: Number of messages; 0 is all up to the end of this round.
            around: False ends at the end of this round, too; else a player that loops begins again.
        """
        done = 0
        while not count or done < count:
            with self._lock:
                if self.is_over or not self._paused:
                    break
                if self._next is None and not (count and around and self._round_ends()):
                    break
                if self._next is None:
                    break
                self._head.jump(self._messages.time_of(self._next))
                self._play_one()
            done += 1
        self._on_change()
        return done

    def stop(self) -> None:
        """End it. Safe to call twice."""
        with self._lock:
            self._end()
        self._on_change()

    def _set_range(self, offset: float, duration: float | None, until: int | None) -> None:
        self._begin = self.start_time + round(offset * 1e9)
        limits = [] if duration is None else [self._begin + round(duration * 1e9)]
        if until is not None:
            limits.append(until)
        self._rest = min(limits) + 1 if limits else None
        self.last_time = self.end_time if self._rest is None else min(self.end_time, self._rest - 1)

    def _rewind(self) -> None:
        shortest = SHORTEST_ROUND if self.played and self.last_time <= self._begin else 0
        self._head.pause()
        self._jump(self._begin, max(shortest, round(self._settings.delay * 1e9)))

    def _jump(self, time: int, delay: int = 0) -> None:
        """Set the time; what latched topics have kept by then comes first."""
        close = getattr(self._coming, "close", None)
        if close is not None:
            close()
        for each in self._messages.latched(time):
            self._deliver(each, time)
        self._coming = self._messages.messages(time, self._rest)
        self._next = next(self._coming, None)
        if not self._paused:
            self._head.resume()
        self._head.jump(time, delay)

    def _play_one(self) -> None:
        message, coming = self._next, self._coming
        assert message is not None
        self.played += 1
        try:
            self._deliver(message, self._messages.time_of(message))  # before the next one, which may take a while
        finally:
            if self._coming is coming:  # whoever got it may have asked to jump, or to stop
                self._next = next(coming, None)

    def _round_ends(self) -> bool:
        """Begin again if it loops, else end; return whether there is more to play."""
        if self._settings.loop and self.played:
            self._rewind()
            if self._next is not None:
                return True
        self._end()
        return False

    def _end(self) -> None:
        self.is_over = True
        self._head.pause()
        self._next = None
        close = getattr(self._coming, "close", None)
        if close is not None:
            close()
        self._coming = iter(())
