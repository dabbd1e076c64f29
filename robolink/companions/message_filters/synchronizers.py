"""Synchronizers: messages of several topics whose stamps are the same, or nearly so, put out together.

A queue that is full drops what *arrived* first. Upstream drops the earliest stamp: after a clock that was set back, by
a simulation begun anew or a recording in a loop, each new message would be dropped at once, for ever.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable, Sequence
from typing import Any

from robolink.companions.message_filters.message_traits import Stamps, TimeGetter, get_time_from_message_header
from robolink.companions.message_filters.simple_filter import SimpleFilter
from robolink.duration import Duration

Queue = dict[int, Any]
"""Messages by their stamps in ns, in the order of their arrival."""


class TimeSynchronizer(SimpleFilter):
    """Filter that outputs messages of several filters with the very same stamp together, in the order of the filters.

    What waits with an earlier stamp than a set that goes out is dropped, so that sets come in the order of their time.

    Args:
        fs: The filters.
        queue_size: Number of messages of each filter that wait for the others; what came first is dropped first.
        time_getter: Function that returns the time of a message, None if it has none; that of its header by default.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        time_getter: TimeGetter = get_time_from_message_header,
    ) -> None:
        super().__init__()
        self.queue_size, self.time_getter = queue_size, time_getter
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:  # noqa: N802
        """Take the outputs of the filters `fs`, with empty queues."""
        self.queues: list[Queue] = [{} for _ in fs]
        self.input_connections = [
            each.registerCallback(self.add, queue, index)
            for index, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Queue a message of one filter; output the set that it completes.

        Args:
            msg: The message.
            my_queue: Queue of the filter.
            my_queue_index: Index of the filter; unused.

        Raises:
            ValueError: if the message has no time.
        """
        stamp = self._stamp_of(msg)
        with self.lock:
            self._keep(my_queue, stamp, msg)
            complete = all(stamp in queue for queue in self.queues)
            found = [queue.pop(stamp) for queue in self.queues] if complete else None
            if complete:
                self._drop_before(stamp)
        if found is not None:  # outside the lock: a callback may take as long as it likes, fail, or add
            self.signalMessage(*found)

    def _stamp_of(self, msg: Any) -> int:
        known = getattr(getattr(msg, "header", None), "stamp", None)
        if self.time_getter is get_time_from_message_header and known is not None:
            return _nanoseconds(known)
        stamp = self.time_getter(msg)
        if stamp is None:
            kind = type(msg).__name__
            raise ValueError(
                f"{kind} has no header with a stamp: pass a time_getter, or use ApproximateTimeSynchronizer with"
                " allow_headerless=True"
            )
        return int(stamp.nanoseconds)

    def _drop_before(self, stamp: int) -> None:
        for queue in self.queues:
            for each in [each for each in queue if each < stamp]:
                del queue[each]

    def _keep(self, queue: Queue, stamp: int, msg: Any) -> None:
        queue.pop(stamp, None)
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[next(iter(queue))]  # the first to arrive, not the oldest stamp: a clock may be set back


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Filter that outputs messages of several filters together whose stamps are less than `slop` apart.

    A new message goes with the nearest one of each other filter that still fits the others. A message without a stamp
    is left out, unless `allow_headerless`.

    Args:
        fs: The filters.
        queue_size: Number of messages of each filter that wait for the others; what came first is dropped first.
        slop: Bound of the difference of the stamps, in seconds.
        queue_offset: Time in nanoseconds, for each filter, by which its stamps are late. True stands for
            `allow_headerless`, which was the fourth argument until 2025.
        allow_headerless: True takes the time of arrival for messages without a header.
        sync_arrival_time: True takes the time of arrival for all messages.
        time_getter: Function that returns the time of a message, None if it has none; that of its header by default.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        queue_offset: Sequence[int] | bool = False,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
        time_getter: TimeGetter = get_time_from_message_header,
    ) -> None:
        self.slop = Duration(seconds=slop)
        self.queue_offset: Sequence[int] = () if isinstance(queue_offset, bool) else queue_offset
        self.allow_headerless = allow_headerless or queue_offset is True
        self.sync_arrival_time = sync_arrival_time
        self._stamps = Stamps(
            "message_filters_approx", self.allow_headerless, fs, time_getter, arrival=sync_arrival_time
        )
        super().__init__(fs, queue_size, time_getter)

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Queue a message of one filter; output the set that it completes.

        Args:
            msg: The message.
            my_queue: Queue of the filter.
            my_queue_index: Index of the filter, for its offset.
        """
        time = self._stamps.of(msg)
        if time is None:
            return
        stamp = time.nanoseconds
        if self.queue_offset and my_queue_index is not None:
            stamp -= self.queue_offset[my_queue_index]
        with self.lock:
            self._keep(my_queue, stamp, msg)
            found = self._complete(my_queue, stamp)
        if found is not None:
            self.signalMessage(*found)

    def _complete(self, mine: Queue, stamp: int) -> list[Any] | None:
        """Take the set that a new message completes out of the queues; None if there is none."""
        if stamp not in mine:  # queue_size is 0
            return None
        others = [queue for queue in self.queues if queue is not mine]
        chosen = nearest_together(stamp, others, self.slop.nanoseconds)
        if chosen is None:
            return None
        stamps = iter(chosen)
        return [queue.pop(stamp if queue is mine else next(stamps)) for queue in self.queues]


def nearest_together(stamp: int, others: Sequence[Iterable[int]], slop: int) -> list[int] | None:
    """Return a stamp of each of `others`, so that all and `stamp` are less than `slop` apart; None if there are none.

    The first takes the nearest with which the rest can still be chosen, then the second, and so on. All are in ns.

    >>> nearest_together(10, [[4, 8, 13], [7]], 5)  # 13 is as near as 7, but they are too far apart
    [8, 7]
    """
    near = [
        sorted((each for each in stamps if abs(each - stamp) < slop), key=lambda it: abs(it - stamp))
        for stamps in others
    ]
    low = high = stamp
    chosen = []
    for index, candidates in enumerate(near):
        for each in candidates:
            bounds = min(low, each), max(high, each)
            if _fits(*bounds, near[index + 1 :], slop):
                low, high = bounds
                chosen.append(each)
                break
        else:
            return None
    return chosen


def _fits(low: int, high: int, rest: Sequence[Sequence[int]], slop: int) -> bool:
    """True if each of the rest has a stamp so that all, and `low` and `high`, are less than `slop` apart."""
    if high - low >= slop:
        return False
    starts = {low, *(each for stamps in rest for each in stamps if each < low and high - each < slop)}
    return any(all(any(0 <= each - start < slop for each in stamps) for stamps in rest) for start in starts)


def _nanoseconds(stamp: Any) -> int:
    """Return any stamp in ns: one before 0 is not a Time, but may be somebody's, and two may be the same."""
    return int(stamp.nanoseconds if hasattr(stamp, "nanoseconds") else stamp.sec * 10**9 + stamp.nanosec)
