"""Process that publishes or receives large messages whose content shows which message it is: for tests of large ones.

    python -m tests.support.large_end publish|receive [--kind depth|all|latched] [--bytes N] [--busy SECONDS]

Each message holds its number, and else one byte that depends on it. A receiver compares that with the number in the
attachment, which never comes through shared memory. Both print `ready`, then obey their standard input, line by line:
a number has each publisher of the process send so many (0: until the next line), `report` prints a receiver's counts
as JSON, those of the numbers from the first to the last of each publisher.
"""

from __future__ import annotations

import argparse
import json
import sys
import threading
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import robolink
from robolink.event_handler import SubscriptionEventCallbacks
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import UInt8MultiArray
from robolink.logging import Record, add_handler
from robolink.publisher import Publisher
from robolink.qos import DurabilityPolicy, HistoryPolicy, QoSProfile
from robolink.subscription import MessageInfo
from robolink.transport import shared_memory

TOPIC = "large"
PROFILES = {
    "depth": QoSProfile(depth=10),
    "all": QoSProfile(history=HistoryPolicy.KEEP_ALL),
    "latched": QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL),
}
NUMBER = 8
"""Bytes of the number with which the content begins."""
FILLINGS = 13
"""Number of different contents, apart from the number."""


def content(number: int, size: int) -> bytes:
    """Return the content of a message."""
    return number.to_bytes(NUMBER, "little") + bytes([number % FILLINGS]) * (size - NUMBER)


class Counts:
    """Deliveries of a receiver: how much, and of it what was not the message that its attachment names."""

    def __init__(self, size: int, busy: float) -> None:
        self.received, self.wrong, self.told, self.limited = 0, 0, 0, 0
        self._size, self._busy = size, busy
        self._first: dict[Any, int] = {}
        self._last: dict[Any, int] = {}

    @property
    def sent(self) -> int:
        """Number of messages of all publishers, from the first of each that was received to its last."""
        return sum(last - self._first[sender] + 1 for sender, last in [*self._last.items()])

    def hear(self, payload: bytes, info: MessageInfo) -> None:
        """Check a serialized message, and be busy for a while."""
        number, body = info["publication_sequence_number"] or 0, payload[-self._size :]
        filling = body[NUMBER:]
        self.received += 1
        right = int.from_bytes(body[:NUMBER], "little") == number and filling == filling[:1] * len(filling)
        self.wrong += not (right and filling[0] == number % FILLINGS)
        sender = (info["publisher_gid"] or {}).get("data")
        self._first.setdefault(sender, number)
        self._last[sender] = max(self._last.get(sender, 0), number)
        time.sleep(self._busy)

    def read(self, record: Record) -> None:
        """Note the line by which the session says that it takes no more memory of new publishers."""
        self.limited = self.limited or int(record.file == shared_memory.__file__)


def memory(field: str) -> int:
    """Return a field of this process's memory in kB, such as VmLck; 0 where the system does not tell."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return 0
    return next((int(each.split()[1]) for each in lines if each.startswith(f"{field}:")), 0)


class Senders:
    """Publishers of a process, each of which sends on a thread of its own."""

    def __init__(self, publishers: Sequence[Publisher[Any]], size: int) -> None:
        self._publishers, self._size = publishers, size
        self._counts = [0] * len(publishers)
        self._is_stopped = threading.Event()

    def obey(self) -> None:
        """Send what the standard input asks for, and say each time how many there were so far."""
        job: threading.Thread | None = None
        for line in sys.stdin:
            self._end(job)
            job = threading.Thread(target=self._send_all, args=(int(line),))
            job.start()
        self._end(job)

    def _end(self, job: threading.Thread | None) -> None:
        if job is not None:
            self._is_stopped.set()
            job.join()
            self._is_stopped.clear()

    def _send_all(self, count: int) -> None:
        threads = [threading.Thread(target=self._send, args=(each, count)) for each in range(len(self._counts))]
        for each in threads:
            each.start()
        for each in threads:
            each.join()
        print(sum(self._counts), flush=True)  # noqa: T201

    def _send(self, place: int, left: int) -> None:
        is_endless = not left
        while left or (is_endless and not self._is_stopped.is_set()):
            self._counts[place] += 1
            data = content(self._counts[place], self._size)
            self._publishers[place].publish(UInt8MultiArray(data=data))
            if not is_endless:
                left -= 1
                time.sleep(0.02)


def receive(node: robolink.Node, kind: str, size: int, busy: float, *, is_idle: bool) -> None:
    """Receive, unless it is idle, and report what came whenever the standard input asks."""
    counts = Counts(size, busy)

    def lost(info: Any) -> None:
        counts.told = info.total_count

    events = SubscriptionEventCallbacks(message_lost=lost)
    add_handler(counts.read)
    subscription = node.create_subscription(
        UInt8MultiArray, TOPIC, counts.hear, PROFILES[kind], raw=True, event_callbacks=events
    )
    executor = SingleThreadedExecutor()
    if not is_idle:
        executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    print("ready", flush=True)  # noqa: T201
    for _ in sys.stdin:
        shown = {name: value for name, value in vars(counts).items() if not name.startswith("_")}
        shown["sent"] = counts.sent
        limits = {"locked": memory("VmLck"), "resident": memory("VmRSS")}
        kept = {"lost": subscription.lost, "dropped": subscription.dropped}
        print(json.dumps(shown | limits | kept), flush=True)  # noqa: T201
    executor.shutdown()


def main() -> None:
    """Play one end."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("role", choices=("publish", "receive"))
    parser.add_argument("--kind", choices=PROFILES, default="depth")
    parser.add_argument("--bytes", type=int, default=1_000_000)
    parser.add_argument("--busy", type=float, default=0.0)
    parser.add_argument("--idle", action="store_true")
    parser.add_argument("--publishers", type=int, default=1)
    parser.add_argument("--receivers", type=int, default=1)
    parser.add_argument("--unchecked", action="store_true")
    parser.add_argument("--pools", type=int, default=shared_memory.MOST_POOLS)
    asked = parser.parse_args()
    shared_memory.MOST_POOLS = asked.pools
    if asked.unchecked:
        _check_nothing()
    robolink.init(args=[])
    node = robolink.Node(f"{asked.role}r")
    if asked.role == "receive":
        receive(node, asked.kind, asked.bytes, asked.busy, is_idle=asked.idle)
    else:
        profile = PROFILES[asked.kind]
        publishers = [node.create_publisher(UInt8MultiArray, TOPIC, profile) for _ in range(asked.publishers)]
        while publishers[0].get_subscription_count() < asked.receivers:
            time.sleep(0.005)
        print("ready", flush=True)  # noqa: T201
        Senders(publishers, asked.bytes).obey()
    robolink.shutdown()


def _check_nothing() -> None:
    """Take the check away, to show what it is for."""
    from robolink.transport import zenoh
    from robolink.transport.base import Sample

    def read(_: Any, arrived: Any) -> Any:
        if isinstance(arrived, Sample):
            return arrived
        return Sample(arrived.payload.to_bytes(), arrived.attachment.to_bytes())

    setattr(zenoh.ZenohTransport, "read", read)  # noqa: B010 - a method cannot be assigned, by its type


if __name__ == "__main__":
    main()
