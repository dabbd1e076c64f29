"""Cache of one frame's transforms to its parent, by time."""

from __future__ import annotations

from bisect import bisect_right
from typing import NamedTuple

from robolink.tf2.exceptions import ExtrapolationException
from robolink.tf2.rigid import Rigid, between

LATEST = 0
"""Time in ns that means the latest time known."""


class Link(NamedTuple):
    """A frame in its parent at one time in ns: `one`, or the interpolation at `ratio` between `one` and `other`."""

    parent: str
    stamp: int
    one: Rigid
    other: Rigid | None = None
    ratio: float = 0.0

    def rigid(self) -> Rigid:
        """Return the transform from the frame to its parent."""
        return self.one if self.other is None else between(self.one, self.other, self.ratio)


class TimeCache:
    """Cache of a moving frame: its transforms of the last `keep` ns, in order of their stamps."""

    is_static = False

    def __init__(self, keep: int) -> None:
        self._keep = keep
        self._stamps: list[int] = []
        self._known: list[tuple[str, Rigid]] = []

    def insert(self, stamp: int, parent: str, rigid: Rigid) -> bool:
        """Insert a transform; False if it is too old. It replaces one of the same stamp.

        What is older than `keep` is removed when the next one comes: of a frame that is seldom sent two are always
        there.
        """
        stamps = self._stamps
        if stamps:
            oldest = stamps[-1] - self._keep
            if stamps[0] < oldest:
                gone = bisect_right(stamps, oldest - 1)
                del stamps[:gone], self._known[:gone]
            if stamp < oldest:
                return False
        at = bisect_right(stamps, stamp)
        if at and stamps[at - 1] == stamp:
            self._known[at - 1] = (parent, rigid)
        else:
            stamps.insert(at, stamp)
            self._known.insert(at, (parent, rigid))
        return True

    def at(self, time: int) -> Link:
        """Return the transform at a time. Raises ExtrapolationException if it is not known then."""
        stamps = self._stamps
        if time == LATEST and stamps:
            return Link(self._known[-1][0], stamps[-1], self._known[-1][1])
        at = bisect_right(stamps, time) - 1
        if at < 0 or (at == len(stamps) - 1 and stamps[at] != time):
            raise ExtrapolationException(self._why_not(time))
        parent, one = self._known[at]
        if stamps[at] == time or self._known[at + 1][0] != parent:
            return Link(parent, time, one)
        ratio = (time - stamps[at]) / (stamps[at + 1] - stamps[at])
        return Link(parent, time, one, self._known[at + 1][1], ratio)

    def _why_not(self, time: int) -> str:
        begin, requested = "Lookup would require extrapolation", seconds(time)
        if not self._stamps:
            return f"{begin} at time {requested}, but no data is in the buffer"
        first, last = self._stamps[0], self._stamps[-1]
        if first == last:
            return f"{begin} at time {requested}, but only time {seconds(first)} is in the buffer"
        if time > last:
            return (
                f"{begin} into the future.  Requested time {requested} but the latest data is at time {seconds(last)}"
            )
        return f"{begin} into the past.  Requested time {requested} but the earliest data is at time {seconds(first)}"

    def parent_near(self, time: int) -> str | None:
        """Return the parent at a time, or at the nearest time that is known; None after `clear`."""
        if not self._stamps:
            return None
        return self._known[max(0, bisect_right(self._stamps, time) - 1)][0]

    def clear(self) -> None:
        """Remove all transforms."""
        self._stamps.clear()
        self._known.clear()

    def __len__(self) -> int:
        return len(self._stamps)

    @property
    def newest(self) -> int:
        """Latest stamp in ns; 0 if there is none."""
        return self._stamps[-1] if self._stamps else 0

    @property
    def oldest(self) -> int:
        """Earliest stamp in ns; 0 if there is none."""
        return self._stamps[0] if self._stamps else 0


class StaticCache:
    """Cache of a static frame: its only transform holds at every time."""

    is_static = True
    newest = oldest = 0

    def __init__(self, parent: str, rigid: Rigid) -> None:
        self._parent, self._rigid = parent, rigid

    def at(self, time: int) -> Link:
        """Return the transform."""
        return Link(self._parent, LATEST, self._rigid)

    def parent_near(self, time: int) -> str:
        """Return the parent."""
        return self._parent

    def clear(self) -> None:
        """Do nothing: a static transform is sent once, and would not come again."""

    def __len__(self) -> int:
        return 1


def seconds(nanoseconds: int) -> str:
    """Format a time in ns as tf2 does: seconds with six decimals."""
    return f"{nanoseconds / 1e9:.6f}"
