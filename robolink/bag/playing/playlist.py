"""Messages of one or several bags in the order in which they are played."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Container, Iterator, Sequence

from robolink.bag.merging import merged_messages, merged_topics
from robolink.bag.playing.offers import is_latched, kept_of
from robolink.bag.playing.settings import RECEIVED, PlayError
from robolink.bag.reader import Bag
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
        """Return what latched topics would have kept for a late subscription at a time, oldest first.

        Args:
            before: The time, in nanoseconds since 1970.
            names: Names of the topics that count; None is all.
        """
        found: list[BagMessage] = []
        for name, topic in self.topics.items():
            if is_latched(topic) and (names is None or name in names):
                bags = (each for each in self._bags if each.counts.get(name))
                newest = merged_messages(bags, [name], None, before, reverse=True)
                found += [each._replace(data=bytes(each.data)) for each in itertools.islice(newest, kept_of(topic))]
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
