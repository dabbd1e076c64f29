"""Growth of a system over four machines and two routers: time until all nodes are seen, traffic, and the routers' CPU.

    python -m tests.support.router_growth                      # 24, 48, 100, 196 and 200 nodes, four in each process
    python -m tests.support.router_growth --processes 50       # 200 nodes in 50 processes that start at once
    python -m tests.support.router_growth --processes 50 --every 0.6    # one after the other, so many seconds apart
    python -m tests.support.router_growth --alone              # the same processes, none of which meets another

Machines are network namespaces between which the kernel forwards, and no multicast passes. `a1` and `b1` have a
robolink router each, beside nodes on `localhost`; the nodes of `a2` and `b2` name the router of their side, as
`--network HOST` does; `b1`'s router connects to `a1`'s. Each node publishes 10 messages of 100 bytes a second, and
hears one node of another machine, every second one beyond both routers. Needs root.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import statistics
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from typing import NamedTuple

import psutil

from tests.support import stalls
from tests.support.domains import free_domain
from tests.support.obedient import line, start, tell

STEPS = (6, 12, 25, 49, 50)
NODES_EACH = 4
RATE, SECONDS = 10.0, 5.0

MACHINES = ("a1", "b1", "a2", "b2")
"""In the order in which processes are dealt to them."""

ADDRESSES = {name: f"10.{77 + number}.0.1" for number, name in enumerate(MACHINES)}


class Cost(NamedTuple):
    """Cost of a process."""

    cpu: float
    """CPU time in seconds."""
    memory: float
    """Resident memory in megabytes."""

    @classmethod
    def of(cls, process: psutil.Process) -> Cost:
        times = process.cpu_times()
        return cls(times.user + times.system, process.memory_info().rss / 1e6)


class Member(NamedTuple):
    """A process of the system."""

    machine: str
    process: subprocess.Popen[str]
    started: float


class Heard(NamedTuple):
    """Counts of what was published, and of what has come."""

    sent: int
    """Messages of all nodes; each is heard by one node, or by none that is there yet."""
    near: list[float]
    """Delays in seconds of what came from nodes on the same side, by one router."""
    far: list[float]
    """Delays of what came from the other side, by both."""

    def __str__(self) -> str:
        ways = (("by one router", self.near), ("by both", self.far))
        return "; ".join([f"sent {self.sent}", *(f"{way} {_delays(delays)}" for way, delays in ways if delays)])


class Fleet:
    """System of many processes on four machines; with `alone` none of them meets another, and there is no router."""

    def __init__(self, stack: ExitStack, *, alone: bool = False) -> None:
        self._stack, self._alone = stack, alone
        names = stack.enter_context(stalls.routed_hosts(len(MACHINES)))
        self._hosts = dict(zip(MACHINES, names, strict=True))
        self._domain = stack.enter_context(free_domain())
        self.members: list[Member] = []
        self.routers: dict[str, psutil.Process] = {}
        if not alone:
            self._start_router("a1")
            self._start_router("b1", "--connect", ADDRESSES["a1"])

    def _start_router(self, machine: str, *options: str) -> None:
        words = [sys.executable, "-m", "robolink", "router", "--listen", "lan", *options]
        process = start(self._stack, self._on(machine, words), self._environ("localhost"))
        assert line(process).startswith("robolink router")
        threading.Thread(target=_drain, args=(process,), daemon=True).start()
        self.routers[machine] = psutil.Process(process.pid)

    def grow(self, processes: int, every: float = 0.0) -> list[Member]:
        """Start processes, `every` so many seconds, until there are so many; returns the new ones, not all ready."""
        known, first = len(self.members), time.monotonic()
        for number in range(known, processes):
            time.sleep(max(0.0, first + (number - known) * every - time.monotonic()))
            machine = MACHINES[number % len(MACHINES)]
            words = [sys.executable, "-m", "tests.support.swarm", *nodes_of(number), "--hear", *heard_by(number)]
            network = "off" if self._alone else "localhost" if machine[1] == "1" else ADDRESSES[f"{machine[0]}1"]
            begin = time.monotonic()
            process = start(self._stack, self._on(machine, words), self._environ(network))
            self.members.append(Member(machine, process, begin))
        return self.members[known:]

    def cpu(self) -> float:
        """Return the CPU time of all members so far, in seconds."""
        return sum(Cost.of(psutil.Process(each.process.pid)).cpu for each in self.members)

    def talk(self) -> Heard:
        """Let all publish for SECONDS."""
        for each in self.members:
            tell(each.process, f"talk {RATE} {SECONDS}")
        time.sleep(SECONDS)
        return self._heard()

    def flood(self, node: int) -> Heard:
        """Let one node of the first process publish as fast as it can, for SECONDS."""
        tell(self.members[0].process, f"flood {node} {SECONDS}")
        time.sleep(SECONDS)
        return self._heard()

    def _heard(self) -> Heard:
        time.sleep(1.0)  # what is under way arrives
        sides = {node: MACHINES[number % 4][0] for number in range(len(self.members)) for node in nodes_of(number)}
        sent, near, far = 0, list[float](), list[float]()
        for each in self.members:
            tell(each.process, "heard")
            answer = json.loads(line(each.process))
            sent += answer["sent"]
            for other, delays in answer["heard"].items():
                (near if sides.get(other) == each.machine[0] else far).extend(delays)
        return Heard(sent, near, far)

    def _on(self, machine: str, words: list[str]) -> list[str]:
        return ["ip", "netns", "exec", self._hosts[machine], *words]

    def _environ(self, network: str) -> dict[str, str]:
        clean = {name: each for name, each in os.environ.items() if not name.startswith(("ROS_", "ZENOH_", "ROBOLINK"))}
        return clean | {"ROS_DOMAIN_ID": str(self._domain), "ROBOLINK_NETWORK": network}


def nodes_of(number: int) -> list[str]:
    """Return the names of the nodes of a process."""
    return [f"p{number}_n{each}" for each in range(NODES_EACH)]


def heard_by(number: int) -> list[str]:
    """Return the nodes that those of a process hear: two of the other machine of their side, two of the other side."""
    near, far = nodes_of(number ^ 2), nodes_of(number ^ 1)
    return near[: NODES_EACH // 2] + far[NODES_EACH // 2 :]


def _drain(process: subprocess.Popen[str]) -> None:
    """Read what a process prints, until it ends: a full pipe would hold it up."""
    assert process.stdout is not None
    with contextlib.suppress(ValueError):  # closed meanwhile
        for _ in process.stdout:
            pass


def _delays(delays: Sequence[float]) -> str:
    late = sorted(each * 1000 for each in delays)
    p95 = late[int(0.95 * (len(late) - 1))]
    return (
        f"{len(late)} ({len(late) / SECONDS:.0f}/s), median {statistics.median(late):.1f} ms, 95 % within {p95:.1f} ms"
    )


@contextlib.contextmanager
def watched(fleet: Fleet, what: str) -> Iterator[None]:
    """Print the CPU and memory of the routers over a `with` block."""
    before, begin = {name: Cost.of(each) for name, each in fleet.routers.items()}, time.monotonic()
    yield
    took = time.monotonic() - begin
    for name, process in fleet.routers.items():
        now = Cost.of(process)
        cpu = now.cpu - before[name].cpu
        say(f"  router {name}, {what}: {cpu / took:.1%} of a core ({cpu:.2f} s in {took:.1f} s), {now.memory:.0f} MB")


def grow(fleet: Fleet, processes: int, every: float = 0.0) -> None:
    """Start processes until there are so many, and say when they were there, and when all saw all."""
    before, begin = fleet.cpu(), time.monotonic()
    new = fleet.grow(processes, every)
    spawned = new[-1].started
    ready = [json.loads(line(each.process)) for each in new]
    made = max(each["time"] for each in ready)
    say(f"  (each process took {statistics.mean(each['cpu'] for each in ready):.2f} s of CPU until it had its nodes)")
    say(f"{processes * NODES_EACH} nodes in {processes} processes, {len(new)} of them started now:")
    text = f"  the last has its nodes {made - spawned:.2f} s after its start"
    if fleet.routers:
        for each in fleet.members:
            tell(each.process, f"seen {processes * NODES_EACH}")
        seen = max(json.loads(line(each.process))["time"] for each in fleet.members)
        text += f"; all see all {seen - spawned:.2f} s after its start, {seen - made:.2f} s after that"
    say(f"{text}; CPU {fleet.cpu() - before:.1f} s in {time.monotonic() - begin:.1f} s")


def measure(steps: Sequence[int], *, alone: bool, traffic: bool, every: float = 0.0) -> None:
    """Grow by these steps, and say how it went."""
    with ExitStack() as stack:
        fleet = Fleet(stack, alone=alone)
        for processes in steps:
            with watched(fleet, "start"):
                grow(fleet, processes, every)
            if alone or not traffic:
                continue
            with watched(fleet, "idle"):
                time.sleep(SECONDS)
            with watched(fleet, "traffic"):
                heard = fleet.talk()
            say(f"  {heard}")
        if traffic and not alone:
            for node in (0, NODES_EACH - 1):
                with watched(fleet, "flood"):
                    heard = fleet.flood(node)
                say(f"  {heard}")


def say(text: str) -> None:
    """Print a line."""
    print(text, flush=True)  # noqa: T201


def main() -> None:
    """Measure what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, nargs="+", default=STEPS, help="how many there are at each step")
    parser.add_argument("--alone", action="store_true", help="no router, and no process that meets another")
    parser.add_argument("--no-traffic", action="store_true", help="the start alone")
    parser.add_argument("--every", type=float, default=0.0, help="seconds from the start of a process to the next")
    asked = parser.parse_args()
    if reason := stalls.no_hosts():
        sys.exit(reason)
    measure(asked.processes, alone=asked.alone, traffic=not asked.no_traffic, every=asked.every)


if __name__ == "__main__":
    main()
