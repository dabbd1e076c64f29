"""The time of a playback: where it is in the bag, and when the next message is due."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Protocol

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.node import Node
from robolink.system import waits


class Playhead:
    """Map from steady time to that of a bag, both in nanoseconds; it stands still until `resume`.

    At the rate 1 it counts in whole numbers: messages keep their distances to the nanosecond.

    Args:
        steady: Function that returns steady time.
        rate: Nanoseconds of the bag in a nanosecond.
    """

    def __init__(self, steady: Callable[[], int], rate: float = 1.0) -> None:
        self._steady, self._rate = steady, rate
        self._begin = self._at = 0
        self.paused = True

    @property
    def rate(self) -> float:
        """Nanoseconds of the bag in a nanosecond."""
        return self._rate

    @rate.setter
    def rate(self, rate: float) -> None:
        now = self.now()
        self._rate = rate
        self.jump(now)

    def now(self) -> int:
        """Return the time in the bag."""
        passed = 0 if self.paused else self._steady() - self._begin
        if passed <= 0:  # it begins after a delay
            return self._at
        return self._at + (passed if self._rate == 1.0 else math.floor(passed * self._rate))

    def due(self, at: int) -> int:
        """Return the steady time at which it is `at` in the bag, while it runs on."""
        left = at - self._at
        return self._begin + (left if self._rate == 1.0 else math.ceil(left / self._rate))

    def jump(self, at: int, delay: int = 0) -> None:
        """Set the time in the bag; while it runs, go on from there after `delay`."""
        self._at, self._begin = at, self._steady() + delay

    def pause(self) -> None:
        """Stand still."""
        self._at = self.now()
        self.paused = True

    def resume(self) -> None:
        """Go on."""
        if self.paused:
            self.paused = False
            self._begin = self._steady()


Advance = Callable[[], "int | None"]
"""Function that does what is due, and returns the steady time at which to call it again; None to wait for `wake`."""


class Pacer(Protocol):
    """Caller of a function at the times that it asks for."""

    def start(self) -> None:
        """Begin to call."""

    def wake(self) -> None:
        """Call soon, whatever was asked for; on any thread."""

    def close(self) -> None:
        """Call no more. Safe to call twice."""


def pacer(node: Node, advance: Advance) -> Pacer:
    """Return the pacer that goes by a node's time."""
    if node.context.time.fastest_pace():  # only virtual time has one
        return TimerPacer(node, advance)
    return ThreadPacer(node, advance)


class ThreadPacer:
    """Pacer with a thread of its own: no callback of the node makes it late.

    Args:
        node: Node whose time it goes by.
        advance: Function to call.
    """

    def __init__(self, node: Node, advance: Advance) -> None:
        self._advance, self._time = advance, node.context.time
        self._changed = threading.Event()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="robolink bag player", daemon=True)

    def start(self) -> None:
        """Begin to call."""
        self._thread.start()

    def wake(self) -> None:
        """Call soon."""
        self._changed.set()

    def close(self) -> None:
        """Call no more, and wait until the thread has ended."""
        self._closed = True
        self._changed.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            waits.join(self._thread)

    def _run(self) -> None:
        while True:
            self._changed.clear()
            if self._closed:  # asked after the clear, which may have followed upon `close`
                return
            due = self._advance()
            self._changed.wait(None if due is None else max(0.0, (due - self._time.steady()) / 1e9))


class TimerPacer:
    """Pacer by a timer of a node, which somebody has to spin.

    Args:
        node: Node whose timer it is.
        advance: Function to call.
    """

    def __init__(self, node: Node, advance: Advance) -> None:
        self._advance, self._time = advance, node.context.time
        clock = Clock(clock_type=ClockType.STEADY_TIME, time_base=self._time)
        self._timer = node.create_timer(0.0, self._on_timer, clock=clock, autostart=False)

    def start(self) -> None:
        """Begin to call."""
        self.wake()

    def wake(self) -> None:
        """Call soon."""
        self._call_in(0)

    def close(self) -> None:
        """Call no more."""
        self._timer.destroy()

    def _on_timer(self) -> None:
        self._timer.cancel()
        due = self._advance()
        if due is not None:
            self._call_in(max(0, due - self._time.steady()))

    def _call_in(self, nanoseconds: int) -> None:
        timer = self._timer
        if not timer._destroyed:
            timer.timer_period_ns = max(1, nanoseconds)  # in virtual time, a period of 0 is a millisecond
            timer.reset()
            if not nanoseconds:
                timer.next_call_ns = timer.clock.now_ns()
                timer.reschedule()
