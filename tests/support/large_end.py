"""Process that publishes or receives large messages whose content shows which message it is: for tests of large ones.

    python -m tests.support.large_end publish|receive [--kind depth|all|latched] [--bytes N] [--busy SECONDS]

Each message holds its number, and else one byte that depends on it. A receiver compares that with the number in the
attachment, which never comes through shared memory. Both print `ready`, then obey their standard input, line by line:
a number has a publisher send so many (0: until the next line), `report` prints a receiver's counts as JSON.
"""

from __future__ import annotations

import argparse
import json
import sys
import threading
import time
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
        self.received, self.wrong, self.late = 0, 0, 0
        self.first, self.last, self.told, self.limited = 0, 0, 0, 0
        self._size, self._busy = size, busy

    def hear(self, payload: bytes, info: MessageInfo) -> None:
        """Check a serialized message, and be busy for a while."""
        number, body = info["publication_sequence_number"] or 0, payload[-self._size :]
        filling = body[NUMBER:]
        self.received += 1
        right = int.from_bytes(body[:NUMBER], "little") == number and filling == filling[:1] * len(filling)
        self.wrong += not (right and filling[0] == number % FILLINGS)
        self.first = self.first or number
        self.last = max(self.last, number)
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


def publish(publisher: Publisher[Any], size: int) -> None:
    """Send what the standard input asks for, and say how many there were."""
    count, go_on, asked = 0, threading.Event(), threading.Event()
    wanted = [0]

    def obey() -> None:
        for line in sys.stdin:
            go_on.set()
            wanted[0] = int(line)
            asked.set()
        wanted[0] = -1
        go_on.set()
        asked.set()

    threading.Thread(target=obey, daemon=True).start()
    while True:
        asked.wait()
        asked.clear()
        go_on.clear()
        left = wanted[0]
        if left < 0:
            return
        endless = left == 0
        while (endless and not go_on.is_set()) or left:
            count += 1
            publisher.publish(UInt8MultiArray(data=content(count, size)))
            left -= not endless and 1
            if not endless:
                time.sleep(0.02)
        print(count, flush=True)  # noqa: T201


def receive(node: robolink.Node, kind: str, size: int, busy: float) -> None:
    """Receive until the standard input asks for the report."""
    counts = Counts(size, busy)

    def lost(info: Any) -> None:
        counts.told = info.total_count

    events = SubscriptionEventCallbacks(message_lost=lost)
    add_handler(counts.read)
    subscription = node.create_subscription(
        UInt8MultiArray, TOPIC, counts.hear, PROFILES[kind], raw=True, event_callbacks=events
    )
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    print("ready", flush=True)  # noqa: T201
    for _ in sys.stdin:
        shown = {name: value for name, value in vars(counts).items() if not name.startswith("_")}
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
        receive(node, asked.kind, asked.bytes, asked.busy)
    else:
        publisher = node.create_publisher(UInt8MultiArray, TOPIC, PROFILES[asked.kind])
        while publisher.get_subscription_count() < asked.receivers:
            time.sleep(0.005)
        print("ready", flush=True)  # noqa: T201
        publish(publisher, asked.bytes)
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
