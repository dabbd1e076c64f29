"""Fault model of a link: each message may be lost, delayed or duplicated, by random numbers of a seed alone.

A fault draws as often for a message as its settings need, whatever other faults do to the message; so one fault more,
or another latency, changes no other fault's draws.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from robolink.faults.description import FaultReport, MessageFault

NEVER = 1 << 62
"""Time in ns that is later than any run ends."""

Window = tuple[int, int]
"""Interval of times in ns in which a fault holds: from the first, until the second."""


def window(after: float, until: float | None, start: int) -> Window:
    """Convert a fault's seconds to times in ns of the clock that was at `start` when the run began."""
    return start + round(after * 1e9), NEVER if until is None else start + round(until * 1e9)


_Delays = Callable[[tuple[int, ...]], tuple[int, ...]]

AT_ONCE: tuple[int, ...] = (0,)
"""Delays in ns of a message that no fault touches: one copy, at once."""

TWICE: tuple[int, ...] = (0, 0)
"""Delays in ns of a message that comes twice, at once."""


class LinkFault:
    """One fault on one link: from a program to another, on one topic or service."""

    __slots__ = (
        "_double",
        "_in_burst",
        "_jitter",
        "_jitter_of_double",
        "_latency",
        "_loss",
        "begin",
        "delays",
        "end",
        "plain",
        "reorders",
        "report",
    )

    def __init__(
        self, fault: MessageFault, when: Window, draws: Callable[[str], Callable[[], float]], report: FaultReport
    ) -> None:
        """`draws(purpose)` returns a source of numbers in [0, 1)."""
        self.begin, self.end = when
        self.report, self.reorders = report, fault.reorder
        self._latency = round(fault.latency * 1e9)
        spread = round(fault.jitter * 1e9)
        self._jitter = _spread(spread, draws("jitter")) if spread else None
        self._jitter_of_double = _spread(spread, draws("jitter of doubles")) if spread else None
        self._loss = _Chance(fault.loss, draws("loss"))
        self._in_burst = None if fault.burst is None else _bursts(fault.loss, fault.burst, draws("loss"))
        self._double = _Chance(fault.duplication, draws("duplication"))
        is_plain = not (self._latency or spread or self._in_burst)
        self.plain: _Plain | None = (report, *self._loss, *self._double) if is_plain else None
        """Report and chances of a fault that only loses and doubles; None for others."""
        self.delays: Callable[[tuple[int, ...]], tuple[int, ...]] = (
            self._delays if self.plain is None else _plain_delays(self.plain)
        )
        """Applies the fault to a message: takes the delays in ns of its copies so far, and returns the new ones."""

    def _delays(self, before: tuple[int, ...]) -> tuple[int, ...]:
        report = self.report
        report.met += 1
        lost = self._in_burst() if self._in_burst is not None else self._loss.comes()
        doubled = self._double.comes()
        late = self._delay(self._jitter)
        double_late = self._delay(self._jitter_of_double) if doubled else 0
        if not before:  # lost by another fault
            return before
        if lost:
            report.lost += 1
            return ()
        after = before
        if late:
            report.late += 1
            after = tuple([each + late for each in before])
        if doubled:
            report.doubled += 1
            after = (*after, before[0] + double_late)
        return after

    def _delay(self, jitter: Callable[[], int] | None) -> int:
        return self._latency if jitter is None else max(0, self._latency + jitter())


class _Chance(NamedTuple):
    """An event of some probability, and the source of numbers that decides it; without a probability none is drawn."""

    share: float
    draw: Callable[[], float]

    def comes(self) -> bool:
        """Draw; True if it comes."""
        return self.share > 0.0 and self.draw() < self.share


_Plain = tuple[FaultReport, float, Callable[[], float], float, Callable[[], float]]
"""A fault that only loses and doubles: its report, the share of losses and their source of numbers, that of doubles."""


def _plain_delays(plain: _Plain) -> Callable[[tuple[int, ...]], tuple[int, ...]]:
    """Return `LinkFault.delays` of a fault that only loses and doubles: a closure, for many messages come here."""
    report, loss_share, draw_loss, double_share, draw_double = plain

    def delays(before: tuple[int, ...]) -> tuple[int, ...]:
        report.met += 1
        lost = loss_share and draw_loss() < loss_share
        doubled = double_share and draw_double() < double_share
        if not (lost or doubled) or not before:
            return before
        if lost:
            report.lost += 1
            return ()
        report.doubled += 1
        return (*before, before[0])

    return delays


