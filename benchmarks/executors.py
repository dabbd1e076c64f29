"""Benchmark of executors: a message by each way of spinning, and CPU use of a 100 Hz timer beside idle subscriptions.

    python benchmarks/executors.py [--rounds 5] [--seconds 3] [--idle 100]

Figures of one machine at one moment mean little; the ratios carry over. A node sends itself messages in memory: one
that is sent in the callback of the last, one of 20,000 that wait, and none that a spin without waiting looks for.

The timer runs over Zenoh. Each loop runs in a process of its own, by
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
from robolink.context import Context
from robolink.executors import Executor, MultiThreadedExecutor, SingleThreadedExecutor
from robolink.interfaces.std_msgs.msg import Int32
from robolink.transport.memory import Bus, MemoryTransport
from robolink.utilities import set_default_context

PERIOD = 0.01
DOMAIN = 98
WARM_UP = 1.0
MESSAGES, BACKLOG = 2000, 20_000
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


# A message, by each way of spinning

Spin = Callable[[robolink.Node, Executor, robolink.Future[None], float | None], object]


def by_spinning(node: robolink.Node, _: Executor, done: robolink.Future[None], timeout: float | None) -> None:
    robolink.spin_until_future_complete(node, done, timeout_sec=timeout)


def by_spin_once(node: robolink.Node, _: Executor, done: robolink.Future[None], timeout: float | None) -> None:
    while not done.done():
        robolink.spin_once(node, timeout_sec=timeout)


def by_an_executor(node: robolink.Node, own: Executor, done: robolink.Future[None], timeout: float | None) -> None:
    own.add_node(node)
    while not done.done():
        own.spin_once(timeout_sec=timeout)


WAYS: dict[str, Spin] = {
    "spin": by_spinning,
    "executor.spin_once()": by_an_executor,
    "spin_once(node)": by_spin_once,
}


def a_message(way: str, waiting: int) -> float:
    """Microseconds a message, of a node that sends the next one in its callback, while so many wait."""
    with Context(transport=MemoryTransport(bus=Bus())) as context:
        set_default_context(context)
        node, done, left = robolink.Node("node"), robolink.Future[None](), iter(range(MESSAGES))
        publisher, message = node.create_publisher(Int32, "topic", BACKLOG + 1), Int32()

        def on_message(_: Int32) -> None:
            publisher.publish(message)
            if next(left, None) is None:
                done.set_result(None)

        node.create_subscription(Int32, "topic", on_message, BACKLOG + 1)
        for _ in range(waiting + 1):
            publisher.publish(message)
        executor = SingleThreadedExecutor()
        begin = time.perf_counter()
        WAYS[way](node, executor, done, None)
        return 1e6 * (time.perf_counter() - begin) / MESSAGES


def a_look(way: str) -> float:
    """Microseconds of a spin that finds nothing and does not wait."""
    with Context(transport=MemoryTransport(bus=Bus())) as context:
        set_default_context(context)
        node, executor = robolink.Node("node"), SingleThreadedExecutor()
        looks, done = iter(range(MESSAGES)), robolink.Future[None]()
        done.done = lambda: next(looks, None) is None  # type: ignore[method-assign]
        begin = time.perf_counter()
        WAYS[way](node, executor, done, 0)
        return 1e6 * (time.perf_counter() - begin) / MESSAGES


def report_messages(rounds: int) -> None:
    columns: dict[str, Callable[[str], float]] = {
        "one by one": lambda way: a_message(way, 0),
        f"{BACKLOG:,} wait": lambda way: a_message(way, BACKLOG),
        "none": a_look,
    }
    print(f"us a message, in memory, medians of {rounds} rounds by turns   {'   '.join(columns)}   against spin")
    figures: dict[str, dict[str, list[float]]] = {way: {name: [] for name in columns} for way in WAYS}
    for _ in range(rounds):
        for way, found in figures.items():
            for name, measure in columns.items():
                if name != "none" or way != "spin":
                    found[name].append(measure(way))
    set_default_context(None)
    base = {name: statistics.median(each) for name, each in figures["spin"].items() if each}
    for way, found in figures.items():
        medians = {name: statistics.median(each) for name, each in found.items() if each}
        text = "".join(f"{medians[name]:12.2f}" if name in medians else f"{'-':>12}" for name in columns)
        print(f"  {way:22}{text}   {'  '.join(f'{medians[name] / base[name]:.2f}' for name in base)}")


# The timer, in processes


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
        report_messages(options.rounds)
        report(options.rounds, options.seconds, options.idle)


if __name__ == "__main__":
    main()
