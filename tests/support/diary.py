"""Process that publishes numbers at a steady rate and notes when those of others came: for tests of reunions.

    python -m tests.support.diary NAME [--others NAME ...] [--rate HZ] [--keep-all] [--depth N]

It prints `ready` once it hears the others. `hear SECONDS` on its standard input waits until more has come. `report`
prints what was sent and heard, as JSON: for each other process pairs of a number and the seconds (of the machine's
clock) at which it came. `end` ends it.
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
from robolink.interfaces.std_msgs.msg import Int64
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Diary(robolink.Node):
    """Publishes 0, 1, 2 ... on /NAME, latches every hundredth on /NAME/latched, and notes what the others publish."""

    def __init__(self, name: str, others: list[str], rate: float, qos: QoSProfile) -> None:
        super().__init__(name)
        self._sent: list[float] = []
        self.longest = 0.0
        self.heard: dict[str, list[tuple[int, float]]] = {}
        self._publisher = self.create_publisher(Int64, name, qos)
        self._latched = self.create_publisher(Int64, f"{name}/latched", LATCHED)
        for other in others:
            self._note(other, qos)
            self._note(f"{other}/latched", LATCHED)
        self._ears = list(self.subscriptions)
        self.create_timer(1 / rate, self._write)

    def _note(self, topic: str, qos: QoSProfile) -> None:
        entries = self.heard.setdefault(topic, [])
        self.create_subscription(Int64, topic, lambda number: entries.append((number.data, time.time())), qos)

    def _write(self) -> None:
        number, begin = len(self._sent), time.time()
        self._publisher.publish(Int64(data=number))
        if number % 100 == 0:
            self._latched.publish(Int64(data=number))
        self.longest = max(self.longest, time.time() - begin)
        self._sent.append(begin)

    def hear_on(self, longest: float) -> None:
        """Wait, so long at most, until a hundred more of each have come."""
        counts, deadline = {name: len(each) for name, each in self.heard.items()}, time.monotonic() + longest
        while time.monotonic() < deadline and any(
            len(self.heard[name]) < count + (1 if name.endswith("/latched") else 100) for name, count in counts.items()
        ):
            time.sleep(0.01)

    def report(self) -> dict[str, Any]:
        """Return what was sent and heard, for JSON."""
        missed = [each.lost + each.dropped for each in self._ears if not each.topic_name.endswith("/latched")]
        return {"sent": self._sent, "longest": self.longest, "heard": self.heard, "told": sum(missed)}


def main() -> None:
    """Keep one diary."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name")
    parser.add_argument("--others", nargs="*", default=[])
    parser.add_argument("--rate", type=float, default=100.0)
    parser.add_argument("--keep-all", action="store_true")
    parser.add_argument("--depth", type=int, default=10)
    asked = parser.parse_args()
    qos = QoSProfile(history=HistoryPolicy.KEEP_ALL) if asked.keep_all else QoSProfile(depth=asked.depth)
    robolink.init(args=[])
    node = Diary(asked.name, asked.others, asked.rate, qos)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    while not all(node.heard[other] for other in asked.others):
        time.sleep(0.01)
    print("ready", flush=True)  # noqa: T201
    for line in map(str.strip, sys.stdin):
        if line.startswith("hear "):
            node.hear_on(float(line.split()[1]))
            print("heard", flush=True)  # noqa: T201
        elif line == "report":
            print(json.dumps(node.report()), flush=True)  # noqa: T201
        else:
            break
    executor.shutdown()
    robolink.shutdown()


if __name__ == "__main__":
    main()
