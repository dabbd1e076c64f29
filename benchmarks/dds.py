"""Costs of DDS: round trips, rates and the bridge's processor time, beside two nodes of a real ROS 2, by turns.

Usage: python benchmarks/dds.py REAL [--rounds N] [--only round-trips|rates|idle]

REAL is a Python with rclpy, as `python -m tests.judge.wheels kilted` installs one. Both ends run the same program. The
ways: real (two real nodes), direct (robolink with `--network dds`, and a real node), bridge (robolink on Zenoh, a
bridge, and a real node). Medians of the rounds' medians come last, with ratios to two real nodes. All over loopback.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import psutil

LONGEST = 60.0
"""Upper bound of one measurement, in s."""

PROGRAM = """
import array, json, statistics, sys, threading, time
import rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image, LaserScan
from std_msgs.msg import String

KINDS = {"twist": Twist, "scan": LaserScan, "1mb": Image, "6mb": Image}

def made(name):
    message = KINDS[name]()
    if name == "scan":
        message.ranges = array.array("f", [1.5] * 1080)
        message.intensities = array.array("f", [1.5] * 1080)
    if name == "1mb":
        message.data = array.array("B", bytes(1_000_000))
    if name == "6mb":
        message.data = array.array("B", bytes(6_220_800))
    return message

def say(**what):
    print(json.dumps(what), flush=True)

role, given = sys.argv[1], json.loads(sys.argv[2])
rclpy.init()
node = rclpy.create_node(role)
quality = lambda: QoSProfile(depth=10, reliability=ReliabilityPolicy[given.get("reliability", "RELIABLE")])
stop = threading.Event()
threading.Thread(target=lambda: (sys.stdin.read(), stop.set()), daemon=True).start()

def spin_until(condition, seconds):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end and not stop.is_set():
        rclpy.spin_once(node, timeout_sec=0.1)
    return condition()

if role == "answers":
    def echo(name):
        back = node.create_publisher(KINDS[name], "answer_" + name, quality())
        node.create_subscription(KINDS[name], "ask_" + name, back.publish, quality())
    for name in given["turns"]:
        echo(name)
    say(event="ready")
    spin_until(stop.is_set, 1e9)

if role == "asks":
    def measure(name, turns):
        message, took, begun = made(name), [], [0]
        out = node.create_publisher(KINDS[name], "ask_" + name, quality())
        def ask():
            begun[0] = time.perf_counter_ns()
            out.publish(message)
        def heard(came):
            took.append(time.perf_counter_ns() - begun[0])
            if len(took) < turns + 10:
                ask()
        back = node.create_subscription(KINDS[name], "answer_" + name, heard, quality())
        spin_until(lambda: out.get_subscription_count() and back.get_publisher_count(), 10.0)
        lost = 0
        while len(took) < turns + 10 and not stop.is_set():
            ask()
            count = len(took)
            while spin_until(lambda: len(took) > count, 2.0) and len(took) < turns + 10:
                count = len(took)
            lost += len(took) < turns + 10
        node.destroy_subscription(back)
        node.destroy_publisher(out)
        say(event=name, us=statistics.median(took[10:]) / 1000, again=lost)
    for name, turns in given["turns"].items():
        measure(name, turns)
    say(event="done")

if role == "hears":
    count, probes = [0], node.create_publisher(String, "heard", 10)
    def heard(message):
        mark = message.header.frame_id if given["kind"] != "twist" else message.angular.x
        if mark in ("probe", 7.0):
            probes.publish(String(data="a probe"))
        else:
            count[0] += 1
    node.create_subscription(KINDS[given["kind"]], "rate", heard, quality())
    say(event="ready")
    spin_until(stop.is_set, 1e9)
    say(event="heard", count=count[0])

