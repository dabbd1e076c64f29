"""Participant of RTPS that obeys its standard input.

    python -m tests.support.rtps_end NAME [--interface I] [--peer P]... [--range R] [--hertz H] [--rough]

It writes and reads one topic, BEST_EFFORT if --rough, and prints `ready`. For each line it prints as JSON whom it
knows, and how many samples it has heard from whom; it writes another burst of all sizes if the line is `burst`.
"""

from __future__ import annotations

import argparse
import json
import selectors
import sys
import time
from collections import Counter

from robolink.rtps import Info, Participant, Qos, Range, Reach

DOMAIN = 20
TOPIC, TYPE = "rt/ends", "std_msgs::msg::dds_::String_"
HEADER = b"\0\1\0\0"


class End:
    """A participant with a writer and a reader."""

    def __init__(self, name: str, reach: Reach, qos: Qos) -> None:
        self.heard = Counter[str]()
        self.participant = Participant(DOMAIN, name=name, reach=reach)
        self._writer = self.participant.writer(TOPIC, TYPE, qos)
        self._reader = self.participant.reader(TOPIC, TYPE, qos, self._hear)
        self._name = name.encode()

    def _hear(self, payload: bytes, _info: Info) -> None:
        self.heard[bytes(payload).removeprefix(HEADER).split(b"\0", 1)[0].decode()] += 1

    def write(self, size: int = 0) -> None:
        """Write a sample that says our name."""
        self._writer.put(HEADER + self._name + b"\0" + bytes(size))

    def report(self) -> str:
        """Return whom we know and have heard."""
        peers = sorted(peer.name for peer in self.participant.peers())
        endpoints = self.participant.endpoints()
        topics = sorted({endpoint.topic for endpoint in endpoints})
        return json.dumps({"peers": peers, "heard": self.heard, "endpoints": len(endpoints), "topics": topics})


def main() -> None:
    """Write, and obey."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name")
    parser.add_argument("--interface", default="")
    parser.add_argument("--peer", action="append", default=[])
    parser.add_argument("--range", type=Range, default=Range.SUBNET)
    parser.add_argument("--rough", action="store_true")
    parser.add_argument("--hertz", type=float, default=20.0)
    requested = parser.parse_args()
    reach = Reach(requested.interface, tuple(requested.peer), requested.range)
    end = End(requested.name, reach, Qos(reliable=not requested.rough, depth=100))
    print("ready", flush=True)  # noqa: T201
    chosen = selectors.DefaultSelector()
    chosen.register(sys.stdin, selectors.EVENT_READ)
    due = time.monotonic()
    while True:
        if chosen.select(max(due - time.monotonic(), 0.0)):
            line = sys.stdin.readline()
            if not line:
                return
            if line.strip() == "burst":
                for size in (0, 100, 10_000, 100_000, 1_000_000):
                    end.write(size)
            print(end.report(), flush=True)  # noqa: T201
        elif time.monotonic() >= due:
            due += 1 / requested.hertz
            end.write()


if __name__ == "__main__":
    main()
