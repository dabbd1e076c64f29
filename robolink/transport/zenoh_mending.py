"""Sinks for messages that come late or twice: one puts them in order again, one passes each on once."""

from __future__ import annotations

import struct
import threading
from threading import get_ident
from typing import Any

from robolink.system import clocks
from robolink.transport.base import Sample, Sink
from robolink.wire import fields_of

MOST_SENDERS = 1000
"""Most publishers of a topic whose last numbers are known."""

MOST_HELD = 1 << 24
"""Most bytes that wait behind gaps; a publisher keeps no more of them either."""


_staying: set[int] = set()
"""Idents of Zenoh's threads that keep their Python thread state."""


def stay() -> None:
    """Keep the Python thread state of the calling thread, which is Zenoh's, between two messages.

    Otherwise each message makes a state and frees it again, and with it the stack of the first Python function: 20 us.
    """
    import ctypes  # late: only sessions that leave the machine need it

    _staying.add(get_ident())
    ctypes.pythonapi.PyGILState_Ensure()  # never released: Zenoh's few threads are there until the process ends


class Mending:
    """Sink of a RELIABLE topic that knows the number of each publisher's last message.

    While publishers are asked (from `begin` to `end`), it holds back what comes behind a gap; `take` fills the gap.
    What has been filled is not delivered again, however late the lost link brings it. A publisher whose last message
    came behind a gap when nobody asked is thinned by `limits`, or its link is too slow: nothing of it has to wait.
    """

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._lock = threading.RLock()  # re-entrant: a signal handler may publish in its own process, too
        self._last: dict[bytes, int] = {}
        self._filled: dict[bytes, int] = {}
        """Numbers up to which nothing is delivered any more, by the gid of a publisher that has been asked."""
        self._gapped: set[bytes] = set()
        """Publishers whose last message came behind a gap."""
        self._held: dict[bytes, list[tuple[int, Any]]] = {}
        """Messages that wait, with their numbers, by the gid of their publisher."""
        self._held_bytes = 0
        self._questions, self._until = 0, 0.0

    def __call__(self, arrived: Any) -> None:
        """Pass a sample on, unless it has to wait or comes again."""
        attachment = arrived.attachment
        if attachment is not None and type(attachment) is not bytes:
            if get_ident() not in _staying:  # one of Zenoh's
                stay()
            attachment = attachment.to_bytes()
        try:
            number, _, _, gid = fields_of(attachment or b"")
        except struct.error:  # not ROS 2's: it has no number
            self._sink(arrived)
            return
        with self._lock:
            if (self._questions or self._filled) and self._keeps(gid, number, arrived):
                return
            self._pass(gid, number, arrived)
            if gid in self._held:
                self._pass_those_in_order(gid)

    def _pass(self, gid: bytes, number: int, arrived: Any) -> None:
        last = self._last.get(gid)
        if last is None:
            if len(self._last) >= MOST_SENDERS:
                self._forget(next(iter(self._last)))
            last = number - 1
        elif len(self._last) > MOST_SENDERS // 2:
            del self._last[gid]  # who is silent the longest stands first, and is forgotten first
            self._last[gid] = last
        if number > last:  # threads that publish may overtake each other
            self._last[gid] = number
        if number - last > 1:
            self._gapped.add(gid)
        elif self._gapped:
            self._gapped.discard(gid)
        self._sink(arrived)

    def _forget(self, gid: bytes) -> None:
        del self._last[gid]
        self._filled.pop(gid, None)
        self._gapped.discard(gid)

    def _keeps(self, gid: bytes, number: int, arrived: Any) -> bool:
        """True for one that comes again, or that waits from now on."""
        filled = self._filled.get(gid)
        if filled is not None and number <= filled:
            return True
        if self._questions and clocks.monotonic() > self._until:  # nobody has told of the end
            self._release()
        if not self._questions or self._last.get(gid, 0) == number - 1 or gid in self._gapped:
            return False
        self._held.setdefault(gid, []).append((number, arrived))
        self._held_bytes += len(arrived.payload)
        if self._held_bytes > MOST_HELD:
            self._release()
        return True

    def positions(self) -> dict[bytes, int]:
        """Return the number of the last message of each publisher, by its gid."""
        with self._lock:
            return dict(self._last)

    def begin(self, questions: int, within: float) -> None:
        """Hold back what comes behind a gap until so many times `end`, or for so many seconds at most."""
        with self._lock:
            self._questions += questions
            self._until = clocks.monotonic() + within

    def take(self, messages: list[tuple[bytes, bytes]]) -> None:
        """Deliver what a publisher has sent again, which is in order, and what waits directly behind it."""
        with self._lock:
            for payload, attachment in messages:
                try:
                    number, _, _, gid = fields_of(attachment)
                except struct.error:  # of somebody who is not a publisher of ROS 2
                    continue
                last = self._last.get(gid)
                if last is None or number > last:
                    self._pass(gid, number, Sample(payload, attachment))
                    self._filled[gid] = number
            for gid in list(self._held):
                self._pass_those_in_order(gid)

    def _pass_those_in_order(self, gid: bytes) -> None:
        held = sorted(self._held.pop(gid), key=_number)
        for place, (number, arrived) in enumerate(held):
            if number > self._last.get(gid, 0) + 1:
                self._held[gid] = held[place:]
                return
            self._pass_held(gid, number, arrived)

    def end(self) -> None:
        """End one question: after the last one nothing waits any more."""
        with self._lock:
            if self._questions == 1:
                self._release()
            else:
                self._questions = max(0, self._questions - 1)

    def _release(self) -> None:
        self._questions = 0
        held, self._held = self._held, {}
        for gid, some in held.items():
            for number, arrived in sorted(some, key=_number):
                self._pass_held(gid, number, arrived)

    def _pass_held(self, gid: bytes, number: int, arrived: Any) -> None:
        """Deliver one that has waited, unless it has come with an answer."""
        self._held_bytes -= len(arrived.payload)
        last = self._last.get(gid)
        if last is None or number > last:
            self._pass(gid, number, arrived)
            self._filled[gid] = number

    def close(self) -> None:
        """Deliver nothing any more."""
        self._sink = bool  # not locked: whoever closes may have a lock for which a sink waits


def _number(held: tuple[int, Any]) -> int:
    return held[0]


MOST = 4096
"""Number of messages that a sieve remembers, by their attachments of 33 bytes: some 0.5 MB at most."""


class Sieve:
    """Sink that passes each message on once, by its attachment: publisher, number and time; those without pass."""

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._lock = threading.Lock()
        self._seen: dict[bytes, None] = {}

    def __call__(self, arrived: Any) -> None:
        """Pass a sample on unless it is known."""
        attachment = arrived.attachment
        if attachment is not None and not isinstance(attachment, bytes):
            attachment = attachment.to_bytes()
        if not attachment or self._is_new(attachment):
            self._sink(arrived)

    def _is_new(self, attachment: bytes) -> bool:
        with self._lock:
            if attachment in self._seen:
                return False
            self._seen[attachment] = None
            if len(self._seen) > MOST:
                del self._seen[next(iter(self._seen))]
            return True
