"""Recorded topic: who publishes it, what is known of its type, and what came, was dropped and was lost."""

from __future__ import annotations

import functools
from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.running.backlog import Gaps
from robolink.transport.history import latched_depth
from robolink.wire import EndpointToken

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
        self.kept: deque[Arrived] | None = None
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
        if self.kept is None or self.kept.maxlen != depth:
            self.kept = deque(self.kept or (), maxlen=depth)

    def _numbers_count(self, gid: bytes) -> bool:
        """Return whether gaps in a publisher's numbers are losses: not for one that sends to several keys."""
        return not self.token.names_backends
