"""How fast a system is simulated, and whether it comes out the same: a robot at a wall, and an hour of a control loop.

    python benchmarks/simulating.py [--runs 3] [--python PYTHON ...]

`follow` is ten minutes of configs/follow.yaml by `robolink simulate`, in a process of its own each time, once with each
further Python that is named: all hashes must be the same. `loop` is one hour of a sensor, a controller and a motor at
50 Hz, each a program of its own, with 5 % loss, duplication, a partition and a crash; its nodes are loaded from a file.
Wall time is what people wait for; CPU time says more where others use the machine.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

NODES = '''
"""A control loop of three nodes at 50 Hz."""

from robolink import Node
from robolink.interfaces.std_msgs.msg import Float64


class Sensor(Node):
    def __init__(self, **options):
        super().__init__("sensor", **options)
        self.level, self.count = 0.0, 0
        self.measured = self.create_publisher(Float64, "level", 10)
        self.create_timer(0.02, self.measure)

    def measure(self):
        self.level += 0.001
        self.measured.publish(Float64(data=self.level))


class Controller(Node):
    def __init__(self, **options):
        super().__init__("controller", **options)
        self.command = self.create_publisher(Float64, "command", 10)
        self.create_subscription(Float64, "level", self.control, 10)

    def control(self, level):
        self.command.publish(Float64(data=1.0 - level.data))


class Motor(Node):
    def __init__(self, **options):
        super().__init__("motor", **options)
        self.force = 0.0
        self.create_subscription(Float64, "command", self.obey, 10)

    def obey(self, command):
        self.force = command.data
'''

LAUNCH = """
nodes:
  - {node: "loop.py:Sensor", name: sensor}
  - {node: "loop.py:Controller", name: controller}
  - {node: "loop.py:Motor", name: motor}
"""

FAULTS = """
messages:
  - {loss: 0.05, duplication: 0.01}
partitions:
  - {between: [controller, [sensor, motor]], after: 600, until: 660}
crashes:
  - {node: controller, at: 1800, restart_after: 2.0}
"""


class Run(NamedTuple):
    """One process."""

    wall: float
    cpu: float
    result: dict[str, object]


def run(python: str, *words: str, folder: str | None = None) -> Run:
    """Run `robolink simulate` in a process of its own."""
    source = str(Path(__file__).parent.parent)
    before, begin = os.times(), time.perf_counter()
    ended = subprocess.run(
        [python, "-m", "robolink", "simulate", *words, "--json"],
        env={**os.environ, "PYTHONPATH": source},
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )
    wall, after = time.perf_counter() - begin, os.times()
    if ended.returncode:
        sys.exit(ended.stderr)
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    return Run(wall, cpu, json.loads(ended.stdout.splitlines()[-1]))


def show(name: str, runs: list[Run], limit: float) -> None:
    """Print the best of some runs, and whether all had one hash."""
    best = min(runs, key=lambda each: each.wall)
    messages = sum(best.result["messages"].values())  # type: ignore[attr-defined]
    hashes = {each.result["hash"] for each in runs}
    same = f"{len(runs)} times the same hash" if len(hashes) == 1 else f"{len(hashes)} DIFFERENT HASHES"
    inside = best.result["real_seconds"]
    print(
        f"{name}: {best.wall:.2f} s wall ({inside} s without the start), {min(each.cpu for each in runs):.2f} s CPU,"
        f" to be under {limit:g} s; {messages} messages; {same}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--python", action="append", default=[])
    asked = parser.parse_args()
    pythons = [sys.executable] * asked.runs + asked.python
    show("follow", [run(each, "follow", "--duration", "600") for each in pythons], 6.0)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("loop.py", NODES), ("loop.yaml", LAUNCH), ("faults.yaml", FAULTS)):
            Path(folder, name).write_text(text, encoding="utf-8")
        words = ("./loop.yaml", "--faults", "./faults.yaml", "--duration", "3600", "--seed", "3")
        show("loop", [run(each, *words, folder=folder) for each in pythons], 4.0)


if __name__ == "__main__":
    main()
