"""Process with several nodes that publish at a steady rate and count what they hear: for measurements of large systems.

    python -m tests.support.swarm NODE [NODE ...] [--hear NODE ...] [--talk HZ]

It prints `made` with what it has cost so far once its nodes are there, as JSON, and then does what it is told on its
standard input, line by line: `seen N` answers when it sees N nodes, `talk RATE SECONDS` publishes with all
its nodes, `flood NODE SECONDS` with the one of this number as fast as it can; `heard` answers with what has come since.
With `--talk` it publishes until it is ended, and is told nothing.
"""

from __future__ import annotations

import argparse
import functools
import json
import sys
import threading
import time
from collections.abc import Sequence
from typing import Any

import robolink
from robolink.executors import SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Header
from robolink.wire import EndpointKind
from tests.support.pulse import say

LOOK_EVERY = 0.2
"""Interval in seconds at which the number of nodes is looked at."""

TEXT = "x" * 80
"""Filling of a message, beside its time."""

A_DAY = 86_400.0


class Swarm:
    """Nodes of one process: each publishes on /NODE/state, and hears one node elsewhere."""

    def __init__(self, names: Sequence[str], heard: Sequence[str]) -> None:
        self._sent = 0
        self._nodes = [robolink.Node(name) for name in names]
        self._publishers = [node.create_publisher(Header, f"{node.get_name()}/state", 100) for node in self._nodes]
        self._delays: dict[str, list[float]] = {other: [] for other in heard}
        self._ears = [
            node.create_subscription(Header, f"{other}/state", functools.partial(self._hear, other), 1000)
            for node, other in zip(self._nodes, heard, strict=False)
        ]
        self._executor = SingleThreadedExecutor()
        for node in self._nodes:
            self._executor.add_node(node)
        threading.Thread(target=self._executor.spin, daemon=True).start()

    def _hear(self, other: str, header: Header) -> None:
        self._delays[other].append(time.monotonic() - float(header.frame_id[len(TEXT) :]))

    def await_nodes(self, number: int) -> None:
        """Wait until so many nodes are seen, and the topic of each."""
        graph = self._nodes[0].context.graph  # asked directly: fifty processes that sort names are a load by themselves
        while len(graph.nodes()) < number:
            time.sleep(LOOK_EVERY)
        while sum(each.name.endswith("/state") for each in graph.endpoints(EndpointKind.PUBLISHER)) < number:
            time.sleep(LOOK_EVERY)

    def _publish(self, node: int) -> None:
        self._publishers[node].publish(Header(frame_id=f"{TEXT}{time.monotonic()}"))
        self._sent += 1

    def talk(self, rate: float, seconds: float) -> None:
        """Publish with all nodes, at a rate in Hz, for so many seconds."""
        begin = time.monotonic()
        for number in range(int(rate * seconds)):
            time.sleep(max(0.0, begin + number / rate - time.monotonic()))
            for node in range(len(self._publishers)):
                self._publish(node)

    def flood(self, node: int, seconds: float) -> None:
        """Publish with one node as fast as it can, for so many seconds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self._publish(node)

    def heard(self) -> dict[str, Any]:
        """Return the number of messages sent since the last time, and the delays in seconds of those heard, by node."""
        found = {"sent": self._sent, "heard": {other: list(delays) for other, delays in self._delays.items()}}
        self._sent = 0
        for delays in self._delays.values():
            delays.clear()
        return found

    def close(self) -> None:
        """End the nodes."""
        self._executor.shutdown()
        robolink.shutdown()


def main() -> None:
    """Run one process of a swarm."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="+", metavar="NODE")
    parser.add_argument("--hear", nargs="*", default=[], metavar="NODE")
    parser.add_argument("--talk", type=float, metavar="HZ")
    asked = parser.parse_args()
    robolink.init(args=[])
    swarm = Swarm(asked.names, asked.hear)
    say(json.dumps(cost() | {"made": True}))
    if asked.talk:
        swarm.talk(asked.talk, A_DAY)
    for line in sys.stdin:
        obey(swarm, line.split())
    swarm.close()


def cost() -> dict[str, Any]:
    """Return the time, and the CPU time of this process so far, in seconds."""
    return {"time": time.monotonic(), "cpu": time.process_time()}


def obey(swarm: Swarm, words: list[str]) -> None:
    """Do what one line of the standard input says."""
    match words:
        case ["seen", number]:
            swarm.await_nodes(int(number))
            say(json.dumps(cost()))
        case ["talk", rate, seconds]:
            swarm.talk(float(rate), float(seconds))
        case ["flood", node, seconds]:
            swarm.flood(int(node), float(seconds))
        case ["heard"]:
            say(json.dumps(swarm.heard()))


if __name__ == "__main__":
    main()
