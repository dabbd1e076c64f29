"""Raw subscription to a channel, in the types and qualities of its publishers, and what its latched ones have said."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping

from robolink.graph.endpoint import ALL_BEST_EFFORT, ArrivalType, Owner, keys_of, listen
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.transport.base import Handle
from robolink.transport.history import latched_depth
from robolink.view.channels import Channel, Retained
from robolink.wire import EndpointToken, gid_in

LATCHED = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)

MOST_RETAINED = 1000
MOST_RETAINED_BYTES = 64 * 2**20
"""Upper bounds of what is kept of one latched channel for late subscribers."""


def latches(publishers: Iterable[EndpointToken]) -> bool:
    """True if any of the publishers keeps messages for late subscribers."""
    return any(each.qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for each in publishers)


class Listening:
    """Subscription of a channel, to all publishers of its type.

    Args:
        owner: Node that listens.
        channel: Channel that gets the messages.
        arrival: Class of arrivals, whose target this is.
    """

    def __init__(self, owner: Owner, channel: Channel, arrival: ArrivalType) -> None:
        self.channel = channel
        self._owner, self._sink = owner, functools.partial(arrival, self)
        self._latched = False
        self._heard: set[str] = set()
        self._declared: list[Handle] = []
        self._depths: dict[bytes, int] = {}
        self._retained: list[Retained] = []
        self._retained_bytes = 0

    @property
    def reads(self) -> bool:
        """True if the messages are wanted, not only their number and size."""
        return self._latched or bool(self.channel.takers)

    def follow(self, publishers: Mapping[bytes, EndpointToken]) -> None:
        """Listen to those of these publishers that are of the channel's type."""
        own = {gid: each for gid, each in publishers.items() if self.channel.fits(each)}
        self._depths = {gid: latched_depth(each.qos) for gid, each in own.items() if latches([each])}
        if self._depths and not self._latched:  # a plain subscription hears nothing of before
            self.close()
            self._latched = True
        for each in own.values():
            keys = keys_of(each) - self._heard
            if keys:
                self._heard |= keys
                qos = LATCHED if self._latched else ALL_BEST_EFFORT
                self._declared += listen(self._owner, each, keys, qos, self._sink)

    def deliver(self, at: int, payload: bytes, attachment: bytes) -> None:
        """Hand a message on, and keep it if it is latched."""
        if self._latched:
            self._keep(Retained(at, payload, attachment))
        self.channel.deliver(at, payload, attachment)

    def _keep(self, message: Retained) -> None:
        gid = gid_in(message.sender)
        depth = self._depths.get(gid)
        if depth is None:
            return
        self._retained.append(message)
        self._retained_bytes += len(message.payload)
        own = (
            [index for index, each in enumerate(self._retained) if gid_in(each.sender) == gid]
            if depth < MOST_RETAINED
            else []
        )
        if own and len(own) > depth:
            self._drop(own[0])
        while len(self._retained) > MOST_RETAINED or self._retained_bytes > MOST_RETAINED_BYTES:
            self._drop(0)

    def _drop(self, index: int) -> None:
        self._retained_bytes -= len(self._retained.pop(index).payload)

    def forget(self, gid: bytes) -> None:
        """Keep nothing of a publisher that has gone, as its network does."""
        if self._depths.pop(gid, None) is not None:
            self._retained = [each for each in self._retained if gid_in(each.sender) != gid]
            self._retained_bytes = sum(len(each.payload) for each in self._retained)

    def retained(self) -> list[Retained]:
        """Return the messages for late subscribers, oldest first."""
        return list(self._retained)

    def close(self) -> None:
        """Listen no longer."""
        for each in self._declared:
            each.close()
        self._declared.clear()
        self._heard.clear()
