"""Message filters: a topic, a cache of its latest messages, or synchronized messages of several topics.

Names and rules are those of ROS 2's message_filters::

    image, info = Subscriber(node, Image, "image"), Subscriber(node, CameraInfo, "camera_info")
    both = ApproximateTimeSynchronizer([image, info], queue_size=10, slop=0.05)
    both.registerCallback(on_image)  # on_image(image, info)

A queue that is full drops what *arrived* first. Upstream drops the earliest stamp: after a clock that was set back, by
a simulation begun anew or a recording in a loop, each new message would be dropped at once, for ever.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from typing import TYPE_CHECKING, Any

from robolink.clock import ROSClock
from robolink.duration import Duration
from robolink.logging import get_logger
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.node import Node
    from robolink.qos import QoSProfile

__all__ = ["ApproximateTimeSynchronizer", "Cache", "SimpleFilter", "Subscriber", "TimeSynchronizer"]

Queue = dict[int, Any]
"""Messages by their stamps in ns, in the order of their arrival."""


class SimpleFilter:
    """Base class of filters: calls the registered callbacks with each output."""

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., Any], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., Any], *args: Any) -> int:  # noqa: N802 - upstream's name
        """Register a callback.

        Args:
            cb: Called with each output.
            args: Further arguments of each call, after the output.

        Returns:
            The number of this connection.
        """
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:  # noqa: N802
        """Call all callbacks with `msg`, the output: one message, or one of each filter."""
        for callback, args in list(self.callbacks.values()):
            callback(*msg, *args)


class Subscriber(SimpleFilter):
    """Filter that outputs the messages of a topic. It has all attributes of its subscription.

    Args:
        node: Node that subscribes.
        msg_type: Class of the messages.
        topic: Name of the topic.
        qos_profile: QoS profile of the subscription, or its depth.
        kwargs: The other keywords of `Node.create_subscription`.
    """

    def __init__(
        self, node: Node, msg_type: type[Any], topic: str, qos_profile: QoSProfile | int = 10, **kwargs: Any
    ) -> None:
        super().__init__()
        self.node, self.topic = node, topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **kwargs)

    def callback(self, msg: Any) -> None:
        """Output `msg`: the subscription's callback."""
        self.signalMessage(msg)

    def getTopic(self) -> str:  # noqa: N802
        """Return the topic's name as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # looked up before it was made
            raise AttributeError(key)
        return getattr(self.sub, key)


class Cache(SimpleFilter):
    """Filter that keeps the last messages of another, to be looked up by their time, and passes each on.

    A message without a stamp is left out, unless `allow_headerless`: then the time of its arrival serves as its stamp.
    Times are compared as they are: use Times of ROS's clock for messages with headers.

    Args:
        f: Filter whose messages are stored.
        cache_size: Number of messages that are stored; the oldest goes first.
        allow_headerless: True keeps messages without a header by the time of their arrival.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size, self.allow_headerless = cache_size, allow_headerless
        self._stored: deque[tuple[Time, Any]] = deque(maxlen=max(0, cache_size))
        self._stamps = _Stamps("message_filters_cache", allow_headerless, [f])
        self.connectInput(f)

    @property
    def cache_msgs(self) -> list[Any]:
        """The messages, as they came."""
        return [msg for _, msg in self._stored]

    @property
    def cache_times(self) -> list[Time]:
        """The times of the messages."""
        return [time for time, _ in self._stored]

    def connectInput(self, f: SimpleFilter) -> None:  # noqa: N802
        """Take the output of the filter `f`."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Keep `msg` and pass it on."""
        time = self._stamps.of(msg)
        if time is not None:
            self._stored.append((time, msg))
            self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:  # noqa: N802
        """Return the messages from the time `from_stamp` to `to_stamp`, both included."""
        assert from_stamp <= to_stamp, "the interval ends before it begins"
        return [msg for time, msg in list(self._stored) if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:  # noqa: N802
        """Return the earliest message at or after the time `stamp`; None if there is none."""
        return min((each for each in list(self._stored) if each[0] >= stamp), key=_time_of, default=(None, None))[1]

    def getElemBeforeTime(self, stamp: Time) -> Any:  # noqa: N802
        """Return the latest message at or before the time `stamp`; None if there is none."""
        return max((each for each in list(self._stored) if each[0] <= stamp), key=_time_of, default=(None, None))[1]

    def getLastestTime(self) -> Time | None:  # noqa: N802 - upstream's spelling
        """Return the time of the message that came last; None if none has come."""
        return self._stored[-1][0] if self._stored else None

    def getOldestTime(self) -> Time | None:  # noqa: N802
        """Return the time of the first message of those stored; None if none has come."""
        return self._stored[0][0] if self._stored else None

    def getLast(self) -> Any:  # noqa: N802
        """Return the message that came last; None if none has come."""
        return self._stored[-1][1] if self._stored else None


class TimeSynchronizer(SimpleFilter):
    """Filter that outputs messages of several filters with the very same stamp together, in the order of the filters.

    Args:
        fs: The filters.
        queue_size: Number of messages of each filter that wait for the others; what came first is dropped first.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size = queue_size
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
        """
        stamp = _nanoseconds(msg.header.stamp)
        with self.lock:
            self._keep(my_queue, stamp, msg)
            complete = all(stamp in queue for queue in self.queues)
            found = [queue.pop(stamp) for queue in self.queues] if complete else None
        if found is not None:  # outside the lock: a callback may take as long as it likes, fail, or add
            self.signalMessage(*found)

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
        allow_headerless: True takes the time of arrival for messages without a header.
        sync_arrival_time: True takes the time of arrival for all messages.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
    ) -> None:
        self.slop = Duration(seconds=slop)
        self.allow_headerless, self.sync_arrival_time = allow_headerless, sync_arrival_time
        self._stamps = _Stamps("message_filters_approx", allow_headerless, fs, sync_arrival_time)
        super().__init__(fs, queue_size)

    def add(self, msg: Any, my_queue: Queue, my_queue_index: int | None = None) -> None:
        """Queue a message of one filter; output the set that it completes.

        Args:
            msg: The message.
            my_queue: Queue of the filter.
            my_queue_index: Index of the filter; unused.
        """
        time = self._stamps.of(msg)
        if time is None:
            return
        with self.lock:
            self._keep(my_queue, time.nanoseconds, msg)
            found = self._complete(my_queue, time.nanoseconds)
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


