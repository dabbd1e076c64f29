"""Filters of one topic: its messages, a cache of the latest ones, a chain of filters."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

from robolink.companions.message_filters.message_traits import Stamps, TimeGetter, get_time_from_message_header
from robolink.companions.message_filters.simple_filter import SimpleFilter
from robolink.time import Time

if TYPE_CHECKING:
    from robolink.node import BaseNode
    from robolink.qos import QoSProfile


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
        self, node: BaseNode, msg_type: type[Any], topic: str, qos_profile: QoSProfile | int = 10, **kwargs: Any
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
        time_getter: Function that returns the time of a message, None if it has none; that of its header by default.
    """

    def __init__(
        self,
        f: SimpleFilter,
        cache_size: int = 1,
        allow_headerless: bool = False,
        time_getter: TimeGetter = get_time_from_message_header,
    ) -> None:
        super().__init__()
        self.cache_size, self.allow_headerless = cache_size, allow_headerless
        self._stored: deque[tuple[Time, Any]] = deque(maxlen=max(0, cache_size))
        self._stamps = Stamps("message_filters_cache", allow_headerless, [f], time_getter)
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

    def getLatestTime(self) -> Time | None:  # noqa: N802
        """Return the time of the message that came last; None if none has come."""
        return self._stored[-1][0] if self._stored else None

    getLastestTime = getLatestTime  # noqa: N815 - upstream's spelling until 2026

    def getOldestTime(self) -> Time | None:  # noqa: N802
        """Return the time of the first message of those stored; None if none has come."""
        return self._stored[0][0] if self._stored else None

    def getLast(self) -> Any:  # noqa: N802
        """Return the message that came last; None if none has come."""
        return self._stored[-1][1] if self._stored else None


class Chain(SimpleFilter):
    """Filter that consists of others, each of which gets the output of the one before: ``addFilter(first)``, ...

    Args:
        message_filter: Filter whose output goes into the first; `connectInput` may say it later.
    """

    def __init__(self, message_filter: SimpleFilter | None = None) -> None:
        super().__init__()
        self.incoming_connection: int | None = None
        self._filters: dict[int, Any] = {}
        self._last_connection = 0
        if message_filter is not None:
            self.connectInput(message_filter)

    def connectInput(self, message_filter: SimpleFilter) -> None:  # noqa: N802
        """Take the output of `message_filter`. Raises RuntimeError the second time."""
        if self.incoming_connection is not None:
            raise RuntimeError("Already connected")
        self.incoming_connection = message_filter.registerCallback(self.add)

    def add(self, message: Any) -> None:
        """Put `message` into the first filter; without any, put it out."""
        if self._filters:
            self._filters[0].add(message)
        else:
            self.signalMessage(message)

    def addFilter(self, message_filter: Any) -> None:  # noqa: N802
        """Add `message_filter`, a filter with a method `add`, at the end."""
        index = len(self._filters)
        if index:
            last = self._filters[index - 1]
            last.unregisterCallback(self._last_connection)
            last.registerCallback(message_filter.add)
        self._filters[index] = message_filter
        self._last_connection = message_filter.registerCallback(self.signalMessage)

    def getFilter(self, index: int) -> Any:  # noqa: N802
        """Return the filter at `index`, from 0. Raises KeyError if there is none."""
        return self._filters[index]


def _time_of(stored: tuple[Time, Any]) -> int:
    return stored[0].nanoseconds
