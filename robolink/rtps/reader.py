"""State machine of a reader: puts in order what arrives, joins fragments, and requests what is missing.

It knows no sockets, threads or clocks: `now` is an argument, in seconds of any steady clock, and what is to be sent
goes to a function. Source: RTPS 2.5, 8.4.10 to 8.4.12 (StatefulReader, WriterProxy).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from robolink.rtps.parameters import Buffer, Locator
from robolink.rtps.submessages import MOST_IN_SET, DataFrag, encode_acknack, encode_nack_frag
from robolink.rtps.types import Info, Qos
from robolink.rtps.writer import Send

MOST_WAITING = 4_096
MOST_WAITING_BYTES = 256 << 20
"""Bytes of each writer that may wait for an earlier sample. More is dropped at arrival, and requested again later."""
MOST_HELD = 1 << 30
"""Bytes that may wait at all of a participant's readers. Beyond it, the writer of which most waits loses that."""
LARGEST_SAMPLE = 1 << 30
SMALLEST_FRAGMENT = 256
"""Bytes. What claims to be larger, or comes in smaller pieces, is passed over: each piece costs some 100 bytes more."""
HIGHEST_NUMBER = 1 << 62
"""Nobody writes so many samples; from here on, sums would not fit into what is sent."""

_ASK_AFTER, _ASK_SLOWEST = 0.01, 1.0
"""Seconds until what was requested is requested again; twice as long each time, up to the second."""
_GREET_AFTER, _GREET_SLOWEST = 0.1, 30.0
"""The same for the question what a writer has at all. One that never answers does not know us as a match."""
_FRAGMENTS_LATE, _FRAGMENTS_DUE = 0.02, 0.005
"""Seconds after a fragment in which the next has to arrive; the same after a heartbeat for its sample. (Fast DDS sends
one with each fragment, so a heartbeat alone does not mean that all have left.)"""
_FEW_FRAGMENTS = 6
"""That are requested even if fewer came."""
_SAME_ANSWER = 0.005
"""Seconds in which an acknowledgement is not repeated: one for each fragment would leave no time to receive them."""

_POKE_AFTER, _POKES = 0.1, 6
"""Seconds until writers are asked for something that is expected, twice as long each time; and how often."""

Deliver = Callable[[Buffer, Info], object]


