"""State machine of a writer: what it keeps, who has acknowledged what, and what is sent again.

It knows no sockets, threads or clocks: `now` is an argument, in seconds of any steady clock, and what is to be sent
goes to a function. Source: RTPS 2.5, 8.4.7 to 8.4.9 (StatefulWriter, ReaderProxy).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from robolink.rtps.ids import UNKNOWN_ENTITY
from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.submessages import (
    Inline,
    encode_data,
    encode_data_frag,
    encode_gap,
    encode_heartbeat,
    encode_info_timestamp,
    encode_inline,
)
from robolink.rtps.types import Qos

Send = Callable[[Locator, list[Buffer], float], object]
"""Takes the pieces of a datagram for an address, and the seconds of a pause behind it; 0.0 if it is not one of many."""

FRAGMENT = 63 * 1024
"""Bytes of a fragment, and of the largest sample that is sent whole: a datagram of UDP has room for 65,507."""
FAR_FRAGMENT = 1200
"""The same for other machines: what fits into one frame, also through a tunnel. With a larger datagram each lost frame
costs all the others, 44 of them for one of 63 kB, and their rests fill the receiving kernel's memory for 30 s."""
MOST_STORED = 5_000
MOST_STORED_BYTES = 256 << 20
"""Most bytes of a writer that keeps all. Then the oldest samples go, as with a depth: readers that did not have
them get a GAP. So a reader that stands still costs no more than this, and `put` never waits."""

_REPAIRED_DEPTHS, _MOST_REPAIRED, _MOST_REPAIRED_BYTES = 10, 100, 8 << 20
"""Times its depth that a volatile writer keeps of what some have not acknowledged, and at most, in samples and in
bytes. The depth says what a program that is slow gets; datagrams that were lost in a row of samples are another matter.
"""

_HEARTBEAT_AFTER, _HEARTBEAT_SLOWEST = 0.05, 1.0
"""Seconds until a reader that has not acknowledged is reminded; twice as long each time, up to the second."""
_BEAT_EVERY, _BEAT_LATE = 0.008, 0.02
"""Seconds between heartbeats that go with samples, and until one is sent for a sample that left without. Fast DDS
answers 5 ms after a heartbeat, and begins to wait anew with each: with one for each of 1,000 samples a second it would
acknowledge nothing, nor request what it lost, before there is a pause."""
_REMIND_SAMPLES, _REMIND_BYTES = 32, 256 << 10
"""Samples and bytes that may be under way before a heartbeat that goes with a sample requests an acknowledgement."""
_REPAIR_BYTES = 8 << 20
"""Most bytes that answer one ACKNACK; the heartbeat behind it makes the reader request the rest."""
_REPAIR_PAUSE, _REPAIR_RATE = 0.01, 100e6
"""A large sample that was sent again is not sent once more before it can have arrived, at this many bytes a second. Nor
does a reader get more again than that: with a few bytes it could have us send megabytes without end."""
_PAUSE, _ROUGH_PAUSE = 30e-6, 150e-6
"""Pauses among fragments: for readers of which one is reliable, and for others, which a lost one costs the sample. On a
busy machine a real node got 110 of 120 BEST_EFFORT images of 1 MB, 30 a second, with the short pause, 116 with the long
one. That makes a round trip of such an image 2 ms longer, a third."""
_BUNDLE = 16 << 10
"""Bytes of small samples, with their headers, that go into one datagram when several are sent again."""


class Change(NamedTuple):
    """A sample that a writer keeps."""

    number: int
    payload: Buffer | None
    inline: bytes
    timestamp: int
    is_key: bool
    is_stored: bool
    """For readers that come later; else only until all have acknowledged it."""
    ends: float = math.inf
    """When its lifespan is over, by the clock of `now`."""

    @property
    def size(self) -> int:
        """Bytes of the payload."""
        return len(self.payload) if self.payload is not None else 0


def fragment_of(address: Locator) -> int:
    """Return the bytes of a fragment for an address."""
    return FRAGMENT if address[0].startswith("127.") else FAR_FRAGMENT


