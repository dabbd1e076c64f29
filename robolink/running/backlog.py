"""Gaps in the sequence numbers that a subscription gets; backlog of one with KEEP_ALL, and its warnings.

Such a subscription is told about neither by its network nor by its depth, which it has not. So it counts the gaps in
its publishers' numbers, and says once that there are some; and it says when more and more waits.
"""

from __future__ import annotations

import contextlib
import itertools
import struct
import threading
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any

from robolink.exceptions import WireError
from robolink.transport.history import Mailbox
from robolink.wire import GID_BYTES, Attachment, fields_of, unpack_attachment

MOST_SENDERS = 1000
"""Most publishers of a topic whose sequence numbers are checked for gaps."""

LATE_BY = 100
"""Longest gap, in messages, that may be a change of order; those of a longer one are not expected any more."""

MOST_LATE = 1000
"""Most missing messages, of all senders, that are remembered since they may come late."""

MANY_WAIT = 1000
"""Least number of waiting messages for the first warning; each next one comes at ten times as many."""

TOO_OLD_NS = 1_000_000_000
"""Least time, in nanoseconds, that the first of them and so many have waited: less is a burst, no reason to warn."""


class Gaps:
    """Sequence numbers of each sender's last message; only the gaps of those are told for whom `counts(gid)` holds.

    Lyrical's publishers of images number what they send to several keys in one go: those have gaps, and lose nothing.
    """

    def __init__(self, counts: Callable[[bytes], bool] | None = None) -> None:
        self.last: dict[bytes, int] = {}
        """Number of each sender's last message, by its gid."""
        self._missing: dict[tuple[bytes, int], None] = {}
        self._counts = counts

    def before(self, sender: Attachment) -> int:
        """Return how many of its messages are missing before this one; -1 for one that was missing and comes late.

        Not to be called by two threads at once.
        """
        sequence, _, gid = sender
        if self.last.get(gid) == sequence - 1:  # the usual case, and quick: it runs for every message
            self.last[gid] = sequence
            return 0
        last = self.last.pop(gid, sequence)
        self.last[gid] = max(last, sequence)  # new ones last: the oldest gives way
        if len(self.last) > MOST_SENDERS:
            del self.last[next(iter(self.last))]
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


class Sequence:
    """Check of the attachments that a KEEP_LAST subscription takes: it counts what did not arrive.

    Args:
        gaps: Gaps of its publishers' numbers.
        mailbox: Mailbox of the subscription: what it drops itself is a gap, too.
        on_gap: Function that is called with the number of messages missing in a new gap.
    """

    def __init__(self, gaps: Gaps, mailbox: Mailbox, on_gap: Callable[[int], object]) -> None:
        self._gaps, self._last, self._mailbox, self._on_gap = gaps, gaps.last, mailbox, on_gap
        self._lock = threading.Lock()  # callbacks of a reentrant group run side by side
        self._before: int | None = None
        self._missing = self._most = 0

    @property
    def lost(self) -> int:
        """Number of messages that did not arrive; never less than before."""
        dropped = self._mailbox.dropped - (self._before or 0)
        self._most = max(self._most, self._missing - dropped)
        return self._most

    def check(self, attachment: bytes) -> None:
        """Count what is missing before a message. Raises WireError for an attachment that is not ROS 2's."""
        try:
            sequence, _, gid_length, gid = fields_of(attachment)
        except struct.error:
            gid_length = 0
        if gid_length != GID_BYTES:
            unpack_attachment(attachment)  # it says what is wrong
        with self._lock:
            if self._last.get(gid) == sequence - 1:  # the usual case of `before`
                self._last[gid] = sequence
                return
            if self._before is None:  # what was dropped before the first that is taken makes no gap
                self._before = self._mailbox.dropped_before_last
            missing = self._gaps.before(unpack_attachment(attachment))
            self._missing += missing
        if missing > 0:
            self._on_gap(missing)


class Backlog:
    """Checks what is delivered, in its order, and has warnings ready for the thread that takes it.

    `steady` gives the nanoseconds of a clock that only goes forward.
    """

    def __init__(self, topic: str, gaps: Gaps, steady: Callable[[], int]) -> None:
        self._topic = topic
        self._gaps, self._last = gaps, gaps.last
        self._steady = steady
        self._warns_at = MANY_WAIT
        self._many_since: int | None = None
        self._has_reported = False
        self.lost = 0
        """Number of messages that were published and did not arrive, by the sequence numbers of later ones."""
        self.warnings: deque[str] = deque()
        """Warnings to be logged: not here, where a lock is held, but by the thread that runs the callback."""

    def add(self, attachment: bytes, waiting: deque[Any]) -> int:
        """Check a message that is about to wait behind others; returns what `Gaps.before` does.

        Raises WireError for an attachment that is not ROS 2's.
        """
        try:  # this runs for every message: no call but C's in the usual case
            sequence, _, gid_length, gid = fields_of(attachment)
        except struct.error:
            gid_length = 0
        if gid_length != GID_BYTES:
            unpack_attachment(attachment)  # it says what is wrong
        last, missing = self._last, 0
        if last.get(gid) == sequence - 1:  # the usual case of `before`
            last[gid] = sequence
        else:
            missing = self._gaps.before(unpack_attachment(attachment))
        if missing:
            self.lost += missing
            if not self._has_reported:
                self._has_reported = True
                self._tell_of_loss(missing)
        if len(waiting) < MANY_WAIT:
            self._many_since = None
        elif len(waiting) >= self._warns_at:
            now, since = self._steady(), self._many_since
            if since is None:
                self._many_since = now
            elif now - since >= TOO_OLD_NS:
                self._many_since = now
                self._look_at_age(unpack_attachment(attachment), waiting)
        return missing

    def _tell_of_loss(self, missing: int) -> None:
        self.warnings.append(
            f"{self._topic}: messages were published that did not arrive, or not in their order ({missing} so far):"
            " this process or its link stood still, or it took them too slowly (more are only counted, in"
            " `Subscription.lost`)"
        )

    def _look_at_age(self, newest: Attachment, waiting: deque[Any]) -> None:
        """Warn if many have waited for long: also by our own clock, as a process that stood still gets all at once."""
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
    """Return the nanoseconds between the newest and the first of its sender that waits: senders' clocks may differ."""
    for each in itertools.islice(waiting, MANY_WAIT):
        with contextlib.suppress(WireError):
            sender = unpack_attachment(each.attachment)
            if sender.gid == newest.gid:
                return newest.timestamp - sender.timestamp
    return 0
