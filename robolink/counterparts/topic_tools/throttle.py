"""Publish at most so many messages, or bytes, of a topic per second on another one.

robolink run topic_tools throttle messages scan 1.0
robolink run topic_tools throttle bytes scan 1024 1.0
"""

from __future__ import annotations

from collections import deque
from typing import Any

from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.counterparts.program import UsageError, spin_program
from robolink.counterparts.topic_tools.topic_tool import TopicTool, numbered
from robolink.parameters.descriptors import described

MESSAGES = "throttle messages INTOPIC MESSAGES_PER_SECOND [OUTTOPIC]"
BYTES = "throttle bytes INTOPIC BYTES_PER_SECOND WINDOW [OUTTOPIC]"


class Throttle(TopicTool):
    """A node that passes on some messages. `options` are those of `TopicTool`."""

    def __init__(self, **options: Any) -> None:
        super().__init__("throttle", **options)

    def set_up(self) -> None:
        """Declare the topics and the limits."""
        self.declare_topics("_throttle")
        kind = self.needed("throttle_type", "messages or bytes", "")
        words = "use this machine's clock, also where time is simulated"
        wall = self.declare_parameter("use_wall_clock", False, described(words)).value
        system = Clock(clock_type=ClockType.SYSTEM_TIME, time_base=self.context.time)
        self._clock_used = system if wall else self.get_clock()
        self._period = self._limit = 0.0
        if kind == "messages":
            self._period = 1e9 / self._positive("msgs_per_sec", "messages per second")
        elif kind == "bytes":
            self._limit = self._positive("bytes_per_sec", "bytes per second")
            self._window = self._positive("window", "seconds of which the bytes are counted")
        else:
            raise UsageError(f"throttle_type: expected messages or bytes, got '{kind}'")
        self._last = self._now()
        self._sent: deque[tuple[int, int]] = deque()

    def _positive(self, name: str, words: str) -> float:
        value = float(self.needed(name, words, 0.0))
        if not 0.0 < value < 1e18:
            raise UsageError(f"{name}: expected a number above 0, got {value:g}")
        return value

    def _now(self) -> int:
        return self._clock_used.now().nanoseconds

    def on_message(self, payload: bytes) -> None:
        """Pass on a message if there is room for it."""
        if self._is_time() if self._period else self._is_room(len(payload)):
            self.pass_on(payload)

    def _is_time(self) -> bool:
        now = self._now()
        if self._last > now:
            self.get_logger().warning("Detected jump back in time, resetting throttle period to now for.")
            self._last = now
        if now - self._last < self._period:
            return False
        self._last = now
        return True

    def _is_room(self, size: int) -> bool:
        now = self._now()
        while self._sent and self._sent[0][0] < now - self._window * 1e9:
            self._sent.popleft()
        if sum(each for _, each in self._sent) >= self._limit:
            return False
        self._sent.append((now, size))
        return True


def parameters(words: list[str]) -> dict[str, Any]:
    """Return the parameters of a command line. Raises UsageError."""
    if not words:
        return {}
    kind, *rest = words
    first = ("input_topic", str)
    if kind == "messages" and rest:
        given = numbered(rest, MESSAGES, first, ("msgs_per_sec", float), optional="output_topic")
    elif kind == "bytes" and rest:
        kinds = (first, ("bytes_per_sec", int), ("window", float))
        given = numbered(rest, BYTES, *kinds, optional="output_topic")
    else:
        raise UsageError(f"expected {MESSAGES}, or {BYTES}")
    return {"throttle_type": kind, **given}


def main(args: list[str] | None = None) -> None:
    """Pass on messages until Ctrl-C."""
    spin_program(lambda words: Throttle(parameters=parameters(words)), args)


if __name__ == "__main__":
    main()
