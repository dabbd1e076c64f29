"""Crossing of a topic's samples from one side to the other: what a lane does with each of them."""

from __future__ import annotations

import functools
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from robolink.dds.mirror.sides import Later, Side
from robolink.transport.base import Outlet
from robolink.wire import fields_of, gid_in, is_attachment, numbers_in

KNOWN_WITHIN = 2.0
"""Time in seconds for which samples of a publisher wait whose announcement has not come yet."""

ADOPTED_AFTER = 0.3
"""Time in seconds after which they are taken to be those of a known publisher that has sent nothing by its own gid."""

LOOK_EVERY = 0.1
"""Interval of the looks at the samples that wait, in seconds."""

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
        self.gids: list[bytes] = []
        """Gids of the samples that come this way."""
        self.last = b""
        """Attachment of the last sample that came this way."""
        self.is_silent = False
        """True once nobody wants what comes this way."""

    def _hold(self, payload: bytes, attachment: bytes) -> None:
        if self._waiting is not None:
            self._waiting.append((payload, attachment))

    def open(self) -> None:
        """Send what waits, and from now on all that comes."""
        waiting, self._waiting = self._waiting or (), None
        self.put = self._outlet.put
        for payload, attachment in waiting:
            self._outlet.put(payload, attachment)

    def silence(self) -> None:
        """Drop from now on all that comes, and what waits."""
        self.is_silent, self._waiting = True, None
        self.put = self._hold

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

    def admit(self, gids: Sequence[bytes], forward: Forward) -> None:
        """Send the samples of the publisher with these gids on from now on, those that wait first."""
        before = [silent for gid in gids if (silent := self._forwards.get(gid)) is not None]
        for gid in dict.fromkeys([*gids, *(each for silent in before for each in silent.gids)]):
            self._forwards[gid] = forward
            forward.gids.append(gid)
            _, waiting = self._parked.pop(gid, (0.0, ()))
            for payload, attachment in waiting:
                self._bytes_parked -= len(payload)
                if forward.is_new(attachment):
                    forward.last = attachment
                    forward.put(payload, numbers_in(attachment) + forward.sender)

    def silence(self, gids: Sequence[bytes]) -> None:
        """Drop the samples of a publisher, which nobody wants until it is admitted again.

        Were it forgotten, those that are under way would wait for its announcement, and the next reader would get them.
        """
        for gid in gids:
            if (forward := self._forwards.get(gid)) is not None:
                forward.silence()

    def dismiss(self, gids: Sequence[bytes]) -> None:
        """Forget a publisher."""
        found = [forward for gid in gids if (forward := self._forwards.get(gid)) is not None]
        for forward in found:
            for gid in forward.gids:
                if self._forwards.get(gid) is forward:
                    del self._forwards[gid]

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
            self._later.call(self._look_later)
        _, waiting = self._parked.setdefault(gid, (self._later.now(), deque()))
        if len(waiting) < MOST_PARKED:
            waiting.append((payload, attachment))
            self._bytes_parked += len(payload)

    def _look_later(self) -> None:
        self._later.call_after(LOOK_EVERY, functools.partial(self._source.lane.post, self._look))

    def _look(self) -> None:
        """Find a publisher for the samples that wait, and drop those that have waited long enough.

        rmw_zenoh's gid is a hash of the token; others on Zenoh choose one at random (zenoh-ros2-sdk 0.1.8).
        """
        now = self._later.now()
        for gid, (since, waiting) in [*self._parked.items()]:
            if now - since < ADOPTED_AFTER:
                continue
            forward = next((each for each in self._forwards.values() if not each.last and not each.is_silent), None)
            if forward is not None:
                self.admit([gid], forward)
            elif now - since >= KNOWN_WITHIN:
                del self._parked[gid]
                self._bytes_parked -= sum(len(payload) for payload, _ in waiting)
        if self._parked:
            self._later.call(self._look_later)
