"""What an executor takes of a core while it waits: a 100 Hz timer beside idle subscriptions, over Zenoh.

    python benchmarks/executors.py [--rounds 5] [--seconds 3] [--idle 100]

Figures of one machine at one moment mean little; the ratios carry over. Each loop runs in a process of its own, by
turns. The bare ones do the least that a program can do to be called every 10 ms: they wait for an event, or for a queue
with a timeout, until the next moment, and call a function. What is counted is the whole process's CPU time, Zenoh's
threads included.
"""

from __future__ import annotations

import argparse
import queue
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Callable

import robolink
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32

PERIOD = 0.01
DOMAIN = 98
WARM_UP = 1.0
GOAL = 3.0
"""Percent of a core."""


def measured(spin: Callable[[float], object], ticks: list[None], seconds: float) -> tuple[float, float]:
    """Percent of a core and microseconds a tick, while `spin(seconds)` runs."""
    spin(WARM_UP)
    ticks.clear()
    cpu, begin = time.process_time(), time.perf_counter()
    spin(seconds)
    cpu, took = time.process_time() - cpu, time.perf_counter() - begin
    return 100 * cpu / took, 1e6 * cpu / len(ticks)


def bare_event(idle: int, seconds: float) -> tuple[float, float]:
    event = threading.Event()
    return bare(event.wait, seconds)


def bare_queue(idle: int, seconds: float) -> tuple[float, float]:
    arrivals: queue.SimpleQueue[None] = queue.SimpleQueue()

    def wait(timeout: float) -> None:
        try:
            arrivals.get(timeout=timeout)
        except queue.Empty:
            return

    return bare(wait, seconds)


def bare(wait: Callable[[float], object], seconds: float) -> tuple[float, float]:
    ticks: list[None] = []

    def spin(so_long: float) -> None:
        moment = time.monotonic()
        end = moment + so_long
        while moment < end:
            moment += PERIOD
            wait(max(0.0, moment - time.monotonic()))
            ticks.append(None)

    return measured(spin, ticks, seconds)


def single_threaded(idle: int, seconds: float) -> tuple[float, float]:
    return in_executor(SingleThreadedExecutor, idle, seconds)


def multi_threaded(idle: int, seconds: float) -> tuple[float, float]:
    return in_executor(MultiThreadedExecutor, idle, seconds)


def in_executor(kind: type[Executor], idle: int, seconds: float) -> tuple[float, float]:
    robolink.init(args=[], domain_id=DOMAIN)
    node, ticks, never = robolink.create_node("idle"), list[None](), robolink.Future[None]()
    for index in range(idle):
        node.create_subscription(Int32, f"topic_{index}", lambda _: None, 10)
    node.create_timer(PERIOD, lambda: ticks.append(None))
    with kind() as executor:
        executor.add_node(node)
        result = measured(lambda so_long: executor.spin_until_future_complete(never, so_long), ticks, seconds)
    robolink.shutdown()
    return result


LOOPS = {
    "bare threading.Event": bare_event,
    "bare queue": bare_queue,
    "SingleThreadedExecutor": single_threaded,
    "MultiThreadedExecutor": multi_threaded,
}


def in_a_process(name: str, idle: int, seconds: float) -> tuple[float, float]:
    command = [sys.executable, __file__, "--role", name, "--idle", str(idle), "--seconds", str(seconds)]
    percent, each = subprocess.run(command, check=True, capture_output=True, text=True).stdout.split()
    return float(percent), float(each)


def report(rounds: int, seconds: float, idle: int) -> None:
    figures: dict[tuple[str, int], list[tuple[float, float]]] = {}
    for _ in range(rounds):
        for name in LOOPS:
            for count in [0] if name.startswith("bare") else [0, idle]:
                figures.setdefault((name, count), []).append(in_a_process(name, count, seconds))
    base = statistics.median(each for _, each in figures["bare threading.Event", 0])
    print(f"100 Hz, medians of {rounds} rounds by turns   of a core   us a tick   against the event")
    for (name, count), each_round in figures.items():
        percent = statistics.median(each for each, _ in each_round)
        tick = statistics.median(each for _, each in each_round)
        beside = f"{count} idle subscriptions" if not name.startswith("bare") else ""
        verdict = "" if percent < GOAL else f"   more than {GOAL:g} %"
        print(f"  {name:22} {beside:22} {percent:7.2f} %   {tick:9.0f}   {tick / base:8.2f}{verdict}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--idle", type=int, default=100)
    parser.add_argument("--role", choices=LOOPS, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.role:
        print(*LOOPS[options.role](options.idle, options.seconds))
    else:
        report(options.rounds, options.seconds, options.idle)


if __name__ == "__main__":
    main()
