"""Publish the messages of a topic on another one, some time later.

robolink run topic_tools delay scan 0.5
"""

from __future__ import annotations

from collections import deque
from typing import Any

from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.topic_tool import TopicTool, numbered
from robolink.timer import Timer

USAGE = "delay INTOPIC SECONDS [OUTTOPIC]"
MOST_WAITING = 100_000
"""Largest number of messages that wait; the oldest is dropped for one more."""


class Delay(TopicTool):
    """A node that passes on messages later. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("delay", **options)

    def set_up(self) -> None:
        """Declare the topics and the delay."""
        self.declare_topics("_delay")
        self._delay = self.needed("delay", "seconds by which messages are delayed", -1.0)
        if not 0.0 <= self._delay < 1e6:
            raise UsageError(f"delay: expected seconds from 0 on, got {self._delay:g}")
        self._waiting: deque[tuple[int, bytes]] = deque(maxlen=MOST_WAITING)
        self._timer: Timer | None = None

    def on_message(self, payload: bytes) -> None:
        """Keep a message until its time."""
        self._waiting.append((self.get_clock().now().nanoseconds + round(self._delay * 1e9), payload))
        if self._timer is None:
            self._wake_in(self._delay)

    def _wake_in(self, seconds: float) -> None:
        self._timer = self.create_timer(max(seconds, 0.0), self._on_timer)

    def _on_timer(self) -> None:
        """Pass on what is due, and wake again for the next one."""
        if self._timer is not None:
            self.destroy_timer(self._timer)
            self._timer = None
        now = self.get_clock().now().nanoseconds
        while self._waiting and self._waiting[0][0] <= now:
            self.pass_on(self._waiting.popleft()[1])
        if self._waiting:
            self._wake_in((self._waiting[0][0] - now) / 1e9)


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""

    def make(words: list[str]) -> Delay:
        kinds: tuple[tuple[str, type[Any]], ...] = (("input_topic", str), ("delay", float))
        return Delay(parameters=numbered(words, USAGE, *kinds, optional="output_topic"))

    spin_program(make, args)


if __name__ == "__main__":
    main()
