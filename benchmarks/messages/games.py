"""Ping-pong and flood: what all contenders of a benchmark do alike, and how they hand in their figures."""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, NamedTuple

LEAST_TRIPS = 5
"""Fewest trips of a game, however slow they are."""

QUIET = 0.3
"""Seconds without an answer after which no second ball is about."""


class Task(NamedTuple):
    """Task of a process."""

    kind: str
    """A message of `benchmarks.messages.samples`."""
    seconds: float
    """Seconds for which it plays or sends."""
    variant: str
    """A contender's way of doing it."""
    size: int
    """Length of the encoded message in bytes."""

    @property
    def large(self) -> bool:
        """True if one message is sent at a time and few are kept."""
        return self.size > 100_000


def say(figures: Any) -> None:
    """Write a line of JSON to the process that measures."""
    sys.stdout.write(json.dumps(figures) + "\n")
    sys.stdout.flush()


def say_ready() -> None:
    say("ready")


def wait_for_the_end() -> None:
    """Return when the process that measures wants no more; what this process has goes with it."""
    sys.stdin.read()
    os._exit(0)


class Ping:
    """The end that counts: it notes when each answer came, and leaves when the time is over."""

    def __init__(self, seconds: float, retry: float = 0.3) -> None:
        self._seconds, self._retry = seconds, retry
        self._end, self._answers = 0.0, 0
        self._times: list[float] = []
        self.checked: bool | None = None
        """True if the first answer was what had been sent; None before it has come."""

    def answered(self) -> bool:
        """Note an answer; True if the next message is to be sent. Does not return from the last one."""
        now = time.perf_counter()
        if not self._end:
            self._answers += 1
            return False
        self._times.append(now)
        if now < self._end or len(self._times) < LEAST_TRIPS:
            return True
        self._leave()
        return False

    def play(self, send: Callable[[], object], wait: Callable[[float], object]) -> None:
        """Serve, once both ends know each other and exactly one ball is in play."""
        sent, given_up = 0, time.monotonic() + 30
        while not self._answers:
            send()
            sent += 1
            self._wait_until(time.monotonic() + self._retry, wait, lambda: self._answers > 0)
            if time.monotonic() > given_up:
                raise SystemExit("no answer")
        if sent > 1:
            self._wait_until(time.monotonic() + max(QUIET, self._retry), wait, lambda: False)
        if self.checked is False:
            raise SystemExit("the answer is not what was sent")
        self._end = time.perf_counter() + self._seconds
        self._times.append(time.perf_counter())
        send()

    @staticmethod
    def _wait_until(deadline: float, wait: Callable[[float], object], done: Callable[[], bool]) -> None:
        while not done() and time.monotonic() < deadline:
            wait(0.01)

    def _leave(self) -> None:
        """Hand in the microseconds of each trip but for the first quarter, in which caches fill."""
        trips = [1e6 * (b - a) for a, b in zip(self._times, self._times[1:], strict=False)]
        say([round(trip, 1) for trip in trips[len(trips) // 4 :]])
        os._exit(0)


class Count:
    """Counter of what arrived in a flood, from when to when, and of what was not as sent or not after the last."""

    def __init__(self) -> None:
        self.count = self.wrong = 0
        self.first = self.last = 0.0
        self._number = 0

    def add(self, number: int, intact: bool = True) -> None:
        """Count a message by the number that its sender gave it; lost ones leave gaps."""
        self.last = time.perf_counter()
        self.count += 1
        if not self.first:
            self.first = self.last
        if number <= self._number or not intact:
            self.wrong += 1
        self._number = number

    def answer(self) -> None:
        """Write the figures for each line from the process that measures, on another thread."""

        def answer() -> None:
            for _ in sys.stdin:
                self.say()
            os._exit(0)

        threading.Thread(target=answer, daemon=True).start()

    def say(self) -> None:
        """Write the figures."""
        say([self.count, self.last - self.first, self.wrong])


class Beat:
    """A hundred messages in a second: half a second to settle, then the share of a core that this process takes."""

    PERIOD = 0.01
    """Seconds from a beat to the next."""
    SETTLE = 50
    """Beats before the measurement."""

    def __init__(self, task: Task, send: Callable[[], object]) -> None:
        self._left, self._send = self.SETTLE + round(task.seconds / self.PERIOD), send
        self._begin = (0.0, 0.0)
        self._counted = self._left - self.SETTLE

    def tick(self) -> None:
        """Send; hand in the figure and leave after the last beat."""
        self._send()
        self._left -= 1
        if self._left == self._counted:
            self._begin = (time.perf_counter(), time.process_time())
        if not self._left:
            (wall, cpu), now = self._begin, (time.perf_counter(), time.process_time())
            say((now[1] - cpu) / (now[0] - wall))
            os._exit(0)

    def keep(self) -> None:
        """Tick by sleeping to each deadline, as a program without timers does."""
        due = time.perf_counter()
        while True:
            self.tick()
            due += self.PERIOD
            time.sleep(max(0.0, due - time.perf_counter()))


def pour(task: Task, send: Callable[[int], object]) -> None:
    """Send numbers from 1 on for so long as fast as it goes, say how many, and stay until all has arrived."""
    batch, sent = (1 if task.large else 100), 0
    end = time.perf_counter() + task.seconds
    while time.perf_counter() < end:
        for number in range(sent + 1, sent + 1 + batch):
            send(number)
        sent += batch
    say(sent)
    wait_for_the_end()
