"""Benchmark of `robolink bag record`: its share of a core, and what it loses, with the topics of many robots.

    python benchmarks/recording.py [--robots 100] [--seconds 20] [--compression zstd]

A process publishes what the robots would (benchmarks/robots.py): 100 robots have 203 topics with 6,050 messages a
second. A recorder in another process records all of it.
"""

from __future__ import annotations

import argparse
import json
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import psutil

sys.path.insert(0, str(Path(__file__).parents[1]))

from benchmarks.robots import RATE, Fleet
from robolink import Context, Node

SETTLING = 3.0
"""Seconds of the load that are not measured."""


def load(robots: int, seconds: float) -> None:
    """Publish for a while, once everything is subscribed to; print the number of messages."""
    with Context() as context:
        node = Node("load", context=context)
        fleet = Fleet(node, robots)
        while not fleet.is_heard:
            time.sleep(0.05)
        time.sleep(1.0)
        print("begins", flush=True)
        begin, sent = time.perf_counter(), 0
        for step in range(round(seconds * RATE)):
            sent += fleet.publish()
            time.sleep(max(0.0, begin + (step + 1) / RATE - time.perf_counter()))
        spent = time.perf_counter() - begin
        print(json.dumps({"sent": sent, "seconds": spent}), flush=True)
        time.sleep(1.0)


def measure(robots: int, seconds: float, more: list[str]) -> None:
    """Record a load, and print the figures."""
    with tempfile.TemporaryDirectory() as folder:
        bag = Path(folder, "bag")
        words = ["bag", "record", "-a", "--exclude-topics", "/rosout", "-o", str(bag), "--json", "--log-level", "warn"]
        recorder = subprocess.Popen(
            [sys.executable, "-m", "robolink", *words, *more], stdout=subprocess.PIPE, text=True
        )
        loader = subprocess.Popen(
            [sys.executable, __file__, "--load", "--robots", str(robots), "--seconds", str(seconds)],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert loader.stdout is not None
        assert loader.stdout.readline() == "begins\n"
        time.sleep(SETTLING)
        process = psutil.Process(recorder.pid)
        before, begin = process.cpu_times(), time.perf_counter()
        time.sleep(max(1.0, seconds - SETTLING - 1.0))
        after, spent = process.cpu_times(), time.perf_counter() - begin
        memory = process.memory_info().rss
        sent = json.loads(loader.stdout.readline())
        loader.wait()
        recorder.send_signal(signal.SIGTERM)
        figures = json.loads(recorder.communicate()[0])
        cpu = (after.user - before.user + after.system - before.system) / spent
        on_disk = sum(each.stat().st_size for each in bag.iterdir())
        print(f"{robots} robots, {figures['topics']} topics, {sent['sent'] / sent['seconds']:,.0f} messages a second")
        print(f"  sent {sent['sent']:,}, recorded {figures['messages']:,}")
        print(f"  dropped {sum(figures['dropped'].values())}, lost on the way {sum(figures['lost'].values())}")
        print(f"  {100 * cpu:.1f} % of a core, {memory / 1e6:.0f} MB of memory")
        print(f"  {figures['bytes'] / 1e6:.1f} MB of messages, {on_disk / 1e6:.1f} MB of bag")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--compression", default="")
    parser.add_argument("--load", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.load:
        load(given.robots, given.seconds)
    else:
        measure(given.robots, given.seconds, ["--compression-format", given.compression] if given.compression else [])


if __name__ == "__main__":
    main()