if role == "sends":
    name, period, count, met = given["kind"], 1.0 / given["rate"], given["messages"], []
    out = node.create_publisher(KINDS[name], "rate", quality())
    node.create_subscription(String, "heard", met.append, 10)
    probe, message = made(name), made(name)
    if name == "twist":
        probe.angular.x = 7.0
    else:
        probe.header.frame_id = "probe"
    def try_once():
        out.publish(probe)
        return spin_until(lambda: met, 0.2)
    while not try_once() and not stop.is_set():
        pass
    spin_until(lambda: False, 0.5)
    say(event="begin")
    due = time.perf_counter()
    for _ in range(count):
        out.publish(message)
        due += period
        time.sleep(max(due - time.perf_counter(), 0.0))
    say(event="sent")
    spin_until(stop.is_set, 1e9)

if role == "idles":
    node.create_publisher(Twist, given["sends"], 10)
    node.create_subscription(Twist, given["hears"], lambda _: None, 10)
    say(event="ready")
    spin_until(stop.is_set, 1e9)
"""

TURNS = {"twist": 1000, "scan": 500, "1mb": 100, "6mb": 20}


class Rate(NamedTuple):
    """A stream that one end sends."""

    kind: str
    rate: float
    messages: int
    reliability: str


RATES = [Rate("twist", 1000.0, 4000, "RELIABLE"), Rate("1mb", 30.0, 120, "BEST_EFFORT")]


class End:
    """A process of the program, whose lines are read one by one."""

    def __init__(self, command: Sequence[str], role: str, given: dict[str, Any], environ: dict[str, str]) -> None:
        self.role = role
        words = [*command, role, json.dumps(given)]
        self.process = subprocess.Popen(
            words, env=environ, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="utf-8"
        )

    def wait(self, event: str) -> dict[str, Any]:
        assert self.process.stdout
        for line in self.process.stdout:
            if line.startswith("{") and (said := json.loads(line))["event"] == event:
                return dict(said)
        raise SystemExit(f"{self.role} has ended without '{event}'")

    def stop(self) -> None:
        assert self.process.stdin
        with contextlib.suppress(BrokenPipeError):
            self.process.stdin.close()

    def __enter__(self) -> End:
        return self

    def __exit__(self, *exception: object) -> None:
        self.stop()
        try:
            self.process.wait(3.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


class Bench:
    """Where all of a run is: the program, the commands that run it, and the environment."""

    def __init__(self, real: Path, bridge: Sequence[str], program: Path, domain: int) -> None:
        self.environ = {
            **os.environ,
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_DOMAIN_ID": str(domain),
            "ROBOLINK_WORKSPACE": "",
        }
        self.environ.pop("ROBOLINK_NETWORK", None)
        self._real = [str(real), str(program)]
        self._ours = [sys.executable, "-m", "robolink", "run", str(program)]
        self._bridge = bridge

    def end(self, who: str, role: str, given: dict[str, Any]) -> End:
        """Start an end: of a real node, or of robolink's on a way."""
        if who == "real":
            return End(self._real, role, given, self.environ)
        network = {"ROBOLINK_NETWORK": "dds"} if who == "direct" else {}
        return End(self._ours, role, given, self.environ | network)

    @contextlib.contextmanager
    def between(self, way: str) -> Iterator[int]:
        """Run what a way needs between its ends; give the process's id, or 0."""
        if way != "bridge":
            yield 0
            return
        bridge = subprocess.Popen(self._bridge, env=self.environ, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        try:
            assert bridge.stdout
            bridge.stdout.readline()
            yield bridge.pid
        finally:
            bridge.kill()
            bridge.wait()
            bridge.stdout.close() if bridge.stdout else None


def processor_time(pid: int) -> float:
    """Return the processor time of a process so far, in seconds."""
    used = psutil.Process(pid).cpu_times()
    return float(used.user + used.system)


def round_trips(bench: Bench, way: str, turns: dict[str, int]) -> dict[str, float]:
    """Return the median round trip of each kind of message, in us: from robolink's end, or a real one's."""
    given = {"turns": turns}
    with bench.between(way), bench.end("real", "answers", given) as other:
        other.wait("ready")
        with bench.end(way, "asks", given) as asks:
            found = {}
            for name in turns:
                said = asks.wait(name)
                found[name] = said["us"]
                if said["again"]:
                    print(f"  {way} {name}: asked again {said['again']} times, since no answer came")
            return found


def stream(bench: Bench, way: str, rate: Rate, *, to_real: bool) -> tuple[int, float]:
    """Return how many messages arrived, and the share of a core that the bridge took meanwhile."""
    sender, receiver = (way, "real") if to_real else ("real", way)
    given = rate._asdict()
    with bench.between(way) as pid, bench.end(receiver, "hears", given) as hears:
        hears.wait("ready")
        with bench.end(sender, "sends", given) as sends:
            sends.wait("begin")
            begun, used = time.monotonic(), processor_time(pid) if pid else 0.0
            sends.wait("sent")
            share = (processor_time(pid) - used) / (time.monotonic() - begun) if pid else 0.0
            time.sleep(0.5)  # for what is on its way
            hears.stop()
            return int(hears.wait("heard")["count"]), share


def idle(bench: Bench, seconds: float) -> float:
    """Return the share of a core that a bridge takes between two nodes that do nothing."""
    ours, theirs = {"sends": "here", "hears": "there"}, {"sends": "there", "hears": "here"}
    with contextlib.ExitStack() as stack:
        pid = stack.enter_context(bench.between("bridge"))
        for end in (bench.end("real", "idles", theirs), bench.end("bridge", "idles", ours)):
            stack.enter_context(end).wait("ready")
        time.sleep(2.0)
        used = processor_time(pid)
        time.sleep(seconds)
        return (processor_time(pid) - used) / seconds


def all_round_trips(bench: Bench, ways: Sequence[str], rounds: int, turns: dict[str, int]) -> None:
    found: dict[str, dict[str, list[float]]] = {name: {way: [] for way in ways} for name in turns}
    for number in range(rounds):
        for way in ways:
            for name, figure in round_trips(bench, way, turns).items():
                found[name][way].append(figure)
            row = ", ".join(f"{name} {found[name][way][-1]:,.0f}" for name in turns)
            print(f"round {number + 1}, {way}: {row} us", flush=True)
    for name, figures in found.items():
        medians = {way: statistics.median(figures[way]) for way in ways}
        words = [
            f"{way} {medians[way]:,.0f} ({min(figures[way]):,.0f}-{max(figures[way]):,.0f})"
            + (f" = {medians[way] / medians['real']:.2f}" if way != "real" and "real" in medians else "")
            for way in ways
        ]
        print(f"round trip {name}, us: {'; '.join(words)}")


def all_rates(bench: Bench, ways: Sequence[str], rounds: int) -> None:
    for rate in RATES:
        for way in ways:
            for to_real in (True, False):
                got = [stream(bench, way, rate, to_real=to_real) for _ in range(rounds)]
                counts = " ".join(str(each[0]) for each in got)
                shares = f"; bridge {' '.join(f'{each[1]:.1%}' for each in got)} of a core" if way == "bridge" else ""
                names = f"{way} to real" if to_real else f"real to {way}"
                name = f"{rate.kind} {rate.rate:g} Hz {rate.reliability}"
                print(f"{name}, {names}: {counts} of {rate.messages}{shares}", flush=True)


def main(words: Sequence[str]) -> int:
    """Measure; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("real", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--ways", nargs="+", default=["real", "direct", "bridge"])
    parser.add_argument("--kinds", nargs="+", default=list(TURNS), choices=list(TURNS))
    parser.add_argument("--only", choices=["round-trips", "rates", "idle"])
    parser.add_argument("--domain", type=int, default=97)
    parser.add_argument("--bridge", nargs="+", default=[sys.executable, "-m", "robolink", "bridge", "dds"])
    options = parser.parse_args(words)
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "talks.py")
        program.write_text(PROGRAM, encoding="utf-8")
        bench = Bench(options.real, options.bridge, program, options.domain)
        if options.only in (None, "round-trips"):
            turns = {name: TURNS[name] for name in options.kinds}
            all_round_trips(bench, options.ways, options.rounds, turns)
        if options.only in (None, "rates"):
            all_rates(bench, options.ways, min(options.rounds, 3))
        if options.only in (None, "idle") and "bridge" in options.ways:
            print(f"idle bridge: {idle(bench, 10.0):.1%} of a core")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
