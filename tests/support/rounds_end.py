"""Process under load that numbers what it publishes and counts what it hears: one machine of `tests.support.rounds`.

    python -m tests.support.rounds_end NAME --others NAME ... [--life N] [--camera]

It publishes on RELIABLE topics at 100 Hz, one KEEP_ALL and one that keeps ten, with `--camera` also images of 60 kB at
15 Hz, and calls the others' services without a pause. It prints `ready` once it hears the others. Lines on its standard
input: `hear` waits until something new has come from each of the others, `stop` publishes no more and prints the last
number of each topic, as JSON, `await` and these numbers, of all of them, waits until they have come, `report` prints
the counts as JSON, `end` ends it.
"""

from __future__ import annotations

import argparse
import functools
import json
import sys
import threading
import time
from typing import Any

import robolink
from robolink.event_handler import CountedInfo, SubscriptionEventCallbacks
from robolink.exceptions import RobolinkError
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.qos import HistoryPolicy, QoSProfile

TEN = QoSProfile(depth=10)
CAMERA = "camera"
IMAGE = "x" * 60_000
TOPICS = {"all": QoSProfile(history=HistoryPolicy.KEEP_ALL), "ten": TEN, CAMERA: TEN}
"""Kinds of topics, each `/NAME/KIND`, with their quality of service: all of them RELIABLE."""

RATES = {"all": 100.0, "ten": 100.0, CAMERA: 15.0}
LIFE = 1_000_000_000
"""First number of one life of a process; the next life of its name begins with twice as much."""

CALL_WITHIN = 2.0
"""Timeout of a call, in seconds."""


class Ear:
    """A subscription's counts; a number stands for the life of its sender, and for which of its messages."""

    def __init__(self) -> None:
        self.numbers: set[int] = set()
        self.doubled = self.announced = 0

    def hear(self, number: int) -> None:
        """Count a message."""
        self.doubled += number in self.numbers
        self.numbers.add(number)

    def announce(self, status: CountedInfo) -> None:
        """Note how many are counted as lost."""
        self.announced = status.total_count

    def lives(self) -> dict[int, tuple[int, int, int]]:
        """Return for each life of the sender its first and last number that came, and how many."""
        found: dict[int, list[int]] = {}
        for each in self.numbers:
            found.setdefault(each // LIFE, []).append(each % LIFE)
        return {life: (min(each), max(each), len(each)) for life, each in found.items()}


class End(robolink.Node):
    """Publishes, hears, serves and calls."""

    def __init__(self, name: str, others: list[str], life: int, kinds: list[str]) -> None:
        super().__init__(name)
        self._base = life * LIFE
        self.sent = dict.fromkeys(kinds, 0)
        self.longest = 0.0
        self.calls = {"answered": 0, "failed": 0}
        self.ears: dict[str, Ear] = {}
        self._publishing, self._is_over = threading.Lock(), threading.Event()
        for kind in kinds:
            publisher = self.create_publisher(Header, f"{name}/{kind}", TOPICS[kind])
            self.create_timer(1 / RATES[kind], functools.partial(self._publish, kind, publisher))
        for other in others:
            for kind in TOPICS:
                self._listen(f"{other}/{kind}", kind)
        self.create_service(Trigger, f"{name}/ask", lambda _, response: response)
        for other in others:
            threading.Thread(target=self._call_on, args=(f"{other}/ask",), daemon=True).start()

    def _publish(self, kind: str, publisher: Any) -> None:
        with self._publishing:
            if self._is_over.is_set():
                return
            number, begin = self._base + self.sent[kind], time.monotonic()
            publisher.publish(Header(frame_id=f"{number} {IMAGE if kind == CAMERA else ''}"))
            self.longest = max(self.longest, time.monotonic() - begin)
            self.sent[kind] += 1

    def _listen(self, topic: str, kind: str) -> None:
        ear = self.ears[topic] = Ear()
        told = SubscriptionEventCallbacks(message_lost=ear.announce)
        self.create_subscription(
            Header, topic, lambda header: ear.hear(int(header.frame_id.split()[0])), TOPICS[kind], event_callbacks=told
        )

    def _call_on(self, service: str) -> None:
        client = self.create_client(Trigger, service)
        while not self._is_over.is_set():
            try:
                client.call(Trigger.Request(), timeout_sec=CALL_WITHIN)
            except (RobolinkError, TimeoutError):
                self.calls["failed"] += 1
            else:
                self.calls["answered"] += 1

    def wait(self, others: list[str]) -> None:
        """Wait until something has come from each of the others on a topic that all of them have, from now on."""
        ears = [self.ears[f"{other}/{kind}"] for other in others for kind in ("all", "ten")]
        before = [len(each.numbers) for each in ears]
        while any(len(ear.numbers) <= count for ear, count in zip(ears, before, strict=True)):
            time.sleep(0.005)

    def stop(self) -> dict[str, int]:
        """Publish and call no more; return the last number of each topic."""
        with self._publishing:
            self._is_over.set()
        return {f"{self.get_name()}/{kind}": self._base + count - 1 for kind, count in self.sent.items()}

    def await_last(self, last: dict[str, int]) -> None:
        """Wait until these have come."""
        while not all(last[topic] in ear.numbers for topic, ear in self.ears.items() if topic in last):
            time.sleep(0.005)

    def report(self) -> dict[str, Any]:
        """Return what was sent and heard, for JSON."""
        return {
            "life": self._base // LIFE,
            "sent": self.sent,
            "longest": self.longest,
            "calls": self.calls,
            "heard": {
                topic: {"lives": ear.lives(), "doubled": ear.doubled, "announced": ear.announced}
                for topic, ear in self.ears.items()
            },
        }


def main() -> None:
    """Run one end."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name")
    parser.add_argument("--others", nargs="+", default=[])
    parser.add_argument("--life", type=int, default=0)
    parser.add_argument("--camera", action="store_true")
    asked = parser.parse_args()
    robolink.init(args=[])
    kinds = [each for each in TOPICS if each != CAMERA or asked.camera]
    node = End(asked.name, asked.others, asked.life, kinds)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    node.wait(asked.others)
    print("ready", flush=True)  # noqa: T201
    for line in map(str.strip, sys.stdin):
        if line == "hear":
            node.wait(asked.others)
            print("heard", flush=True)  # noqa: T201
        elif line == "stop":
            print(json.dumps(node.stop()), flush=True)  # noqa: T201
        elif line.startswith("await "):
            node.await_last(json.loads(line.removeprefix("await ")))
            print("last", flush=True)  # noqa: T201
        elif line == "report":
            print(json.dumps(node.report()), flush=True)  # noqa: T201
        else:
            break
    executor.shutdown()
    robolink.shutdown()


if __name__ == "__main__":
    main()
