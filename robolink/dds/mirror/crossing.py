"""Crossing of a topic's samples from one side to the other: what a lane does with each of them."""

from __future__ import annotations

import functools
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.dds.mirror.sides import Later, Side
from robolink.transport.base import Outlet
from robolink.wire import fields_of, gid_in, is_attachment, numbers_in

KNOWN_WITHIN = 2.0
"""Time in seconds for which samples of a publisher wait whose announcement has not come yet."""

MOST_PARKED = 100
"""Most samples of one publisher that wait, for its announcement or for its outlet to be matched."""

MOST_BYTES_PARKED = 16 << 20
"""Most bytes of one topic that wait for announcements."""


class Forward:
    """Way of one publisher's samples to its outlet on the other side."""

    def __init__(self, outlet: Outlet, sender: bytes, *, waits: bool) -> None:
        self._outlet, self.sender = outlet, sender
        self._waiting: deque[tuple[bytes, bytes]] | None = deque(maxlen=MOST_PARKED) if waits else None
        self.put: Callable[[bytes, bytes], object] = self._hold if waits else outlet.put
        """Send a payload with its attachment, once the outlet is matched."""
        self.last = b""
        """Attachment of the last sample that came this way."""

    def _hold(self, payload: bytes, attachment: bytes) -> None:
        if self._waiting is not None:
            self._waiting.append((payload, attachment))

    def open(self) -> None:
        """Send what waits, and from now on all that comes."""
        waiting, self._waiting = self._waiting or (), None
        self.put = self._outlet.put
        for payload, attachment in waiting:
            self._outlet.put(payload, attachment)

    def is_new(self, attachment: bytes) -> bool:
        """True unless a sample of this number, or a later one, has come this way."""
        if not is_attachment(attachment) or not self.last:
            return True
        return fields_of(attachment)[0] > fields_of(self.last)[0]


class Crossing:
    """All that arrives of one topic from one side, under whatever keys; it is used on the lane's thread only.

    Args:
        source: Side of the publishers.
        later: Ways to do something later.
    """

    droppable = True

    def __init__(self, source: Side, later: Later) -> None:
        self._source, self._later = source, later
        self._read = source.transport.read
        self._forwards: dict[bytes, Forward] = {}
        self._sifts = 0
        self._parked: dict[bytes, tuple[float, deque[tuple[bytes, bytes]]]] = {}
        self._bytes_parked = 0

    def deliver(self, content: Any) -> None:
        """Carry a sample over. This runs once a message: nothing of it is parsed but the sender's gid."""
        payload, attachment = self._read(content)
        forward = self._forwards.get(gid_in(attachment))
        if forward is None:
            self._park(payload, attachment)
        elif not self._sifts or forward.is_new(attachment):
            forward.last = attachment
            # The number and time are the sender's; the gid is that of its announcement on the other side.
            forward.put(payload, numbers_in(attachment) + forward.sender)

    def admit(self, gids: Iterable[bytes], forward: Forward) -> None:
        """Send the samples of the publisher with these gids on from now on, those that wait first."""
        for gid in gids:
            self._forwards[gid] = forward
            _, waiting = self._parked.pop(gid, (0.0, ()))
            for payload, attachment in waiting:
                self._bytes_parked -= len(payload)
                if forward.is_new(attachment):
                    forward.last = attachment
                    forward.put(payload, numbers_in(attachment) + forward.sender)

    def dismiss(self, gids: Iterable[bytes]) -> None:
        """Forget a publisher."""
        for gid in gids:
            self._forwards.pop(gid, None)

    def sift(self, more: int) -> None:
        """Drop what comes twice, by its number, from now on (1), or no longer (-1); as often as it was begun."""
        self._sifts += more

    # Senders that are not known yet

    def _park(self, payload: bytes, attachment: bytes) -> None:
        """Store a sample whose sender is not known yet: data may be faster than the token, above all of a new one.

        An echo of the mirror's own is dropped.
        """
        gid = gid_in(attachment)
        if gid in self._source.own or not is_attachment(attachment):
            return
        if self._bytes_parked + len(payload) > MOST_BYTES_PARKED:
            return
        if not self._parked:
            self._later.call(self._expire_later)
        _, waiting = self._parked.setdefault(gid, (self._later.now(), deque()))
        if len(waiting) < MOST_PARKED:
            waiting.append((payload, attachment))
            self._bytes_parked += len(payload)

    def _expire_later(self) -> None:
        lane = self._source.lane
        self._later.call_after(KNOWN_WITHIN, functools.partial(lane.post, self._expire))

    def _expire(self) -> None:
        before = self._later.now() - KNOWN_WITHIN
        for gid in [gid for gid, (since, _) in self._parked.items() if since <= before]:
            self._bytes_parked -= sum(len(payload) for payload, _ in self._parked.pop(gid)[1])
        if self._parked:
            self._later.call(self._expire_later)
