"""Round trips and starts of the same rclpy programs, by robolink and by a real rclpy, by turns.

Usage: python benchmarks/beside_rclpy.py REAL [--rounds N]

REAL is a Python with rclpy, for instance of a virtual environment in which are: ros-rclpy ros-rmw-fastrtps-cpp
ros-rmw-implementation ros-geometry-msgs ros-sensor-msgs. Prints each round's figures, then medians and ratios. Each
end of a conversation has a core of its own where the machine has two; all goes over loopback.
"""

from __future__ import annotations

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

SIZES = {"twist": 0, "1mb": 1_000_000}
TURNS = {"twist": 2000, "1mb": 200}
LONGEST = 60.0
"""Upper bound of one measurement, in s."""

PROGRAM = """
import array, statistics, sys, time
import rclpy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

role, size, turns = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
rclpy.init()
node = rclpy.create_node(role)
kind = Image if size else Twist
sent, heard = ("ask", "answer") if role == "asks" else ("answer", "ask")
publisher = node.create_publisher(kind, sent, 10)
message = kind()
if size:
    message.data = array.array("B", bytes(size))
begun, times = [0], []

def answer(came):
    publisher.publish(came)

def ask_again(came):
    times.append(time.perf_counter_ns() - begun[0])
    if len(times) == turns:
        print(statistics.median(times) / 1000, flush=True)
        sys.exit(0)
    begun[0] = time.perf_counter_ns()
    publisher.publish(message)

def begin():
    if not times:
        begun[0] = time.perf_counter_ns()
        publisher.publish(message)

node.create_subscription(kind, heard, ask_again if role == "asks" else answer, 10)
if role == "asks":
    node.create_timer(1.0, begin)
if turns:
    rclpy.spin(node)
"""
"""Both ends of a conversation; without turns, a node that is made and goes."""


def on_core(core: int, words: list[str]) -> list[str]:
    """Return a command that runs on one core, where that can be said."""
    pinned = (os.cpu_count() or 1) > 1 and shutil.which("taskset")
    return ["taskset", "-c", str(core), *words] if pinned else words


def round_trip(command: list[str], size: int, turns: int, environ: dict[str, str]) -> float:
    """Return the median round trip of one conversation, in us."""
    numbers = [str(size), str(turns)]
    with subprocess.Popen(on_core(0, [*command, "answers", *numbers]), env=environ) as other:
        try:
            asks = on_core(1, [*command, "asks", *numbers])
            done = subprocess.run(asks, env=environ, check=True, capture_output=True, text=True, timeout=LONGEST)
            return float(done.stdout.split()[-1])
        finally:
            other.kill()


def start(command: list[str], environ: dict[str, str]) -> float:
    """Return how long a node takes that is made and goes, in ms."""
    begun = time.perf_counter()
    subprocess.run([*command, "asks", "0", "0"], env=environ, check=True, timeout=LONGEST)
    return (time.perf_counter() - begun) * 1000


def measured(commands: dict[str, list[str]], environ: dict[str, str]) -> Iterator[tuple[str, str, float]]:
    """Yield row, peer and figure of one round."""
    for row, size in SIZES.items():
        for name, command in commands.items():
            yield f"round trip {row}, us", name, round_trip(command, size, TURNS[row], environ)
    for name, command in commands.items():
        yield "start to end, ms", name, start(command, environ)


def main(words: list[str]) -> int:
    """Measure; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args(words)
    environ = {**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROBOLINK_WORKSPACE": ""}
    environ.setdefault("ROS_DOMAIN_ID", "97")
    found: dict[str, dict[str, list[float]]] = {}
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "talks.py")
        program.write_text(PROGRAM, encoding="utf-8")
        commands = {
            "rclpy": [str(options.real), str(program)],
            "robolink": [sys.executable, "-m", "robolink", "run", str(program)],
        }
        for _ in range(options.rounds):
            for row, name, figure in measured(commands, environ):
                found.setdefault(row, {}).setdefault(name, []).append(figure)
                sys.stdout.write(f"{row:22} {name:9} {figure:8.0f}\n")
                sys.stdout.flush()
    for row, figures in found.items():
        ours, real = (statistics.median(figures[name]) for name in ("robolink", "rclpy"))
        sys.stdout.write(f"{row:22} robolink {ours:.0f}, rclpy {real:.0f}: {ours / real:.2f}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
