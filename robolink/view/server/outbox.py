"""Outbox of a client: messages on their way to it, of which a slow client gets the newest, in bounded memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol

from robolink.view.channels import LARGEST, Retained, Take
from robolink.view.protocol.answers import ERROR, Entry, batch, head, message_frames
from robolink.wire import gid_in

MEMORY = LARGEST
"""Upper bound of the payloads that wait for one client, in bytes; as many again may be in its connection's buffer."""

BUFFERED = 256 * 1024
"""Bytes in the connection's buffer above which a client counts as slow."""

CREDIT = 2
"""Batches that a client of robolink.v1 may have unacknowledged."""

MOST_LATCHED = 5000
"""Messages of one latched topic that wait for a client that takes none, as a page in a hidden tab: as many as its log
shows. Without this bound, days of small ones fill the memory, and looking through them on each tick stalls the loop.
"""


class Listener(Protocol):
    """Receiver of answers."""

    is_page: bool
    """True for robolink's own page, which is told more."""

    def say(self, text: str) -> None:
        """Send an operation in JSON."""

    def send(self, body: bytes) -> None:
        """Send a binary operation."""

    def complain(self, message: str, level: int = ERROR) -> None:
        """Report, as a status, what is wrong."""


class Wire(Protocol):
    """Connection's transport, as asyncio has it."""

    @property
    def write(self) -> Callable[[bytes], None]:
        """Function that sends, or buffers."""

    @property
    def get_write_buffer_size(self) -> Callable[[], int]:
        """Function that returns the number of bytes that are buffered."""

    def is_closing(self) -> bool:
        """True once nothing more can be sent."""

    @property
    def abort(self) -> Callable[[], None]:
        """Function that ends the connection at once."""


class Subscribed:
    """Subscription of a client: its number, and its period in seconds (0: every message)."""

    __slots__ = ("due", "id", "keeps_all", "newest", "period", "take")

    def __init__(self, number: int, period: float, keeps_all: bool) -> None:
        self.id, self.period, self.keeps_all = number, period, keeps_all
        self.due = 0.0
        self.newest: dict[bytes, Entry] = {}
        """With a period: the newest message of each publisher."""
        self.take: Take = lambda at, payload, sender: None


