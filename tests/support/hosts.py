"""Helpers for tests of hosts: node files, nodes to run, and the hash of all that is published.

    python -m tests.support.hosts SECONDS FILE ...

prints the hash of what these programs publish in so many seconds, for comparing processes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from robolink import Node, logging
from robolink.host import Host, Program
from robolink.host.trace import Trace
from robolink.interfaces.std_msgs.msg import Int32
from robolink.launch.shared_process import Member
from robolink.qos import QoSProfile
from robolink.transport import Transport
from robolink.transport.base import NumberingOutlet
from robolink.transport.memory import Bus, MemoryTransport


class Counter(Node):
    """Publishes 1, 2, 3 ... ten times a second."""

    def __init__(self) -> None:
        super().__init__("counter")
        self.count = 0
        self.numbers = self.create_publisher(Int32, "numbers", 10)
        self.timer = self.create_timer(0.1, self.tick)

    def tick(self) -> None:
        self.count += 1
        self.numbers.publish(Int32(data=self.count))


class Listener(Node):
    """Notes the numbers, and when they came, in seconds of its clock."""

    def __init__(self) -> None:
        super().__init__("listener")
        self.heard = list[int]()
        self.times = list[float]()
        self.create_subscription(Int32, "numbers", self.hear, 10)

    def hear(self, message: Int32) -> None:
        self.heard.append(message.data)
        self.times.append(self.get_clock().now().nanoseconds / 1e9)


class TracedTransport(MemoryTransport):
    """A session that notes what it publishes."""

    def __init__(self, bus: Bus, trace: Trace) -> None:
        super().__init__(bus=bus)
        self.trace = trace

    def advertise(self, key: str, qos: QoSProfile) -> NumberingOutlet:
        return self.trace.tapped(key, super().advertise(key, qos))


class Stage:
    """Writes node files into a folder, and starts them in a host."""

    def __init__(self, folder: Path, host: Host) -> None:
        self.folder, self.host = folder, host

    def write(self, name: str, text: str) -> Path:
        path = self.folder / f"{name}.py"
        path.write_text(text)
        return path

    def start(self, name: str, text: str, *args: str, env: dict[str, str] | None = None) -> Program:
        """Start a program of one node file."""
        return self.host.start(name, [Member(name, str(self.write(name, text)), list(args))], env=env)


def traced(seconds: float, start: Callable[[Host], Any]) -> tuple[str, dict[str, int]]:
    """Give the hash of all that is published in so many seconds, and how many messages each topic had."""
    trace, bus = Trace(), Bus()

    def connect(name: str) -> Transport:
        return TracedTransport(bus, trace)

    with Host(connect=connect) as host:
        host.bus = bus
        start(host)
        host.run(seconds)
    return trace.hexdigest(), trace.messages


def start_files(host: Host, files: list[str]) -> None:
    for each in files:
        host.start(Path(each).stem, [Member(Path(each).stem, each, [])])


if __name__ == "__main__":
    logging.set_console_handler(None)
    digest, counts = traced(float(sys.argv[1]), lambda host: start_files(host, sys.argv[2:]))
    sys.stdout.write(f"{digest} {sum(counts.values())}\n")