class Link:
    """Link between two programs on one topic or service, with all its faults."""

    __slots__ = (
        "_faults",
        "_partitions",
        "_reorders",
        "arrivals",
        "pending_until",
    )

    def __init__(
        self, faults: list[LinkFault], partitions: list[tuple[Window, FaultReport]], earlier: Link | None = None
    ) -> None:
        """A message that is still on the `earlier` link is not overtaken."""
        self._faults, self._partitions = faults, partitions
        self.pending_until: int = -1 if earlier is None else earlier.pending_until
        self._reorders = False
        self.arrivals = _arrivals(self)
        """Returns the times in ns at which copies of a message arrive, none if it is lost; None for one copy, at once.

        Its arguments are the message and the time in ns, which only goes forward. A program that has several
        subscriptions to a topic is sent a message once: all of them get it, or none does.
        """

    def active_at(self, now: int) -> tuple[int, list[LinkFault], list[FaultReport]]:
        """Return until when the same faults are active as now, these faults, and the partitions that cut it off."""
        active = [each for each in self._faults if each.begin <= now < each.end]
        self._reorders = any(each.reorders for each in active)
        cuts = [report for (begin, end), report in self._partitions if begin <= now < end]
        windows = [*((each.begin, each.end) for each in self._faults), *(when for when, _ in self._partitions)]
        until = min((each for when in windows for each in when if each > now), default=NEVER)
        return until, active, cuts

    def in_turn(self, times: tuple[int, ...]) -> tuple[int, ...]:
        """Keep the order of what is still under way, unless reordering is wanted."""
        if not self._reorders:
            earliest = self.pending_until
            times = tuple([max(each, earliest) for each in times])
        self.pending_until = max(self.pending_until, *times)
        return times


def _arrivals(link: Link) -> Callable[[object, int], tuple[int, ...] | None]:
    """Return `Link.arrivals`: a closure, for every message comes here."""
    until = -NEVER
    active: list[LinkFault] = []
    cuts: list[FaultReport] = []
    alone: _Plain | None = None
    last_message: object = None
    last_time = -1
    last: tuple[int, ...] | None = None

    def arrivals(message: object, now: int) -> tuple[int, ...] | None:
        nonlocal until, active, cuts, alone, last_message, last_time, last
        if message is last_message and now == last_time:
            return last
        if now >= until:
            until, active, cuts = link.active_at(now)
            alone = active[0].plain if len(active) == 1 and not cuts else None
        last_message, last_time = message, now
        if alone is None:
            delays = _delays_by(active, cuts)
        else:  # as usual: `_plain_delays` written out
            report, loss_share, draw_loss, double_share, draw_double = alone
            report.met += 1
            lost = loss_share and draw_loss() < loss_share
            doubled = double_share and draw_double() < double_share
            if lost:
                report.lost += 1
                delays = ()
            elif doubled:
                report.doubled += 1
                delays = TWICE
            else:
                delays = AT_ONCE
        if delays is AT_ONCE and link.pending_until <= now:
            last = None
        else:
            last = link.in_turn(tuple([now + each for each in delays])) if delays else delays
        return last

    return arrivals


def _delays_by(active: list[LinkFault], cuts: list[FaultReport]) -> tuple[int, ...]:
    delays = AT_ONCE
    for each in active:
        delays = each.delays(delays)
    return _cut_off(delays, cuts) if cuts else delays


def _cut_off(delays: tuple[int, ...], cuts: list[FaultReport]) -> tuple[int, ...]:
    for report in cuts:
        report.met += 1
        report.lost += bool(delays)
        delays = ()
    return delays


def _spread(jitter: int, draw: Callable[[], float]) -> Callable[[], int]:
    """Return a source of delays in ns, uniform from -jitter to jitter."""
    return lambda: round((2.0 * draw() - 1.0) * jitter)


def _bursts(share: float, burst: float, draw: Callable[[], float]) -> Callable[[], bool]:
    """Return a source of losses, in runs of `burst` messages on average.

    They come from a chain of two states, all lost and none lost: Gilbert's model (E. N. Gilbert, Capacity of a
    burst-noise channel, Bell System Technical Journal 39, 1960) with nothing received in the bad state.
    """
    ends, begins = 1.0 / burst, share / (burst * (1.0 - share))
    bad = False

    def is_lost() -> bool:
        nonlocal bad
        bad = draw() >= ends if bad else draw() < begins
        return bad

    return is_lost