class ReaderProxy:
    """A reader as a writer knows it."""

    __slots__ = ("acked", "address", "first", "guid", "head", "reliable", "repaired", "repaired_until", "serial")

    def __init__(self, guid: bytes, address: Locator, head: bytes, reliable: bool, first: int) -> None:
        self.guid, self.address, self.head, self.reliable = guid, address, head, reliable
        self.first = first
        """Number of the first sample that is meant for it."""
        self.acked = first
        """It has acknowledged all before this."""
        self.serial: int | None = None
        """Of its last ACKNACK; None: there was not any."""
        self.repaired: dict[int, float] = {}
        """Large samples that were sent again: until when they may be under way."""
        self.repaired_until = 0.0
        """When all that was sent again has left, at _REPAIR_RATE."""


class _Route:
    """The readers behind one address: a sample goes there once."""

    __slots__ = ("address", "entity", "first", "head", "proxies", "reliable")

    def __init__(self, proxies: list[ReaderProxy]) -> None:
        self.proxies = proxies
        self.address, self.head = proxies[0].address, proxies[0].head
        # One datagram to "all readers that are matched with this writer": one each would be delivered to all of them by
        # some, and costs each sample's size again.
        self.entity = proxies[0].guid[12:] if len(proxies) == 1 else UNKNOWN_ENTITY
        self.reliable = [proxy for proxy in proxies if proxy.reliable]
        self.first = max((proxy.first for proxy in self.reliable), default=0)


