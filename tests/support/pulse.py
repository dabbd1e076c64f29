"""Process that publishes at a steady rate, receives from others, and reports delays and gaps: for tests of stalls.

    python -m tests.support.pulse NAME [--others NAME ...] [--rate HZ] [--bytes N] [--keep-all] [--latched N]

It prints `ready` once it knows the others, and then does what it is told on its standard input, line by line: `mark`
has its messages count from now on, `join` subscribes to what somebody has latched and prints after how many seconds
that came, `stop` publishes no more, `report` prints what was sent and heard, as JSON, and ends it.
"""

from __future__ import annotations

import argparse
import json
import sys
import threading
import time
from typing import Any

import robolink
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.std_msgs.msg import Header, UInt8MultiArray
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.subscription import Subscription

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
JOIN_WITHIN = 30.0
"""Seconds after which a latched message counts as lost."""


COUNTS = "counts "
"""How the text of a message begins that was sent after the mark."""


class Heard:
    """What came from one other process after its mark: how many, how late, with which pauses; times in seconds."""

    def __init__(self) -> None:
        self.count, self.latest, self.pause = 0, 0.0, 0.0
        self._last: float | None = None

    def hear(self, sent: float, now: float) -> None:
        """Count a message."""
        self.count += 1
        self.latest = max(self.latest, now - sent)
        self.be_silent(now)
        self._last = now

    def be_silent(self, now: float) -> None:
        """Count the time since the last message as a pause."""
        self.pause = max(self.pause, 0.0 if self._last is None else now - self._last)


class Pulse(robolink.Node):
    """Publishes on /NAME and hears the others."""

    def __init__(self, name: str, others: list[str], rate: float, size: int, qos: QoSProfile) -> None:
        super().__init__(name)
        self._size, self._text = size, "x" * size
        self._sent, self._blocked = 0, 0.0
        self._heard = {other: Heard() for other in others}
        self._publisher = self.create_publisher(Header, name, qos)
        self.ears = {other: self._listen(other, qos) for other in others}
        self._clockwork = self.create_timer(1 / rate, self._beat)

    def _listen(self, other: str, qos: QoSProfile) -> Subscription[Header]:
        return self.create_subscription(Header, other, lambda header: self._hear(other, header), qos)

    def mark(self) -> None:
        """Have what is sent from now on count."""
        self._text = COUNTS + "x" * self._size

    def stop(self) -> None:
        """Publish no more; a silence that lasts until now is a pause."""
        self._clockwork.cancel()
        for heard in self._heard.values():
            heard.be_silent(time.time())

    def _beat(self) -> None:
        now = time.time()
        stamp = Time(sec=int(now), nanosec=int(now % 1 * 1e9))
        text, begin = self._text, time.perf_counter()
        self._publisher.publish(Header(stamp=stamp, frame_id=text))
        self._blocked = max(self._blocked, time.perf_counter() - begin)
        self._sent += text.startswith(COUNTS)

    def _hear(self, other: str, header: Header) -> None:
        if header.frame_id.startswith(COUNTS):
            self._heard[other].hear(header.stamp.sec + header.stamp.nanosec / 1e9, time.time())

    def report(self) -> dict[str, Any]:
        """Return what was sent and heard, for JSON."""
        return {
            "sent": self._sent,
            "blocked": self._blocked,
            "heard": {
                other: {
                    "count": heard.count,
                    "told": self.ears[other].lost,
                    "latest": heard.latest,
                    "pause": heard.pause,
                }
                for other, heard in self._heard.items()
            },
        }

    def join(self) -> float:
        """Subscribe to what is latched; returns the seconds until it came."""
        came, begin = threading.Event(), time.perf_counter()
        subscription = self.create_subscription(UInt8MultiArray, "latched", lambda _: came.set(), LATCHED)
        came.wait(JOIN_WITHIN)
        took = time.perf_counter() - begin
        self.destroy_subscription(subscription)
        return took


def main() -> None:
    """Be one pulse."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name")
    parser.add_argument("--others", nargs="*", default=[])
    parser.add_argument("--rate", type=float, default=50.0)
    parser.add_argument("--bytes", type=int, default=0)
    parser.add_argument("--keep-all", action="store_true")
    parser.add_argument("--latched", type=int, default=0)
    asked = parser.parse_args()
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL) if asked.keep_all else QoSProfile(depth=10)
    robolink.init(args=[])
    node = Pulse(asked.name, asked.others, asked.rate, asked.bytes, qos)
    if asked.latched:
        node.create_publisher(UInt8MultiArray, "latched", LATCHED).publish(UInt8MultiArray(data=bytes(asked.latched)))
    while any(node.count_publishers(other) == 0 for other in asked.others):
        time.sleep(0.01)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    say("ready")
    obey(node)
    executor.shutdown()
    robolink.shutdown()


def obey(node: Pulse) -> None:
    """Do what the standard input says, until it asks for the report."""
    for line in map(str.strip, sys.stdin):
        if line == "mark":
            node.mark()
        elif line == "stop":
            node.stop()
        elif line == "join":
            say(node.join())
        elif line == "report":
            say(json.dumps(node.report()))
            return


def say(what: object) -> None:
    """Answer whoever started this."""
    print(what, flush=True)  # noqa: T201


if __name__ == "__main__":
    main()
