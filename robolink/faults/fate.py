"""What happens to each message on its way: lost, late, doubled. Decided by numbers that are drawn, and by nothing else.

A fault draws as often for a message as it says, whatever becomes of the message by others; so one fault more, or
another latency, changes no other fault's draws.
"""

from __future__ import annotations

from collections.abc import Callable

from robolink.faults.description import MessageFault
from robolink.faults.report import FaultReport

NEVER = 1 << 62
"""Nanoseconds: later than any run ends."""

Window = tuple[int, int]
"""The times, in nanoseconds, from which and until which something holds."""


def window(after: float, until: float | None, start: int) -> Window:
    """Turn a fault's seconds into times of the clock that showed `start` when the run began."""
    return start + round(after * 1e9), NEVER if until is None else start + round(until * 1e9)


AT_ONCE = (0,)
"""What becomes of a message that no fault touches: one copy, with no delay."""


class Strand:
    """One fault on one way: from a program to another, on one topic or service."""

    __slots__ = (
        "_double",
        "_double_draw",
        "_in_burst",
        "_jitter",
        "_jitter_of_double",
        "_latency",
        "_loss",
        "_loss_draw",
        "begin",
        "end",
        "reorders",
        "report",
    )

    def __init__(
        self, fault: MessageFault, when: Window, draws: Callable[[str], Callable[[], float]], report: FaultReport
    ) -> None:
        """`draws(purpose)` gives a source of numbers in [0, 1)."""
        self.begin, self.end = when
        self.report, self.reorders = report, fault.reorder
        self._latency = round(fault.latency * 1e9)
        spread = round(fault.jitter * 1e9)
        self._jitter = _spread(spread, draws("jitter")) if spread else None
        self._jitter_of_double = _spread(spread, draws("jitter of doubles")) if spread else None
        self._loss, self._loss_draw = fault.loss, draws("loss") if fault.loss else None
        self._in_burst = None if fault.burst is None else _bursts(fault.loss, fault.burst, draws("loss"))
        self._double, self._double_draw = fault.duplication, draws("duplication") if fault.duplication else None

    def delays(self, before: tuple[int, ...]) -> tuple[int, ...]:
        """Take the delays, in ns, with which copies of a message come so far; give those with which they come now."""
        report = self.report
        report.met += 1
        lost = self._loss_draw is not None and self._is_lost()
        doubled = self._double_draw is not None and self._double_draw() < self._double
        late = self._latency if self._jitter is None else self._delay(self._jitter)
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

    def _is_lost(self) -> bool:
        return self._loss_draw() < self._loss if self._in_burst is None else self._in_burst()  # type: ignore[misc]

    def _delay(self, jitter: Callable[[], int] | None) -> int:
        return self._latency if jitter is None else max(0, self._latency + jitter())


class Way:
    """All that can happen between two programs on one topic or service."""

    __slots__ = ("_cuts", "_fate", "_message", "_pending_until", "_strands", "_time_of_fate")

    def __init__(
        self, strands: list[Strand], cuts: list[tuple[Window, FaultReport]], earlier: Way | None = None
    ) -> None:
        """What is still on the `earlier` way is not overtaken."""
        self._strands, self._cuts = strands, cuts
        self._pending_until: int = -1 if earlier is None else earlier._pending_until
        self._message: object = None
        self._fate: tuple[int, ...] | None = None
        self._time_of_fate = -1

    def arrivals(self, message: object, now: int) -> tuple[int, ...] | None:
        """Give the times at which copies of a message arrive, none if it is lost; None for one copy, at once.

        A program that has several ears for a topic is sent a message once: all of them hear it, or none does.
        """
        if message is self._message and now == self._time_of_fate:
            return self._fate
        delays: tuple[int, ...] = AT_ONCE
        reorders = False
        for strand in self._strands:
            if strand.begin <= now < strand.end:
                delays = strand.delays(delays)
                reorders = reorders or strand.reorders
        if self._cuts:
            delays = self._cut(delays, now)
        if delays is AT_ONCE and self._pending_until <= now:
            fate = None
        else:
            fate = self._in_turn(tuple([now + each for each in delays]), reorders) if delays else delays
        self._message, self._time_of_fate, self._fate = message, now, fate
        return fate

    def _cut(self, delays: tuple[int, ...], now: int) -> tuple[int, ...]:
        for (begin, end), report in self._cuts:
            if begin <= now < end:
                report.met += 1
                report.lost += bool(delays)
                delays = ()
        return delays

    def _in_turn(self, times: tuple[int, ...], reorders: bool) -> tuple[int, ...]:
        """Let nothing overtake what is still on its way, unless that is wanted."""
        if not reorders:
            earliest = self._pending_until
            times = tuple([max(each, earliest) for each in times])
        self._pending_until = max(self._pending_until, *times)
        return times


def _spread(jitter: int, draw: Callable[[], float]) -> Callable[[], int]:
    """Draw evenly from -jitter to jitter nanoseconds."""
    return lambda: round((2.0 * draw() - 1.0) * jitter)


def _bursts(share: float, burst: float, draw: Callable[[], float]) -> Callable[[], bool]:
    """Draw whether a message is lost, in runs of `burst` messages on average.

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
