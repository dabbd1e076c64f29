"""Benchmark of a fleet: a hundred robots with reactive controllers in real time, and the scans that are lost.

    python benchmarks/fleet.py [--robots 100] [--seconds 20] [--world fleet] [--apart]

The world is one process and the controllers are another, as configs/fleet.yaml has it, over Zenoh on a domain of their
own. Publishers number what they send; each controller looks at the numbers of what it receives, in the order in which
its callback gets it, from its first scan to the end. Pace, lateness and CPU are those after a few seconds of warming
up. The load of others on this machine shows in everything but the counts.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import statistics
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from robolink.documents.yamlfile import parse, read_text, spell
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.launch import plan
from robolink.supervisor import Supervisor
from robolink.workspace import find_node, find_world, load_node

DOMAIN = 97
WARM_UP = 5.0
"""Seconds that a process has to begin, before its pace, lateness and CPU are measured."""

GOAL = 0.99
MARK = "FLEET "
SYSTEM = """
nodes:
  - {{node: '{file}:World', parameters: {{world: '{world}'}}, process: simulation}}
  - {{node: '{file}:Controller', count: {robots}, namespace: 'r{{i}}'{process}}}
"""

_World: Any = load_node(find_node("world"))
_Controller: Any = load_node(find_node("reactive_controller"))


# --- In the processes that are measured -------------------------------------------------------------------------------


class Meter:
    """Return the share of a core of this process after warming up."""

    def __init__(self) -> None:
        self.end_of_warm_up = time.perf_counter() + WARM_UP
        self._begun: tuple[float, float] | None = None

    def is_warm(self) -> bool:
        """Return whether it is time to measure; the first time, CPU time is counted from then on."""
        now = time.perf_counter()
        if now < self.end_of_warm_up:
            return False
        self._begun = self._begun or (now, time.process_time())
        return True

    def percent(self) -> float:
        """Percent of a core."""
        if self._begun is None:
            return 0.0
        wall, cpu = self._begun
        return 100 * (time.process_time() - cpu) / (time.perf_counter() - wall)


METER = Meter()


class World(_World):  # type: ignore[misc]
    """The simulated world, which tells at its end what it has taken."""

    def __init__(self) -> None:
        super().__init__()
        self.create_timer(1.0, METER.is_warm)

    def destroy_node(self) -> None:
        tell(self, {"simulation": METER.percent()})
        super().destroy_node()


class Controller(_Controller):  # type: ignore[misc]
    """The reactive controller; it tells at its end what it has received."""

    def __init__(self) -> None:
        self.received, self.first, self.last, self.disorder = 0, 0, 0, 0
        self.stamps: list[tuple[float, float]] = []
        self.late: list[int] = []
        super().__init__()

    def create_subscription(self, msg_type: type[Any], topic: str, callback: Callable[..., Any], *rest: Any) -> Any:
        """Look at scans before the controller does."""

        def look(scan: LaserScan, info: Any) -> Any:
            self.look(scan, info)
            return callback(scan)

        return super().create_subscription(msg_type, topic, look if msg_type is LaserScan else callback, *rest)

    def look(self, scan: LaserScan, info: Any) -> None:
        """Note which scan this is, and how late."""
        number, sent = info["publication_sequence_number"], info["source_timestamp"]
        self.first = self.first or number
        self.disorder += number <= self.last
        self.last = max(self.last, number)
        self.received += 1
        if METER.is_warm():
            self.late.append((time.time_ns() - sent) // 1000)
            now = (scan.header.stamp.sec + scan.header.stamp.nanosec * 1e-9, sent * 1e-9)
            self.stamps = [*self.stamps[:1], now]

    def destroy_node(self) -> None:
        sent = self.last - self.first + 1 if self.first else 0
        counts = {"sent": sent, "received": self.received, "disorder": self.disorder}
        tell(self, {"counts": counts, "stamps": self.stamps, "late": self.late, "controllers": METER.percent()})
        super().destroy_node()


def tell(node: Any, what: dict[str, Any]) -> None:
    """Print figures for the process that asked for them; once, though a node may be destroyed twice."""
    if not getattr(node, "told", False):
        node.reported = True
        print(MARK + json.dumps(what), flush=True)


# --- In the process that asks -----------------------------------------------------------------------------------------


class Figures(NamedTuple):
    """Result of a run; the real-time factor is the slowest robot's, lateness is in milliseconds."""

    robots: int
    sent: int
    received: int
    disorder: int
    factor: float
    late: Sequence[float]
    cpu: dict[str, float]


def run(robots: int, seconds: float, world: Path, apart: bool) -> Figures:
    """Run the system for so long after its warm-up."""
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    process = "" if apart else ", process: controllers"
    text = SYSTEM.format(file=Path(__file__).resolve(), world=world, robots=robots, process=process)
    output = io.StringIO()
    code = Supervisor(plan(Path(__file__), text=text), output=output).run(WARM_UP + seconds + 1.0)
    lines = output.getvalue().splitlines()
    reported = [json.loads(line.partition(MARK)[2]) for line in lines if MARK in line]
    if code or len(reported) != robots + 1:
        raise SystemExit(
            "\n".join(
                [
                    *(line for line in lines if MARK not in line),
                    f"exit code {code}, {len(reported)} of {robots + 1} nodes have told",
                ]
            )
        )
    return figures(reported)


def figures(reported: Sequence[dict[str, Any]]) -> Figures:
    """Put together what the nodes have told."""
    counts = [each["counts"] for each in reported if "counts" in each]
    spans = [(each["stamps"][0], each["stamps"][-1]) for each in reported if len(each.get("stamps", ())) > 1]
    factors = [(end[0] - begin[0]) / (end[1] - begin[1]) for begin, end in spans]
    cpu = {name: max(each.get(name, 0.0) for each in reported) for name in ("simulation", "controllers")}
    sent, received, disorder = (sum(each[name] for each in counts) for name in ("sent", "received", "disorder"))
    late = sorted(late / 1000 for each in reported for late in each.get("late", ()))
    robots = sum(each["received"] > 0 for each in counts)
    return Figures(robots, sent, received, disorder, min(factors, default=0.0), late, cpu)


def smaller_world(name: str, robots: int, folder: Path) -> Path:
    """Return the file of a world with so many of its robots."""
    path = find_world(name)
    data: Any = parse(read_text(path), name=str(path))
    data["robots"] = data["robots"][:robots]
    smaller = folder / "world.yaml"
    smaller.write_text(spell(data), encoding="utf-8")
    return smaller


def report(found: Figures, requested: int) -> None:
    late = found.late or [0.0]
    lost = found.sent - found.received
    print(f"{found.robots} of {requested} robots driven")
    print(f"  scans sent {found.sent:,}, received {found.received:,}, lost {lost}, out of order {found.disorder}")
    print(f"  real-time factor {found.factor:.4f} (goal {GOAL})")
    print(f"  scan to callback, ms: p50 {statistics.median(late):.1f}, p99 {late[len(late) * 99 // 100]:.1f}", end="")
    print(f", worst {late[-1]:.1f}")
    print("  CPU, percent of a core:", ", ".join(f"{name} {percent:.0f}" for name, percent in found.cpu.items()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=100)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--world", default="fleet", help="a world with at least so many robots, r0, r1 ...")
    parser.add_argument("--apart", action="store_true", help="a process for each controller; CPU is one's then")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        world = smaller_world(options.world, options.robots, Path(folder))
        report(run(options.robots, options.seconds, world, options.apart), options.robots)


if __name__ == "__main__":
    main()
