"""The backlog of a KEEP_ALL subscription: what was lost on the way to it, and what waits since its callback is slow.

Such a subscription is told about neither by its network nor by its depth, which it has not. So it counts the gaps in
its publishers' numbers, and says once that there are some; and it says when more and more waits.
"""

from __future__ import annotations

import contextlib
import itertools
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.exceptions import WireError
from robolink.wire import Attachment, unpack_attachment

MOST_SENDERS = 1000
"""Publishers of a topic whose messages are looked at for gaps."""

LATE_BY = 100
"""A longer gap is no change of order: its messages are not expected any more."""

MOST_LATE = 1000
"""Messages of all senders that may still come late."""

MANY_WAIT = 1000
"""Messages that wait at least when the first warning comes; each next one comes at ten times as many."""

TOO_OLD_NS = 1_000_000_000
"""Nanoseconds that the first of them has waited, and that so many have: less is a burst, and no reason to warn."""


class Gaps:
    """The last number of each sender's messages; only the gaps of those are told for whom `counts(gid)` holds.

    Lyrical's publishers of images number what they send to several keys in one go: those have gaps, and lose nothing.
    """

    def __init__(self, counts: Callable[[bytes], bool] | None = None) -> None:
        self._last: dict[bytes, int] = {}
        self._missing: dict[tuple[bytes, int], None] = {}
        self._counts = counts

    def before(self, sender: Attachment) -> int:
        """How many of its messages are missing before this one; -1 for one that was missing, and only comes late.

        Not to be called by two threads at once.
        """
        sequence, _, gid = sender
        if self._last.get(gid) == sequence - 1:  # the usual case, and quick: it runs for every message
            self._last[gid] = sequence
            return 0
        last = self._last.pop(gid, sequence)
        self._last[gid] = max(last, sequence)  # new ones last: the oldest gives way
        if len(self._last) > MOST_SENDERS:
            del self._last[next(iter(self._last))]
        if sequence <= last:
            return -1 if self._missing.pop((gid, sequence), self) is None else 0
        if sequence == last + 1 or (self._counts is not None and not self._counts(gid)):
            return 0
        self._expect(gid, range(last + 1, sequence))
        return sequence - last - 1

    def _expect(self, gid: bytes, missing: range) -> None:
        """Remember what may come late."""
        if len(missing) <= LATE_BY:
            self._missing.update(((gid, number), None) for number in missing)
            while len(self._missing) > MOST_LATE:
                del self._missing[next(iter(self._missing))]


class Backlog:
    """Looks at what is delivered, in its order, and has warnings ready for whoever takes it.

    `steady` gives the nanoseconds of a clock that only goes forward.
    """

    def __init__(self, topic: str, gaps: Gaps, steady: Callable[[], int]) -> None:
        self._topic = topic
        self._gaps = gaps
        self._steady = steady
        self._warns_at = MANY_WAIT
        self._many_since: int | None = None
        self._has_told = False
        self.lost = 0
        """Messages that were published and did not arrive, as far as the numbers of later ones tell."""
        self.warnings: deque[str] = deque()
        """What is to be logged: not here, where a lock is held, but by whoever runs the callback."""

    def add(self, attachment: bytes, waiting: deque[Any]) -> int:
        """Look at a message that is about to wait behind others; returns what `Gaps.before` does.

        Raises WireError for an attachment that is not ROS 2's.
        """
        sender = unpack_attachment(attachment)
        missing = self._gaps.before(sender)
        if missing:
            self.lost += missing
            if not self._has_told:
                self._has_told = True
                self._tell_of_loss(missing)
        if len(waiting) < MANY_WAIT:
            self._many_since = None
        elif len(waiting) >= self._warns_at:
            self._look_at_time(sender, waiting)
        return missing

    def _tell_of_loss(self, missing: int) -> None:
        self.warnings.append(
            f"{self._topic}: messages were published that did not arrive, or not in their order ({missing} so far):"
            " this process or its link stood still, or it took them too slowly (more are only counted, in"
            " `Subscription.lost`)"
        )

    def _look_at_time(self, newest: Attachment, waiting: deque[Any]) -> None:
        """Warn if many have waited for long: also by our own clock, as a process that stood still gets all at once."""
        now = self._steady()
        if self._many_since is None:
            self._many_since = now
        elif now - self._many_since >= TOO_OLD_NS:
            self._many_since = now
            age = _age(newest, waiting)
            if age >= TOO_OLD_NS:
                self._warns_at = 10 * len(waiting)
                self._warn_of(len(waiting), age)

    def _warn_of(self, many: int, age: int) -> None:
        self.warnings.append(
            f"{self._topic}: the callback does not keep up: {many} messages wait, the first of them since"
            f" {age / 1e9:.1f} s, and KEEP_ALL keeps them all: make the callback faster, or use KEEP_LAST"
        )


def _age(newest: Attachment, waiting: Iterable[Any]) -> int:
    """Nanoseconds between the newest and the first of its sender that waits: two senders' clocks may differ."""
    for each in itertools.islice(waiting, MANY_WAIT):
        with contextlib.suppress(WireError):
            sender = unpack_attachment(each.attachment)
            if sender.gid == newest.gid:
                return newest.timestamp - sender.timestamp
    return 0
