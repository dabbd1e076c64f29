"""Settings of a recording, its topics, and the definitions of their types.

Looking definitions up takes time, seconds where a node has to be requested, so it has threads of its own: nothing else
waits.
"""

from __future__ import annotations

import functools
import queue
import threading
from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from robolink.bag.topic import message_definition
from robolink.exceptions import RobolinkError
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.running.backlog import Gaps
from robolink.system import waits
from robolink.transport.history import latched_depth
from robolink.type_lookup import installed_type, type_of
from robolink.wire import EndpointToken

if TYPE_CHECKING:
    from robolink.context import Context


CACHE_SIZE = 100 * 1024 * 1024
"""Default limit of the messages that wait to be written, in bytes: rosbag2's."""


class RecordSettings(NamedTuple):
    """Settings of one recording."""

    storage: str = "mcap"
    compression: str = ""
    """Compression: "", "zstd" or "lz4"."""
    compression_mode: str = ""
    """Unit of compression: "" the chunks of a file, as it is written; or "file" or "message", as in rosbag2."""
    max_bag_size: int = 0
    """Size in bytes from which a file is closed and the next one begun; 0 is never."""
    max_bag_duration: float = 0.0
    """Age in seconds at which a file is closed and the next one begun; 0 is never."""
    max_bag_files: int = 0
    """Number of files that are kept, the newest ones; 0 keeps all."""
    max_cache_size: int = CACHE_SIZE
    """Limit of the messages that wait to be written, or of a snapshot, in bytes; 0 for no limit."""
    max_cache_duration: float = 0.0
    """Limit of the time between the first and the last of them, in seconds; 0 for no limit."""
    snapshot_mode: bool = False
    """True to keep messages in memory, and to write them when a snapshot is asked for."""
    start_paused: bool = False
    use_sim_time: bool = False
    """True to note messages with the time of /clock, and to begin with its first message."""
    custom_data: Mapping[str, str] = {}
    qos_overrides: Mapping[str, QoSProfile] = {}
    """Profiles of subscriptions by topic; else what the publishers offer decides."""
    static_topics: Mapping[str, type[Any]] = {}
    """Message classes of topics that are listened to from the start, whoever will publish them."""
    repeat_latched: Mapping[str, int] = {}
    """Number of last messages, by latched topic, that each further file and each snapshot begins with."""
    repeat_all_latched: bool = False
    """True to repeat all that is latched, as many messages of a topic as its publishers keep."""
    no_discovery: bool = False
    """True to record only topics that are there at the start."""
    include_unpublished: bool = False
    """True to subscribe to topics that have only subscriptions so far."""
    ignore_leaf_topics: bool = False
    """True to record only topics to which another node subscribes."""


MOST_LATCHED = 1000
"""Most messages of a latched topic that are kept to be repeated."""


class Arrived(NamedTuple):
    """Message of a topic on its way into the bag; times in ns."""

    topic: RecordedTopic
    log_time: int
    publish_time: int
    sequence: int
    data: bytes


make_arrived: Callable[[tuple[RecordedTopic, int, int, int, bytes]], Arrived] = functools.partial(
    tuple.__new__, Arrived
)
"""Fast constructor of Arrived, whose `__new__` is Python: for once a message."""


