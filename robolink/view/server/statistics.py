"""Statistics of all channels and of the server, once a second, for clients that ask for them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import psutil

from robolink.view.channels import Channel, Source
from robolink.view.protocol import answers
from robolink.view.server.outbox import Listener

PERIOD = 1.0
"""Interval of the statistics, in seconds."""

SHORTEST = 0.5
"""Time in seconds over which a rate is measured at least: less of a bag may pass in an interval, as it is paused."""

HEAVY = 2e6
"""Bandwidth in bytes a second above which a channel that is received for its figures alone is only sampled."""

REST = 10
"""Number of intervals in which a heavy channel is not received, after one in which it was measured."""


class Statistics:
    """Figures of all channels, which are received while anybody wants them; of most only the size is looked at.

    Heavy ones, such as cameras, are sampled: figures alone are not worth the load on a robot's wireless network.

    Args:
        source: Where the channels come from.
        clock: Function that returns the time by which rates are measured, in seconds: that of a steady clock, or of a
            bag, in which messages are as far apart as they were recorded at any speed.
    """

    def __init__(self, source: Source, clock: Callable[[], float]) -> None:
        self._source, self._clock = source, clock
        self._resting: dict[int, int] = {}
        """Intervals that are left until a channel is received again, by its id."""
        self._flows: dict[int, tuple[float, float]] = {}
        """Rate and bandwidth of each channel as they were measured last."""
        self._followers: set[Listener] = set()
        self._before: dict[int, tuple[float, int, int]] = {}
        self._process = psutil.Process()

    @property
    def followed(self) -> bool:
        """True while a client wants them."""
        return bool(self._followers)

    def follow(self, client: Listener) -> None:
        """Send a client the figures from now on."""
        self._followers.add(client)
        self._process.cpu_percent()
        self.measure(self._source.channels.values())

    def measure(self, channels: Iterable[Channel]) -> None:
        """Receive these channels, if anybody wants their figures."""
        if self._followers:
            now = self._clock()
            for each in channels:
                if each.id in self._resting:
                    continue
                self._source.listen(each)
                self._before.setdefault(each.id, (now, each.count, each.bytes))

    def jump(self) -> None:
        """Measure anew, as a bag was moved to another place; until then rates are what they were."""
        self._before.clear()

    def forget(self, channels: Iterable[Channel]) -> None:
        """Forget channels that have gone."""
        for each in channels:
            for known in (self._before, self._resting, self._flows):
                known.pop(each.id, None)

    def part(self, client: Listener) -> None:
        """Send a client no more of them."""
        if client in self._followers:
            self._followers.discard(client)
            if not self._followers:
                self.forget(self._source.channels.values())
                for each in list(self._source.channels.values()):
                    if not each.takers:
                        self._source.leave(each)

    def tick(self, clients: int, dropped: int) -> None:
        """Send the figures; to be called each PERIOD.

        Args:
            clients: Number of clients.
            dropped: Number of messages that slow clients did not get.
        """
        if not self._followers:
            return
        now, wall = self._clock(), self._source.now()
        topics = [self._topic(each, now, wall) for each in self._source.channels.values()]
        server = {"clients": clients, "cpu": self._process.cpu_percent() / 100, "dropped": dropped}
        text = answers.text("statistics", topics=topics, server=server)
        for each in self._followers:
            each.say(text)

    def _is_resting(self, channel: Channel, now: float) -> bool:
        """Return whether a heavy channel is not received now; when its rest is over, it is again."""
        left = self._resting.pop(channel.id, None)
        if left is None:
            return False
        if left > 1 and not channel.takers:
            self._resting[channel.id] = left - 1
        else:
            self._source.listen(channel)
            self._before[channel.id] = (now, channel.count, channel.bytes)
        return True

    def _measure(self, channel: Channel, now: float) -> None:
        then, count, size = self._before.setdefault(channel.id, (now, channel.count, channel.bytes))
        spent = now - then
        if 0 <= spent < SHORTEST and (channel.id in self._flows or not spent):
            return
        self._before[channel.id] = (now, channel.count, channel.bytes)
        if spent < 0:  # the bag plays from its begin again
            return
        self._flows[channel.id] = ((channel.count - count) / spent, (channel.bytes - size) / spent)
        if self._flows[channel.id][1] > HEAVY and not channel.takers:
            self._resting[channel.id] = REST
            self._source.leave(channel)

    def _topic(self, channel: Channel, now: float, wall: int) -> dict[str, Any]:
        is_resting = self._is_resting(channel, now)
        if not is_resting:
            self._measure(channel, now)
        rate, bandwidth = self._flows.get(channel.id, (0.0, 0.0))
        is_dated = channel.count and not is_resting and channel.last <= wall
        publishers, subscriptions = self._source.ends(channel)
        return {
            "channelId": channel.id,
            "rate": round(rate, 2),
            "bandwidth": round(bandwidth, 1),
            "age": round((wall - channel.last) / 1e9, 3) if is_dated else None,
            "count": channel.count,
            "publishers": publishers,
            "subscriptions": subscriptions,
        }
