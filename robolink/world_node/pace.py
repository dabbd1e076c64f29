"""Real-time pacing of a simulation: the number of steps that are due, and the measured real-time factor."""

from __future__ import annotations

from collections import deque

TURN = 0.01
"""Most simulated time of one turn, in seconds; then other callbacks have theirs."""

OFTENEST, RAREST = 0.001, 1.0
"""Shortest and longest period of looks at the clock, in seconds."""

BACKLOG = 0.5
"""Longest delay that the simulation still catches up, in seconds; the rest is given up."""

WINDOW = 3
"""Length of the window in which the real-time factor is measured, in seconds, with a mark in each."""


class Pace:
    """Pacer: counts the steps of `dt` nanoseconds that are due by the clock, without drift; with `rtf` 0 always a turn.

    `period` is the seconds between two looks at the clock. Of `left` steps all are made, and then none is due.
    """

    def __init__(self, start: int, dt: int, rtf: float, left: int | None = None) -> None:
        self.start, self.dt, self.rtf, self.left = start, dt, rtf, left
        self.turn = max(1, round(TURN * 1e9 / dt))
        self.period = min(max(OFTENEST, self.turn * dt / rtf / 1e9), RAREST) if rtf else 1e-6
        self.behind = False
        """True if more steps are due than `due` has returned: call it again after other callbacks."""
        self._done = 0

    def due(self, now: int) -> tuple[int, float]:
        """Return the number of steps to make at `now`, and the simulated seconds that are given up as too late."""
        if not self.rtf:
            return self._next_of_left(), 0.0
        late = int((now - self.start) * self.rtf) // self.dt - self._done
        if late <= self.turn:  # as nearly always
            self._done += late
            self.behind = False
            return late, 0.0
        most = max(self.turn, int(BACKLOG * 1e9 * self.rtf) // self.dt)
        given_up = max(0, late - most) * self.dt
        self.start += int(given_up / self.rtf)
        late = min(late, most)
        steps = min(late, self.turn)
        self._done += steps
        self.behind = late > steps
        return steps, given_up / 1e9

    def _next_of_left(self) -> int:
        if self.left is None:
            return self.turn
        steps = min(self.turn, self.left)
        self.left -= steps
        return steps


class RateMeter:
    """Meter of the real-time factor over the last seconds, from a mark a second."""

    def __init__(self) -> None:
        self._marks: deque[tuple[int, int]] = deque(maxlen=WINDOW + 1)

    def restart(self) -> None:
        """Drop all marks: another pace holds from now on."""
        self._marks.clear()

    def mark(self, now: int, simulated: int) -> float | None:
        """Add a mark of the time and the simulated time, in nanoseconds; return the factor, None while not known."""
        self._marks.append((now, simulated))
        then, simulated_then = self._marks[0]
        return (simulated - simulated_then) / (now - then) if now > then else None
