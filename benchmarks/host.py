"""Benchmark of a host in virtual time: cost of a callback in a chain of three nodes, as classes and as scripts.

    python benchmarks/host.py [--seconds 600] [--runs 3]

Each node is a program of its own; what it publishes is encoded and decoded. `waiting` are scripts that sleep and call
services, for which threads are switched: microseconds for each time that a thread hands on to another.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

from robolink import logging
from robolink.host import Host
from robolink.launch.shared_process import Member

NODE = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64

class Link(Node):
    def __init__(self):
        super().__init__("{name}")
        self.out = self.create_publisher(Float64, "{name}", 10)
        {source}

    def pass_on(self, message=None):
        self.out.publish(Float64(data=1.0 if message is None else message.data))
"""
MAIN = """
def main():
    rclpy.init()
    rclpy.spin(Link())

if __name__ == "__main__":
    main()
"""
SLEEPER = """
import time
import rclpy
rclpy.init()
node = rclpy.create_node("sleeper")
while rclpy.ok():
    time.sleep(0.02)
"""
SOURCES = {
    "a": "self.create_timer(0.02, self.pass_on)",
    "b": 'self.create_subscription(Float64, "a", self.pass_on, 10)',
    "c": 'self.create_subscription(Float64, "b", self.pass_on, 10)',
}


def files(folder: Path, kind: str) -> list[Path]:
    """Write the programs of a system."""
    if kind == "waiting":
        texts = {name: SLEEPER.replace("sleeper", f"sleeper_{name}") for name in SOURCES}
    else:
        end = MAIN if kind == "scripts" else ""
        texts = {name: NODE.format(name=name, source=source) + end for name, source in SOURCES.items()}
    for name, text in texts.items():
        (folder / f"{kind}_{name}.py").write_text(text)
    return [folder / f"{kind}_{name}.py" for name in texts]


def life(paths: list[Path], seconds: float) -> tuple[float, int]:
    """Run a system; give the CPU seconds that this took, and how often the turn went from thread to thread."""
    with Host() as host:
        for each in paths:
            host.start(each.stem, [Member(each.stem, str(each), [])])
        begin, switches = time.process_time(), host.scheduler.switches
        host.run(seconds)
        return time.process_time() - begin, host.scheduler.switches - switches


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=600.0)
    options = parser.parse_args()
    logging.set_console_handler(None)
    with tempfile.TemporaryDirectory() as folder:
        for kind, seconds in (
            ("classes", options.seconds),
            ("scripts", options.seconds),
            ("waiting", options.seconds / 10),
        ):
            found = [life(files(Path(folder), kind), seconds) for _ in range(options.runs)]
            switches = found[0][1]
            count = switches if kind == "waiting" else round(seconds * 150)
            cost = statistics.median(each[0] for each in found) / count * 1e6
            print(f"{kind}: {cost:.1f} us of CPU each, {count} in {seconds:g} s; {switches} switches of threads")


if __name__ == "__main__":
    main()