class _Parts:
    """A sample of which fragments have arrived."""

    __slots__ = ("ask_at", "delay", "fragment_size", "had", "info", "pieces", "size", "total", "touched", "until")

    def __init__(self, info: Info, fragment_size: int, size: int) -> None:
        self.info, self.fragment_size, self.size = info, fragment_size, size
        self.total = -(-size // fragment_size)
        # Pieces, not a buffer of the size that the writer claims: a message costs no more memory than it has bytes.
        self.pieces: dict[int, bytes] = {}
        self.ask_at = 0.0
        """Before this, missing fragments may still be under way."""
        self.delay = _FRAGMENTS_LATE
        self.until = self.total
        """Last of the fragments that are under way: once it is here, what is missing of them was lost."""
        self.had: int | None = None
        """Number of those that were here at the last request; None: there was not any."""
        self.touched = 0.0
        """When the last fragment came."""

    @property
    def grows(self) -> bool:
        """True if fragments came since the last request, if there was one."""
        return self.had is None or len(self.pieces) > self.had

    def missing(self) -> list[int]:
        """Return the first missing fragment, and those behind it that one request can name."""
        first = next((n for n in range(1, self.total + 1) if n not in self.pieces), self.total + 1)
        return [n for n in range(first, min(first + MOST_IN_SET, self.total + 1)) if n not in self.pieces]


class Room:
    """Room for what waits at all readers of a participant together, for an earlier sample or for more fragments."""

    def __init__(self, most: int = MOST_HELD) -> None:
        self.used = 0
        self._most = most
        self._holders: set[WriterProxy] = set()

    def take(self, proxy: WriterProxy, size: int) -> bool:
        """Return whether so many bytes more may wait of a writer; they are counted then."""
        if self.used + size > self._most and not self._clear_for(proxy, size):
            return False
        self.used += size
        proxy.bytes += size
        self._holders.add(proxy)
        return True

    def give_back(self, proxy: WriterProxy, size: int) -> None:
        """Count bytes of a writer that wait no longer."""
        self.used -= size
        proxy.bytes -= size
        if not proxy.bytes:
            self._holders.discard(proxy)

    def _clear_for(self, proxy: WriterProxy, size: int) -> bool:
        # Who fills the room with what will never be whole must not keep the others out.
        largest = max(self._holders, key=lambda each: each.bytes, default=proxy)
        if largest is proxy:
            return False
        largest.waiting.clear()  # what is reliable is requested again
        largest.parts.clear()
        self.give_back(largest, largest.bytes)
        return self.used + size <= self._most


class WriterProxy:
    """A writer as a reader knows it."""

    __slots__ = (
        "acked",
        "acked_at",
        "address",
        "base",
        "bytes",
        "delay",
        "due",
        "guid",
        "head",
        "is_known",
        "last",
        "next",
        "parts",
        "reliable",
        "requested",
        "requested_at",
        "waiting",
    )

    def __init__(self, guid: bytes, address: Locator, head: bytes, reliable: bool, base: int) -> None:
        self.guid, self.address, self.head, self.reliable = guid, address, head, reliable
        self.base = base
        """With which a reader that has heard nothing of it asks what there is."""
        self.next = 1
        """Number of the sample that is delivered next."""
        self.last = 0
        """The highest number that it has announced or sent."""
        self.is_known = False
        """A heartbeat of it has arrived."""
        self.waiting: dict[int, tuple[Buffer, Info] | None] = {}
        """Samples that arrived too early; None: one that will not come."""
        self.parts: dict[int, _Parts] = {}
        self.bytes = 0
        """Of `waiting` and `parts`."""
        self.acked, self.acked_at = 0, -math.inf
        """Before which number all was acknowledged, and when."""
        self.requested, self.requested_at = 0, -math.inf
        """The highest number that was requested, and when."""
        self.delay = _GREET_AFTER
        self.due = math.inf

    @property
    def is_read(self) -> bool:
        """True if all has arrived that it has announced."""
        return self.is_known and self.next > self.last


class StatefulReader:
    """A reader: each writer's samples come out in order and once; of reliable ones all, if the reader is reliable."""

    def __init__(
        self,
        guid: bytes,
        qos: Qos,
        send: Send,
        deliver: Deliver,
        room: Room | None = None,
        largest: int = LARGEST_SAMPLE,
    ) -> None:
        """Make a reader without writers.

        Args:
            guid: its own.
            qos: what it requests.
            send: gets what is to be sent.
            deliver: gets the samples.
            room: what may wait, together with the participant's other readers.
            largest: bytes of a sample; larger ones are passed over.
        """
        self.guid, self.qos = guid, qos
        self.entity = guid[12:]
        self.writers: dict[bytes, WriterProxy] = {}
        self.due = math.inf
        """When `tick` is to be called."""
        self._send, self._deliver_next = send, deliver
        self._poke_at, self._poked = math.inf, 0
        self._serial = 0
        """Of the last request. It goes on when a writer comes back: a Fast DDS that had not missed us meanwhile ignores
        what does not count up, and each greeting with a small number came twice as late as the one before."""
        self._room = Room() if room is None else room
        self._largest = largest

    # Writers

    def match(self, now: float, guid: bytes, address: Locator, head: bytes, *, reliable: bool, base: int) -> None:
        """Add a writer, and ask it what it has.

        Args:
            now: seconds.
            guid: its own.
            address: where it receives.
            head: with which datagrams to it begin: the header, and INFO_DST.
            reliable: it offers reliability.
            base: of the ACKNACK that asks: that which its vendor answers at once.
        """
        proxy = WriterProxy(guid, address, head, reliable and self.qos.reliable, base)
        self.writers[guid] = proxy
        if proxy.reliable:
            self._greet(now, proxy)

    def unmatch(self, guid: bytes) -> bool:
        """Forget a writer. Returns whether it was known."""
        proxy = self.writers.pop(guid, None)
        if proxy is None:
            return False
        self._room.give_back(proxy, proxy.bytes)
        return True

    def expect(self, now: float) -> None:
        """Ask the writers what they have if nothing comes of them for a while.

        Of a lost sample behind which nothing comes a reader hears only when its writer says what it has, and a Fast DDS
        does so every 3 s.
        """
        self._poke_at, self._poked = now + _POKE_AFTER, 0
        self.due = min(self.due, self._poke_at)

    def _poke(self, now: float) -> None:
        for proxy in self.writers.values():
            if proxy.reliable and proxy.is_known:
                self._acknack(proxy, proxy.base, [], final=False)
        self._poked += 1
        self._poke_at = now + _POKE_AFTER * 2**self._poked if self._poked < _POKES else math.inf

    def _deliver(self, payload: Buffer, info: Info) -> None:
        self._poke_at = math.inf
        self._deliver_next(payload, info)

    # What writers send

    def on_data(self, now: float, guid: bytes, payload: Buffer | None, info: Info) -> None:
        """Take a sample; None: there is none with this number for readers."""
        proxy = self.writers.get(guid)
        number = info.number
        if proxy is None or number >= HIGHEST_NUMBER:
            return
        if number == proxy.next or (number > proxy.next and not proxy.reliable):
            proxy.next = number + 1
            proxy.last = max(proxy.last, number)
            if payload is not None:
                self._deliver(payload, info)
            if proxy.waiting or proxy.parts:
                self._advance(proxy)
        elif number > proxy.next and number not in proxy.waiting:
            self._hold(now, proxy, payload, info)

    def _hold(self, now: float, proxy: WriterProxy, payload: Buffer | None, info: Info) -> None:
        """Keep a sample that came too early, and request what is missing before it."""
        size = len(payload) if payload is not None else 0
        is_crowded = len(proxy.waiting) >= MOST_WAITING or proxy.bytes + size > MOST_WAITING_BYTES
        if not is_crowded and self._room.take(proxy, size):
            proxy.waiting[info.number] = None if payload is None else (payload, info)
        is_hole = info.number > proxy.last + 1
        proxy.last = max(proxy.last, info.number)
        if not proxy.is_known and not self.qos.transient_local:
            # What was before it may not be meant for this reader: only a heartbeat says where it begins.
            if not proxy.requested:
                proxy.requested = 1
                self._greet(now, proxy)
        elif is_hole or now >= proxy.due:
            # At once, not when the next heartbeat comes: Fast DDS's may be 3 s away.
            self._request(now, proxy)
        if proxy.parts:
            self._request_fragments(now, proxy, ended=info.number)

    def on_fragments(self, now: float, guid: bytes, fragments: DataFrag, info: Info) -> None:
        """Take fragments of a sample."""
        proxy = self.writers.get(guid)
        number = info.number
        if proxy is None or number < proxy.next or number in proxy.waiting or number >= HIGHEST_NUMBER:
            return
        parts = proxy.parts.get(number) or self._begin(now, proxy, fragments, info)
        if parts is None or (parts.fragment_size, parts.size) != (fragments.fragment_size, fragments.sample_size):
            return
        self._add(proxy, parts, fragments)
        if len(parts.pieces) == parts.total:
            self._forget(proxy, number)
            payload = b"".join([parts.pieces[n] for n in range(1, parts.total + 1)])
            self.on_data(now, guid, payload, parts.info)
        elif proxy.reliable:
            parts.touched = now
            if parts.grows:
                parts.ask_at = now + _FRAGMENTS_LATE
                if parts.until in parts.pieces:
                    self._nack(now, proxy, number, parts)
            self._wake(proxy, parts.ask_at)

    def _add(self, proxy: WriterProxy, parts: _Parts, fragments: DataFrag) -> None:
        size, payload = parts.fragment_size, fragments.payload
        if proxy.bytes > MOST_WAITING_BYTES and fragments.number != proxy.next:
            return
        # The last in the row begins inside the sample: `parse` has seen to it.
        for at in range(0, len(payload), size):
            fragment = fragments.first + at // size
            piece = payload[at : at + size]
            if fragment not in parts.pieces and self._room.take(proxy, len(piece)):
                parts.pieces[fragment] = bytes(piece)

    def _begin(self, now: float, proxy: WriterProxy, fragments: DataFrag, info: Info) -> _Parts | None:
        """Return room for the fragments of another sample; None if there is not any."""
        size, number = fragments.sample_size, info.number
        is_small = fragments.fragment_size < min(SMALLEST_FRAGMENT, size)
        if size > self._largest or is_small:
            # As if it did not exist: else it would be requested for ever, and nothing behind it would be delivered.
            self.on_data(now, proxy.guid, None, info)
            return None
        is_crowded = number != proxy.next and proxy.bytes + size > MOST_WAITING_BYTES
        if is_crowded or len(proxy.parts) >= MOST_WAITING:
            return None
        if not proxy.reliable:
            # One newer than two that are not whole: what is missing of the oldest will hardly come any more.
            for old in sorted(proxy.parts)[:-1]:
                self._forget(proxy, old)
        is_hole = number > proxy.last + 1
        proxy.last = max(proxy.last, number)
        proxy.parts[number] = parts = _Parts(info, fragments.fragment_size, size)
        if proxy.reliable and is_hole and (proxy.is_known or self.qos.transient_local):
            self._request(now, proxy)
        return parts

    def on_heartbeat(self, now: float, guid: bytes, first: int, last: int, *, final: bool) -> None:
        """Learn what a writer has: the samples from `first` to `last`; not final: it expects an answer."""
        proxy = self.writers.get(guid)
        if proxy is None or not proxy.reliable or last >= HIGHEST_NUMBER:
            return
        if not proxy.is_known:
            proxy.is_known = True
            proxy.requested, proxy.delay, proxy.due = 0, _ASK_AFTER, math.inf
        if first > proxy.next:
            self._skip(proxy, first)
        proxy.last = max(proxy.last, last)
        self._request(now, proxy, answer=not final)
        for number, parts in proxy.parts.items():
            if number <= last and parts.grows:
                parts.ask_at = min(parts.touched + _FRAGMENTS_LATE, now + _FRAGMENTS_DUE)
                self._wake(proxy, parts.ask_at)

    def on_gap(self, now: float, guid: bytes, first: int, base: int, others: Sequence[int]) -> None:
        """Learn that samples will not come: those from `first` to `base` - 1, and the others."""
        proxy = self.writers.get(guid)
        if proxy is None or not proxy.reliable or base >= HIGHEST_NUMBER:
            return
        if first <= proxy.next < base:
            self._skip(proxy, base)
        # It may claim 2^63 of them; what cannot be requested yet need not be remembered.
        end = proxy.next + MOST_IN_SET
        for number in (*range(max(first, proxy.next), min(base, end)), *others):
            if proxy.next <= number < end and number not in proxy.waiting:
                self._forget(proxy, number)
                proxy.waiting[number] = None
        self._advance(proxy)

    # In order

    def _skip(self, proxy: WriterProxy, first: int) -> None:
        """Go on with a number: what is missing before it will not come."""
        for number in sorted(number for number in proxy.waiting if number < first):
            self._release(proxy, number)
        proxy.next = first
        self._advance(proxy)

    def _advance(self, proxy: WriterProxy) -> None:
        """Deliver what waited only for the samples before it."""
        while proxy.next in proxy.waiting:
            proxy.next += 1
            self._release(proxy, proxy.next - 1)
        for number in [number for number in proxy.parts if number < proxy.next]:
            self._forget(proxy, number)
        if proxy.is_known:
            proxy.delay = _ASK_AFTER
            if proxy.next > proxy.last:
                proxy.due = math.inf

    def _release(self, proxy: WriterProxy, number: int) -> None:
        item = proxy.waiting.pop(number)
        if item is not None:
            self._room.give_back(proxy, len(item[0]))
            self._deliver(*item)

    def _forget(self, proxy: WriterProxy, number: int) -> None:
        parts = proxy.parts.pop(number, None)
        if parts is not None:
            self._room.give_back(proxy, sum(map(len, parts.pieces.values())))

    # Requests

    def tick(self, now: float) -> None:
        """Request again what was requested and has not come."""
        if now < self.due:
            return
        if now >= self._poke_at:
            self._poke(now)
        due = self._poke_at
        for proxy in self.writers.values():
            if now >= proxy.due:
                proxy.due = math.inf
                if proxy.is_known:
                    self._request(now, proxy, again=True)
                else:
                    self._greet(now, proxy)
                self._request_fragments(now, proxy)
            if proxy.due < due:
                due = proxy.due
        self.due = due

    def _wake(self, proxy: WriterProxy, when: float) -> None:
        proxy.due = min(proxy.due, when)
        self.due = min(self.due, proxy.due)

    def _greet(self, now: float, proxy: WriterProxy) -> None:
        """Ask a writer what it has (a "preemptive" ACKNACK), and again until it says so."""
        self._acknack(proxy, proxy.base, [], final=False)
        self._wake(proxy, now + proxy.delay)
        proxy.delay = min(2 * proxy.delay, _GREET_SLOWEST)

    def _request(self, now: float, proxy: WriterProxy, *, answer: bool = False, again: bool = False) -> None:
        """Request what is missing, unless it was requested just now.

        Args:
            now: seconds.
            proxy: of whom.
            answer: acknowledge what is there if nothing is missing.
            again: also what was requested before.
        """
        missing = self._missing(proxy)
        # Whoever expects an answer is there, and has nothing under way that was requested long ago.
        again = again or now >= proxy.due or (answer and now >= proxy.requested_at + _ASK_AFTER)
        if missing and (again or missing[-1] > proxy.requested):
            proxy.requested, proxy.requested_at = missing[-1], now
            self._acknack(proxy, proxy.next, missing, final=False)
            self._wake(proxy, now + proxy.delay)
            proxy.delay = min(2 * proxy.delay, _ASK_SLOWEST)
        elif answer and not missing and (proxy.next != proxy.acked or now >= proxy.acked_at + _SAME_ANSWER):
            proxy.acked, proxy.acked_at = proxy.next, now
            self._acknack(proxy, proxy.next, [], final=True)

    def _missing(self, proxy: WriterProxy) -> list[int]:
        """Return the samples of which nothing is there, as many as one request can name."""
        end = min(proxy.last + 1, proxy.next + MOST_IN_SET)
        return [n for n in range(proxy.next, end) if n not in proxy.waiting and n not in proxy.parts]

    def _next_serial(self) -> int:
        self._serial = (self._serial + 1) & 0x7FFFFFFF
        return self._serial

    def _acknack(self, proxy: WriterProxy, base: int, missing: Sequence[int], *, final: bool) -> None:
        raw = encode_acknack(self.entity, proxy.guid[12:], base, missing, self._next_serial(), final=final)
        self._send(proxy.address, [proxy.head, raw], 0.0)

    def _request_fragments(self, now: float, proxy: WriterProxy, ended: int = 0) -> None:
        """Request missing fragments that should have come.

        Args:
            now: seconds.
            proxy: of whom.
            ended: of samples up to this number, no fragment is under way any more, unless it was requested.
        """
        if not proxy.reliable:
            return
        for number, parts in proxy.parts.items():
            if now >= parts.ask_at or (number <= ended and parts.had is None):
                self._nack(now, proxy, number, parts)
            self._wake(proxy, parts.ask_at)

    def _nack(self, now: float, proxy: WriterProxy, number: int, parts: _Parts) -> None:
        came = len(parts.pieces) - (parts.had or 0)
        # Not many more than came the last time: they come in one burst, for which the socket's buffer may have no room.
        missing = parts.missing()[: max(came, _FEW_FRAGMENTS)]
        raw = encode_nack_frag(self.entity, proxy.guid[12:], number, missing, self._next_serial())
        self._send(proxy.address, [proxy.head, raw], 0.0)
        # As long as each request brings something, the next does not wait longer.
        parts.delay = _FRAGMENTS_LATE if parts.grows else min(2 * parts.delay, _ASK_SLOWEST)
        parts.until, parts.had = missing[-1], len(parts.pieces)
        parts.ask_at = now + parts.delay
