"""Benchmark of `robolink simulate`: speed and reproducibility, for a robot at a wall and an hour of a control loop.

    python benchmarks/simulating.py [--runs 3] [--python PYTHON ...] [--beside CHECKOUT] [--only follow|loop]

`follow` is ten minutes of configs/follow.yaml by `robolink simulate`, in a process of its own each time, once with each
further Python that is named: all hashes must be the same. `loop` is one hour of a sensor, a controller and a motor at
50 Hz, each a program of its own, with 5 % loss, duplication, a partition and a crash; its nodes are loaded from a file.
Wall time is what people wait for; CPU time says more where others use the machine.

Between two runs the events of the loop are also handled by a bare heap in Python (`heapq`, one function call each):
what an event costs without messages, faults, threads and a hash. Where SimPy is installed, it handles as many timeouts.
With `--beside`, another checkout of robolink runs by turns with this one. Ratios of medians say more than seconds.
"""

from __future__ import annotations

import argparse
import heapq
import importlib
import itertools
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
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


def run(python: str, source: str, *words: str, folder: str | None = None) -> Run:
    """Run `robolink simulate` of a checkout in a process of its own."""
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


def bare_heap(events: int) -> float:
    """Handle so many events by a bare heap; return the seconds that it took."""
    heap: list[tuple[int, int, Callable[[int], None]]] = []
    serial, handled = itertools.count(), 0

    def handle(now: int) -> None:
        nonlocal handled
        handled += 1
        heapq.heappush(heap, (now + 20, next(serial), handle))

    for offset in range(3):
        heapq.heappush(heap, (offset, next(serial), handle))
    begin = time.perf_counter()
    while handled < events:
        now, _, act = heapq.heappop(heap)
        act(now)
    return time.perf_counter() - begin


def simpy_timeouts(events: int) -> float | None:
    """Let three SimPy processes wait for so many timeouts; return the seconds that it took, None without SimPy."""
    try:
        simpy = importlib.import_module("simpy")
    except ImportError:
        return None
    environment = simpy.Environment()

    def process() -> Iterator[object]:
        while True:
            yield environment.timeout(20)

    for _ in range(3):
        environment.process(process())
    begin = time.perf_counter()
    environment.run(until=20 * events // 3)
    return time.perf_counter() - begin


def show(name: str, runs: list[Run], limit: float) -> None:
    """Print the medians of some runs, and whether all had one hash."""
    best = min(runs, key=lambda each: each.wall)
    messages = sum(best.result["messages"].values())  # type: ignore[attr-defined]
    hashes = {each.result["hash"] for each in runs}
    same = f"{len(runs)} times the same hash" if len(hashes) == 1 else f"{len(hashes)} DIFFERENT HASHES"
    print(
        f"{name}: {best.wall:.2f} s wall at best ({inside(runs):.2f} s without the start, median),"
        f" {min(each.cpu for each in runs):.2f} s CPU, to be under {limit:g} s; {messages} messages; {same}"
    )


def inside(runs: list[Run]) -> float:
    """Return the median of the real seconds of some runs, without the start of the process."""
    return statistics.median(float(each.result["real_seconds"]) for each in runs)  # type: ignore[arg-type]


def compare(name: str, runs: list[Run], others: list[Run], peers: dict[str, list[float]]) -> None:
    """Print ratios of medians: over another checkout, and over bare peers of the same run."""
    if others:
        print(f"{name}: {inside(runs) / inside(others):.2f} of the time of the other checkout, median over median")
    for peer, seconds in peers.items():
        if seconds:
            print(f"{name}: {inside(runs) / statistics.median(seconds):.1f} times {peer} of as many events")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--python", action="append", default=[])
    parser.add_argument("--beside", metavar="CHECKOUT", help="another checkout of robolink, to be run by turns")
    parser.add_argument("--only", choices=("follow", "loop"))
    requested = parser.parse_args()
    own = str(Path(__file__).parent.parent)
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("loop.py", NODES), ("loop.yaml", LAUNCH), ("faults.yaml", FAULTS)):
            Path(folder, name).write_text(text, encoding="utf-8")
        words = ("./loop.yaml", "--faults", "./faults.yaml", "--duration", "3600", "--seed", "3")
        for name, given, events, limit in (
            ("follow", ("follow", "--duration", "600"), 0, 6.0),
            ("loop", words, 3600 * 50 * 3, 4.0),
        ):
            if requested.only in (None, name):
                measure(name, requested, Turns(own, given, folder, events), limit)


class Turns(NamedTuple):
    """One system: the checkout, the words of its command, its folder, and the number of its events for bare peers."""

    source: str
    words: tuple[str, ...]
    folder: str
    events: int


def measure(name: str, requested: argparse.Namespace, turns: Turns, limit: float) -> None:
    """Run a system by turns with its peers, and print what they took."""
    runs: list[Run] = []
    others: list[Run] = []
    peers: dict[str, list[float]] = {"a bare heap": [], "SimPy's timeouts": []}
    for python in [sys.executable] * requested.runs + requested.python:
        runs.append(run(python, turns.source, *turns.words, folder=turns.folder))
        if requested.beside:
            others.append(run(python, str(Path(requested.beside).resolve()), *turns.words, folder=turns.folder))
        if turns.events:
            peers["a bare heap"].append(bare_heap(turns.events))
            if (seconds := simpy_timeouts(turns.events)) is not None:
                peers["SimPy's timeouts"].append(seconds)
    show(name, runs, limit)
    compare(name, runs, others, peers)


if __name__ == "__main__":
    main()