class StatefulWriter:
    """A writer, reliable or best-effort, volatile or with samples for readers that come later."""

    def __init__(self, guid: bytes, qos: Qos, send: Send, most: int = MOST_STORED) -> None:
        """Make a writer without readers.

        Args:
            guid: its own.
            qos: what it offers.
            send: gets what is to be sent.
            most: samples that it keeps at most where it keeps all.
        """
        self.guid, self.qos = guid, qos
        self.entity = guid[12:]
        self.readers: dict[bytes, ReaderProxy] = {}
        self.last = 0
        """Number of the last sample."""
        self.due = math.inf
        """When `tick` is to be called."""
        self.lost = 0
        """Samples that were dropped because MOST_STORED or MOST_STORED_BYTES was reached."""
        self._send = send
        self._history: dict[int, Change] = {}
        """Rising by number; there may be holes."""
        self._stored_bytes = 0
        self._passing = 0
        """Samples in the history that are kept only until all have acknowledged them."""
        self._most = most
        self._serial = 0
        self._delay = _HEARTBEAT_AFTER
        self._under_way = self._bytes_under_way = 0
        """Since the last heartbeat that requested an acknowledgement."""
        self._beaten_at = -math.inf
        """When the last heartbeat for everybody was sent."""
        self._routes: dict[tuple[Locator, bytes], _Route] = {}
        """By address and participant."""

    @property
    def first(self) -> int:
        """Number of the first sample that is still there; `last` + 1 if there is none."""
        return next(iter(self._history), self.last + 1)

    # Readers

    def match(self, now: float, guid: bytes, address: Locator, head: bytes, *, reliable: bool, wants_old: bool) -> None:
        """Add a reader.

        Args:
            now: seconds.
            guid: its own.
            address: where it receives.
            head: with which datagrams to it begin: the header, and INFO_DST.
            reliable: it requests reliability.
            wants_old: it requests the samples that are kept for readers that come later.
        """
        self.unmatch(guid)
        self._trim(now)
        first = 1 if wants_old and self.qos.transient_local else self.last + 1
        proxy = ReaderProxy(guid, address, head, reliable and self.qos.reliable, first)
        self.readers[guid] = proxy
        self._reroute(proxy, came=True)
        if proxy.reliable:
            self._heartbeat(proxy)
            self._expect(now)
        elif first <= self.last:
            self._resend(now, proxy, [change for change in self._history.values() if change.is_stored])

    def unmatch(self, guid: bytes) -> bool:
        """Forget a reader. Returns whether it was known."""
        proxy = self.readers.pop(guid, None)
        if proxy is None:
            return False
        self._reroute(proxy, came=False)
        self._forget_acknowledged()
        return True

    def _reroute(self, proxy: ReaderProxy, *, came: bool) -> None:
        place = (proxy.address, proxy.guid[:12])
        before = self._routes.get(place)
        proxies = [each for each in before.proxies if each is not proxy] if before else []
        if came:
            proxies.append(proxy)
        if proxies:
            self._routes[place] = _Route(proxies)
        else:
            del self._routes[place]

    # Samples

    def put(
        self,
        now: float,
        payload: Buffer | None,
        inline: Inline | None = None,
        timestamp: int = 0,
        *,
        is_key: bool = False,
        is_stored: bool | None = None,
    ) -> int:
        """Send a sample to all readers, and keep it for as long as some may need it.

        Args:
            now: seconds.
            payload: serialized, with its header of 4 bytes.
            inline: what goes with it.
            timestamp: nanoseconds since 1970; 0: unknown.
            is_key: the payload is a key: of something that is gone.
            is_stored: whether it is kept for readers that come later; if not said, the writer's durability decides.

        Returns:
            Its number.
        """
        self.last = number = self.last + 1
        stored = self.qos.transient_local if is_stored is None else is_stored
        ends = math.inf if self.qos.lifespan is None else now + self.qos.lifespan
        change = Change(number, payload, encode_inline(inline) if inline else b"", timestamp, is_key, stored, ends)
        reliable = any(route.reliable for route in self._routes.values())
        if stored or reliable:
            self._history[number] = change
            self._stored_bytes += change.size
            self._passing += not stored
            self._trim(now)
        if self._routes:
            self._under_way += 1
            self._bytes_under_way += change.size
            beats = now >= self._beaten_at + _BEAT_EVERY
            final = not beats or not self._reminds()
            for route in self._routes.values():
                beat = self._route_beats(now, route, final=final) if beats and route.reliable else b""
                pause = _PAUSE if route.reliable else _ROUGH_PAUSE
                self._send_change(route.address, route.head, route.entity, change, beat, pause=pause)
            if reliable:
                self._expect(now, _HEARTBEAT_AFTER if beats else _BEAT_LATE)
        return number

    def discard(self, number: int) -> None:
        """Drop a kept sample that something newer replaces: nobody gets it any more."""
        self._drop(number)

    def _drop(self, number: int) -> None:
        change = self._history.pop(number, None)
        if change is not None:
            self._stored_bytes -= change.size
            self._passing -= not change.is_stored

    def _trim(self, now: float) -> None:
        """Drop what is too old, or too much."""
        if self.qos.lifespan is not None:
            while self._history and self._history[self.first].ends <= now:
                self._drop(self.first)
        if depth := self.qos.depth:
            most = depth if self.qos.transient_local else max(depth, min(_REPAIRED_DEPTHS * depth, _MOST_REPAIRED))
            while (size := len(self._history)) > most or (size > depth and self._stored_bytes > _MOST_REPAIRED_BYTES):
                self._drop(self.first)
            return
        while len(self._history) > self._most or (self._stored_bytes > MOST_STORED_BYTES and len(self._history) > 1):
            self._drop(next(iter(self._history)))
            self.lost += 1

    def _reminds(self) -> bool:
        """Return whether the heartbeat that goes with a sample requests an acknowledgement.

        Most do not: a reader that lacks something says so anyway, and at 1,000 samples a second an answer to each would
        cost both ends more than the samples do.
        """
        if self._under_way < _REMIND_SAMPLES and self._bytes_under_way < _REMIND_BYTES:
            return False
        self._under_way = self._bytes_under_way = 0
        return True

    def _send_change(
        self,
        address: Locator,
        head: bytes,
        entity: bytes,
        change: Change,
        beats: bytes,
        fragments: Sequence[int] | None = None,
        pause: float = _PAUSE,
    ) -> None:
        """Send a sample, whole or in fragments (all, or those), and heartbeats behind it."""
        stamp = encode_info_timestamp(change.timestamp)
        payload, size = change.payload, fragment_of(address)
        if payload is None or len(payload) <= size:
            data = encode_data(entity, self.entity, change.number, payload, change.inline, is_key=change.is_key)
            self._send(address, [head, stamp, data, beats], 0.0)
            return
        total = -(-len(payload) // size)
        chosen = range(1, total + 1) if fragments is None else [n for n in fragments if 0 < n <= total]
        last = chosen[-1] if chosen else 0
        for fragment in chosen:
            pieces = encode_data_frag(
                entity, self.entity, change.number, fragment, size, payload, change.inline, is_key=change.is_key
            )
            self._send(address, [head, stamp, *pieces, beats if fragment == last else b""], pause)

    # Heartbeats

    def _beat(self, entity: bytes, first: int, *, final: bool) -> bytes:
        self._serial += 1
        return encode_heartbeat(
            entity, self.entity, max(self.first, first), self.last, self._serial & 0x7FFFFFFF, final=final
        )

    def _route_beats(self, now: float, route: _Route, *, final: bool) -> bytes:
        """Return the heartbeats for the readers behind an address: one, unless they may have different samples."""
        self._beaten_at = now
        if len(route.reliable) == 1:
            return self._beat(route.reliable[0].guid[12:], route.first, final=final)
        if self.first >= route.first:
            return self._beat(UNKNOWN_ENTITY, 0, final=final)
        return b"".join(self._beat(proxy.guid[12:], proxy.first, final=final) for proxy in route.reliable)

    def _heartbeat(self, proxy: ReaderProxy, *, final: bool = False) -> None:
        self._send(proxy.address, [proxy.head, self._beat(proxy.guid[12:], proxy.first, final=final)], 0.0)

    def _expect(self, now: float, after: float = _HEARTBEAT_AFTER) -> None:
        """See to it that readers that do not acknowledge are reminded."""
        if not self._behind():
            return
        if self.due == math.inf:
            self._delay = _HEARTBEAT_AFTER
            self.due = now + after
        elif after < _HEARTBEAT_AFTER:
            self.due = min(self.due, now + after)

    def _behind(self) -> bool:
        return any(proxy.acked <= self.last for route in self._routes.values() for proxy in route.reliable)

    def tick(self, now: float) -> None:
        """Remind readers that have not acknowledged everything. With none, nothing is sent: an idle writer is quiet."""
        if now < self.due:
            return
        if now < self._beaten_at + _BEAT_LATE:  # samples come in a row, and heartbeats with them
            self.due = self._beaten_at + _BEAT_LATE
            return
        self.due = math.inf
        for route in self._routes.values():
            if any(proxy.acked <= self.last for proxy in route.reliable):
                self._send(route.address, [route.head, self._route_beats(now, route, final=False)], 0.0)
                self._delay = min(2 * self._delay, _HEARTBEAT_SLOWEST)
                self.due = now + self._delay

    # What readers send

    def on_acknack(
        self, now: float, guid: bytes, base: int, missing: Sequence[int], serial: int, *, final: bool
    ) -> None:
        """Send what a reader requests again, and forget what all have."""
        proxy = self.readers.get(guid)
        # The same serial number is the same datagram, that came twice. A smaller one is not old: a reader that lost
        # sight of us for a while begins anew.
        if proxy is None or not proxy.reliable or serial == proxy.serial:
            return
        proxy.serial = serial
        self._delay = _HEARTBEAT_AFTER  # it is there: what it lacks now was lost, or never left
        if proxy.acked < base <= self.last + 1:
            proxy.acked = base
            proxy.repaired = {number: until for number, until in proxy.repaired.items() if number >= base}
            self._forget_acknowledged()
        requested = [number for number in missing if 0 < number <= self.last]
        if requested:
            self._repair(now, proxy, requested)
        elif not final:
            # It asks what there is, perhaps before it has heard any heartbeat.
            self._heartbeat(proxy, final=proxy.acked > self.last)

    def on_nack_frag(self, now: float, guid: bytes, number: int, missing: Sequence[int]) -> None:
        """Send fragments of a sample again."""
        proxy = self.readers.get(guid)
        if proxy is None or not proxy.reliable:
            return
        change = self._history.get(number)
        if number > self.last:
            return
        if change is None or number < proxy.first:
            self._tell_gone(proxy, [number])
        elif missing and self._may_repair(now, proxy, len(missing) * fragment_of(proxy.address)):
            beat = self._beat(guid[12:], proxy.first, final=False)
            self._send_change(proxy.address, proxy.head, guid[12:], change, beat, missing)
        self._expect(now)

    def _repair(self, now: float, proxy: ReaderProxy, requested: Sequence[int]) -> None:
        again: list[Change] = []
        gone: list[int] = []
        size = 0
        for number in requested:
            change = self._history.get(number)
            if change is None or number < proxy.first:
                gone.append(number)
            elif now >= proxy.repaired.get(number, 0.0) and (not again or size + change.size <= _REPAIR_BYTES):
                if not self._may_repair(now, proxy, change.size):
                    break
                again.append(change)
                size += change.size
                if change.size > fragment_of(proxy.address):
                    proxy.repaired[number] = now + _REPAIR_PAUSE + change.size / _REPAIR_RATE
        if gone:
            self._tell_gone(proxy, gone)
        self._resend(now, proxy, again)
        self._expect(now)

    def _may_repair(self, now: float, proxy: ReaderProxy, size: int) -> bool:
        """Return whether a reader may get so many bytes again: what it does not get, it requests again."""
        until = max(proxy.repaired_until, now)
        if until - now > _REPAIR_BYTES / _REPAIR_RATE:
            return False
        proxy.repaired_until = until + size / _REPAIR_RATE
        return True

    def _resend(self, now: float, proxy: ReaderProxy, changes: Sequence[Change]) -> None:
        """Send samples again, several small ones in a datagram, and a heartbeat behind them that requests an answer."""
        entity, most = proxy.guid[12:], min(_BUNDLE, fragment_of(proxy.address))
        bundle: list[Buffer] = []
        size = 0
        for change in changes:
            if change.size > most:
                self._flush(proxy, bundle)
                bundle, size = [], 0
                pause = _PAUSE if proxy.reliable else _ROUGH_PAUSE
                self._send_change(proxy.address, proxy.head, entity, change, b"", pause=pause)
                continue
            stamp = encode_info_timestamp(change.timestamp)
            data = encode_data(entity, self.entity, change.number, change.payload, change.inline, is_key=change.is_key)
            if bundle and size + len(stamp) + len(data) > most:
                self._flush(proxy, bundle)
                bundle, size = [], 0
            bundle += (stamp, data)
            size += len(stamp) + len(data)
        if proxy.reliable and changes:
            bundle.append(self._beat(entity, proxy.first, final=False))
        self._flush(proxy, bundle)

    def _flush(self, proxy: ReaderProxy, bundle: Sequence[Buffer]) -> None:
        if bundle:
            self._send(proxy.address, [proxy.head, *bundle], 0.0)

    def _tell_gone(self, proxy: ReaderProxy, numbers: Sequence[int]) -> None:
        """Announce to a reader that samples will not come; the numbers are rising and span at most 256."""
        first = max(self.first, proxy.first)
        if numbers[0] < first:
            # The heartbeat says where the samples begin: Fast DDS's readers need it so on links that lose frames.
            self._heartbeat(proxy)
            numbers = [number for number in numbers if number >= first]
        if numbers:
            self._send_gap(proxy, numbers)

    def _send_gap(self, proxy: ReaderProxy, numbers: Sequence[int]) -> None:
        base = numbers[0] + 1
        rest = 1
        while rest < len(numbers) and numbers[rest] == base:
            base += 1
            rest += 1
        gap = encode_gap(proxy.guid[12:], self.entity, numbers[0], base, numbers[rest:])
        self._send(proxy.address, [proxy.head, gap], 0.0)

    def _forget_acknowledged(self) -> None:
        """Drop the samples that are kept only until every reader has them."""
        if not self._passing:
            return
        acked = min((proxy.acked for route in self._routes.values() for proxy in route.reliable), default=self.last + 1)
        gone = []
        for number, change in self._history.items():
            if number >= acked:
                break
            if not change.is_stored:
                gone.append(number)
        for number in gone:
            self._drop(number)