class RecordedTopic:
    """One topic of one type.

    Each attribute is changed by one thread: those of the publishers by the graph's, the counts of what was lost and
    dropped by the collector's, the others by the writer's.
    """

    def __init__(self, token: EndpointToken, now: int) -> None:
        self.token, self.name, self.type_name = token, token.name, token.type_name
        self.since = now
        """Time of its announcement, in ns."""
        self.offered: dict[bytes, QoSProfile] = {}
        """Profiles of its publishers, by gid; those that are gone, too."""
        self.keys: dict[str, QoSProfile] = {}
        """Keys that are listened to, with the profile of the subscription."""
        self.comes_twice = False
        """True if a message may come by two subscriptions."""
        self.gaps = Gaps(self._numbers_count)
        self.last = self.gaps.last
        """Number of each publisher's last message, by gid."""
        self.lost = 0
        """Number of messages that were published and did not come."""
        self.dropped = 0
        """Number of messages that came and had no room."""
        self.number = -1
        """Number of the topic in the bag; -1 while its definition is not known."""
        self.pending: list[Arrived] = []
        """Messages that wait for that."""
        self.retained: deque[Arrived] | None = None
        """Last messages, if they are to be repeated."""

    @property
    def is_latched(self) -> bool:
        """True if a publisher keeps messages for late subscriptions."""
        return any(each.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in list(self.offered.values()))

    @property
    def profiles(self) -> tuple[QoSProfile, ...]:
        """Profiles of its publishers."""
        return tuple(self.offered.copy().values())

    @property
    def latched_depth(self) -> int:
        """Number of messages that its publishers keep for late subscriptions, all together."""
        latched = [each for each in self.profiles if each.durability is DurabilityPolicy.TRANSIENT_LOCAL]
        return min(MOST_LATCHED, sum(map(latched_depth, latched)))

    def keep(self, depth: int) -> None:
        """Keep so many last messages from now on, to be repeated."""
        if self.retained is None or self.retained.maxlen != depth:
            self.retained = deque(self.retained or (), maxlen=depth)

    def _numbers_count(self, gid: bytes) -> bool:
        """Return whether gaps in a publisher's numbers are losses: not for one that sends to several keys."""
        return not self.token.names_backends


Found = Callable[[RecordedTopic, str], object]
"""Function of a topic and the text of its type, '' if nobody knows it."""


class Definitions:
    """Looks up the types of topics, one after the other; those that nodes are asked for, side by side.

    Args:
        context: Context whose network is asked.
        found: Called once for each topic, on one of the threads.
        warn: Called with one line for each type that nobody describes.
    """

    def __init__(self, context: Context, found: Found, warn: Callable[[str], object]) -> None:
        self._context, self._found, self._warn = context, found, warn
        self._requested: queue.SimpleQueue[RecordedTopic | None] = queue.SimpleQueue()
        self._known: dict[tuple[str, str], str] = {}
        self._unknown: dict[tuple[str, str], list[RecordedTopic]] = {}
        """Topics that wait for the type that is being asked for."""
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._run, name="robolink bag types", daemon=True)

    def start(self) -> None:
        """Start to look up."""
        self._thread.start()

    def look_up(self, topic: RecordedTopic) -> None:
        """Look up the type of a topic, in its turn."""
        self._requested.put(topic)

    def close(self) -> None:
        """Look up nothing more; what waits for a node's answer is told of as unknown."""
        self._requested.put(None)
        if self._thread.ident is not None:  # it was started
            waits.join(self._thread)
        with self._lock:
            waiting = [topic for topics in self._unknown.values() for topic in topics]
            self._unknown.clear()
        for topic in waiting:
            self._found(topic, "")

    def _run(self) -> None:
        for topic in iter(self._requested.get, None):
            text = self._installed(topic)
            if text is None:
                self._ask(topic)
            else:
                self._found(topic, text)

    def _installed(self, topic: RecordedTopic) -> str | None:
        kind = (topic.type_name, topic.token.type_hash)
        if kind not in self._known:
            try:
                installed = installed_type(topic.token)
                if installed is None:
                    return None
                self._known[kind] = message_definition(installed)
            except RobolinkError:  # a file of the workspace is wrong: the publisher may tell
                return None
        return self._known[kind]

    def _ask(self, topic: RecordedTopic) -> None:
        kind = (topic.type_name, topic.token.type_hash)
        with self._lock:
            waiting = self._unknown.setdefault(kind, [])
            waiting.append(topic)
            is_first = len(waiting) == 1
        if is_first:
            threading.Thread(target=self._ask_nodes, args=(topic, kind), name="robolink bag type", daemon=True).start()

    def _ask_nodes(self, topic: RecordedTopic, kind: tuple[str, str]) -> None:
        text = ""
        try:
            text = message_definition(type_of(self._context, topic.token))
        except RobolinkError as error:
            if self._context.ok():
                self._warn(f"{error} (it is recorded without its definition)")
        with self._lock:
            self._known[kind] = text
            waiting = self._unknown.pop(kind, [])
        for each in waiting:
            self._found(each, text)