class _Stamps:
    """Source of a message's time: its header's, or that of its arrival."""

    def __init__(self, logger: str, allow_headerless: bool, fs: Sequence[SimpleFilter], arrival: bool = False) -> None:
        node = next((each.node for each in fs if isinstance(each, Subscriber)), None)
        self.clock = ROSClock() if node is None else node.get_clock()
        self.logger, self.allow_headerless, self.arrival = logger, allow_headerless, arrival
        self.reported = False

    def of(self, msg: Any) -> Time | None:
        """Return the time, None for a message that is to be left out; the first of these is warned about."""
        stamp = getattr(getattr(msg, "header", None), "stamp", None)
        if self.arrival or (stamp is None and self.allow_headerless):
            return self.clock.now()
        kind = type(msg).__name__
        if stamp is None:
            self._tell(
                f"{kind} has no header with a stamp: messages of it are left out; with allow_headerless=True the time"
                " at which one comes stands for its stamp"
            )
            return None
        try:
            return _time(stamp)
        except ValueError as error:  # anybody may have sent it
            self._tell(f"a message ({kind}) is left out for its stamp: {error}")
            return None

    def _tell(self, problem: str) -> None:
        if not self.reported:
            self.reported = True
            get_logger(self.logger).warning(problem)


def _time(stamp: Any) -> Time:
    return stamp if hasattr(stamp, "nanoseconds") else Time.from_msg(stamp)


def _nanoseconds(stamp: Any) -> int:
    """Return any stamp in ns: one before 0 is not a Time, but may be somebody's, and two may be the same."""
    return int(stamp.nanoseconds if hasattr(stamp, "nanoseconds") else stamp.sec * 10**9 + stamp.nanosec)


def _time_of(stored: tuple[Time, Any]) -> int:
    return stored[0].nanoseconds
