"""Sink that puts messages in order again which come late, since their publisher was asked for them."""

from __future__ import annotations

import struct
import threading
import time
from typing import Any

from robolink.transport.base import Sample, Sink
from robolink.wire import fields_of

MOST_SENDERS = 1000
"""Most publishers of a topic whose last numbers are known."""

_Held = tuple[bytes, int, Any]


class Mending:
    """Sink of a RELIABLE topic that knows the number of each publisher's last message.

    While publishers are asked (from `begin` to `end`), it holds back what comes behind a gap; `take` fills the gap.
    What has been filled is not delivered again, however late the lost link brings it.
    """

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._lock = threading.RLock()  # re-entrant: a signal handler may publish in its own process, too
        self._last: dict[bytes, int] = {}
        self._filled: dict[bytes, int] = {}
        """Numbers up to which nothing is delivered any more, by the gid of a publisher that has been asked."""
        self._held: list[_Held] = []
        self._questions, self._until = 0, 0.0

    def __call__(self, arrived: Any) -> None:
        """Pass a sample on, unless it has to wait or comes again."""
        attachment = arrived.attachment
        if attachment is not None and type(attachment) is not bytes:
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

    def _pass(self, gid: bytes, number: int, arrived: Any) -> None:
        if gid not in self._last and len(self._last) >= MOST_SENDERS:
            oldest = next(iter(self._last))
            del self._last[oldest]
            self._filled.pop(oldest, None)
        self._last[gid] = number
        self._sink(arrived)

    def _keeps(self, gid: bytes, number: int, arrived: Any) -> bool:
        """True for one that comes again, or that waits from now on."""
        filled = self._filled.get(gid)
        if filled is not None and number <= filled:
            return True
        if self._questions and time.monotonic() > self._until:  # nobody has told of the end
            self._release()
        if not self._questions or self._last.get(gid) == number - 1:
            return False
        self._held.append((gid, number, arrived))
        return True

    def positions(self) -> dict[bytes, int]:
        """Return the number of the last message of each publisher, by its gid."""
        with self._lock:
            return dict(self._last)

    def begin(self, questions: int, within: float) -> None:
        """Hold back what comes behind a gap until so many times `end`, or for so many seconds at most."""
        with self._lock:
            self._questions += questions
            self._until = time.monotonic() + within

    def take(self, messages: list[tuple[bytes, bytes]]) -> None:
        """Deliver what a publisher has sent again, which is in order, and what waits directly behind it."""
        with self._lock:
            for payload, attachment in messages:
                try:
                    number, _, _, gid = fields_of(attachment)
                except struct.error:  # of somebody who is no publisher of ROS 2
                    continue
                last = self._last.get(gid)
                if last is None or number > last:
                    self._pass(gid, number, Sample(payload, attachment))
                    self._filled[gid] = number
            self._pass_those_in_order()

    def _pass_those_in_order(self) -> None:
        held, self._held = sorted(self._held, key=_place), []
        for gid, number, arrived in held:
            last = self._last.get(gid)
            if last == number - 1:
                self._pass(gid, number, arrived)
                self._filled[gid] = number
            elif last is None or number > last:
                self._held.append((gid, number, arrived))

    def end(self) -> None:
        """End one question: after the last one nothing waits any more."""
        with self._lock:
            if self._questions == 1:
                self._release()
            else:
                self._questions = max(0, self._questions - 1)

    def _release(self) -> None:
        self._questions = 0
        held, self._held = sorted(self._held, key=_place), []
        for gid, number, arrived in held:
            last = self._last.get(gid)
            if last is None or number > last:
                self._pass(gid, number, arrived)
                self._filled[gid] = number

    def close(self) -> None:
        """Deliver nothing any more."""
        self._sink = bool  # not locked: whoever closes may have a lock for which a sink waits


def _place(held: _Held) -> tuple[bytes, int]:
    return held[:2]