class Outbox:
    """Messages for one client.

    A client is slow while two batches are unacknowledged, or its connection's buffer is filled. Then only the newest
    message of each publisher of each topic is held, but MOST_LATCHED of latched topics, since each of those counts. The
    oldest give way where even that is more than MEMORY.

    Args:
        wire: Transport of the connection.
        batching: True for a client of robolink.v1, which gets and acknowledges batches.
    """

    def __init__(self, wire: Wire, *, batching: bool) -> None:
        self._wire, self._batching = wire, batching
        self._pending: list[Entry] = []
        self._subscriptions: dict[int, Subscribed] = {}
        self._limited: dict[int, Subscribed] = {}
        self._all_of: set[int] = set()
        self._unacknowledged = 0
        self._thinned = 0
        """Messages that waited when they were thinned last: while nothing came, there is nothing to do."""
        self._held = 0
        """Bytes of messages that wait for the period of their subscription."""
        self.sent = self.dropped = 0

    def want(self, number: int, rate: float, *, latched: bool, retained: Iterable[Retained]) -> Take:
        """Add a subscription, and return the function that takes its messages; `retained` go out first.

        Args:
            number: Id of the subscription.
            rate: Highest rate in Hz, at which the newest message of each publisher is sent; 0 for every message.
            latched: True if every message counts, whatever the rate.
            retained: Messages of before.
        """
        subscription = Subscribed(number, 1 / rate if rate and not latched else 0.0, latched)
        subscription.take = self._limited_take(subscription) if subscription.period else self._plain_take(number)
        self._subscriptions[number] = subscription
        if subscription.period:
            self._limited[number] = subscription
        if latched:
            self._all_of.add(number)
        for each in retained:
            subscription.take(*each)
        return subscription.take

    def forget(self, number: int) -> Take | None:
        """Remove a subscription with what waits for it; returns its function, None if there is no such subscription."""
        subscription = self._subscriptions.pop(number, None)
        if subscription is None:
            return None
        if self._limited.pop(number, None) is not None:
            self._held -= sum(len(entry.payload) for entry in subscription.newest.values())
        self._all_of.discard(number)
        self._pending[:] = [each for each in self._pending if each[0] != number]
        self._thinned = 0
        return subscription.take

    def clear(self) -> None:
        """Drop all that waits: the time of a bag has jumped, and it is of before."""
        for each in self._limited.values():
            each.newest.clear()
        self._held = self._thinned = 0
        self._pending.clear()

    def __contains__(self, number: int) -> bool:
        return number in self._subscriptions

    def __len__(self) -> int:
        return len(self._subscriptions)

    @property
    def waiting(self) -> int:
        """Number of messages that wait."""
        return len(self._pending)

    def _plain_take(self, number: int) -> Take:
        append: Callable[[Entry], None] = self._pending.append
        # A bare tuple: making an Entry of each message would cost as much as all the rest.
        return lambda at, payload, sender: append((number, at, payload, sender))  # type: ignore[arg-type]

    def _limited_take(self, subscription: Subscribed) -> Take:
        newest, number = subscription.newest, subscription.id

        def take(at: int, payload: bytes, sender: bytes) -> None:
            gid = gid_in(sender)
            before = newest.pop(gid, None)  # so that the newest is the last
            self._held += len(payload) - (len(before.payload) if before is not None else 0)
            if self._held > MEMORY:
                self._drop_limited()
                self._held = len(payload)
            newest[gid] = Entry(number, at, payload, sender)

        return take

    def _drop_limited(self) -> None:
        """Drop all that waits for its period."""
        for each in self._limited.values():
            self.dropped += len(each.newest)
            each.newest.clear()

    def acknowledge(self) -> None:
        """Note that the client has worked on a batch."""
        self._unacknowledged = max(0, self._unacknowledged - 1)

    @property
    def is_slow(self) -> bool:
        """True while the client cannot take more."""
        return (self._batching and self._unacknowledged >= CREDIT) or self._wire.get_write_buffer_size() > BUFFERED

    def flush(self, now: float) -> None:
        """Send what waits, or keep the newest if the client is slow; `now` in seconds of a steady clock."""
        for each in self._limited.values():
            if each.newest and now >= each.due:
                self._pending.extend(each.newest.values())
                self._held -= sum(len(entry.payload) for entry in each.newest.values())
                each.newest.clear()
                each.due = max(each.due + each.period, now)
        if not self._pending or self._wire.is_closing():
            self._pending.clear()
            self._thinned = 0
            return
        if self.is_slow:
            self._thin()
            return
        self.sent += len(self._pending)
        if self._batching:
            body = batch(self._pending)
            self._wire.write(head(len(body)) + body)
            self._unacknowledged += 1
        else:
            self._wire.write(message_frames(self._pending))
        self._pending.clear()
        self._thinned = 0

    def _thin(self) -> None:
        """Keep the newest of each publisher of each topic, MOST_LATCHED of latched ones, and no more than MEMORY."""
        if len(self._pending) == self._thinned:
            return
        seen: set[tuple[int, bytes]] = set()
        left = dict.fromkeys(self._all_of, MOST_LATCHED)
        newest: list[Entry] = []
        size, before = 0, len(self._pending)
        for each in reversed(self._pending):
            number, _, payload, sender = each
            if number in left:
                left[number] -= 1
                if left[number] < 0:
                    continue
            elif (key := (number, gid_in(sender))) in seen:
                continue
            else:
                seen.add(key)
            size += len(payload)
            if size > MEMORY:
                break
            newest.append(each)
        newest.reverse()
        self._pending[:] = newest
        self._thinned = len(newest)
        self.dropped += before - len(newest)
