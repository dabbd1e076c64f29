"""Benchmark of many processes that start together, or one after the other: time and CPU until all know all nodes.

    python benchmarks/crowd.py [--processes 20] [--nodes 4] [--rounds 5] [--every 0] [--beside CHECKOUT ...]

Each process has so many nodes, each with a publisher and a subscription, and spins them. All know all when each process
has found every node and every node's topic in its graph. CPU is the sum over all processes: it stays the same on a busy
machine, where the time does not. Another checkout plays by turns, with the python of its `.venv`.
`bare` are scripts with a Zenoh session, as robolink configures it, that announce as many tokens and count all.
"""

from __future__ import annotations

import argparse
import json
import os
import select
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

DOMAIN = 97
LOOK_EVERY = 0.25
"""Interval in seconds at which a process looks at how many nodes it knows."""
PATIENCE = 120.0
"""Seconds after which the processes of a round are ended."""
TOKENS = 12
"""Tokens that a bare script announces for each node."""
ENVIRONMENT = {
    name: value
    for name, value in os.environ.items()
    if name != "PYTHONDONTWRITEBYTECODE" and not name.startswith(("ROS_", "ROBOLINK_", "ZENOH_"))
}


# --- In the processes that are measured -------------------------------------------------------------------------------


def be_member(number: int, processes: int, nodes: int) -> None:
    """Make the nodes of a process, and tell when they are there, and when all are known."""
    import robolink
    from robolink.executors import SingleThreadedExecutor
    from robolink.interfaces.std_msgs.msg import Header

    robolink.init(args=[])
    made = [robolink.Node(f"p{number}_n{each}") for each in range(nodes)]
    publishers = [node.create_publisher(Header, f"{node.get_name()}/state", 10) for node in made]
    heard = (number + 1) % processes
    ears = [node.create_subscription(Header, f"p{heard}_n{n}/state", print, 10) for n, node in enumerate(made)]
    executor = SingleThreadedExecutor()
    for node in made:
        executor.add_node(node)
    report()
    await_word()
    expected = processes * nodes
    while len(made[0].get_node_names()) < expected:
        turn(executor)
    while sum(name.endswith("/state") for name, _ in made[0].get_topic_names_and_types()) < expected:
        turn(executor)
    report()
    await_word()
    report()
    await_word()
    del publishers, ears


def turn(executor: Any) -> None:
    """Spin until the next look: fifty processes that count names all the time are a load by themselves."""
    end = time.monotonic() + LOOK_EVERY
    while (left := end - time.monotonic()) > 0:
        executor.spin_once(left)


def be_bare(number: int, processes: int, nodes: int) -> None:
    """Announce as many tokens by Zenoh alone, and tell when all are known."""
    import zenoh

    from robolink.transport.joining import join

    session = join(int(os.environ["ROS_DOMAIN_ID"]), None, dict(os.environ), None).session
    liveliness = session.liveliness()
    seen: set[str] = set()
    channel = liveliness.declare_subscriber("@ros2_lv/**", zenoh.handlers.FifoChannel(1 << 16), history=True)
    kinds = [f"{number}/{node}/{each}" for node in range(nodes) for each in range(TOKENS)]
    name = "%|%|talker|%a|geometry_msgs::msg::dds_::Twist_|RIHS01_" + "0" * 64
    tokens = [liveliness.declare_token(f"@ros2_lv/{session.info.zid()}/{each}/{name}") for each in kinds]
    report()
    await_word()
    while len(seen) < processes * nodes * TOKENS:
        while (sample := channel.handler.try_recv()) is not None:
            seen.add(str(sample.key_expr))
        time.sleep(LOOK_EVERY)
    report()
    await_word()
    report()
    await_word()
    del tokens


def await_word() -> None:
    """Wait for a line of the process that asks; end with it."""
    if not sys.stdin.readline():
        os._exit(1)


def report() -> None:
    """Print the time, and the CPU time of this process so far, in seconds."""
    print(json.dumps({"time": time.monotonic(), "cpu": time.process_time()}), flush=True)


# --- In the process that asks -----------------------------------------------------------------------------------------


class Contender(NamedTuple):
    """One that plays: a name, the Python that runs it, and which part it has."""

    name: str
    python: str
    part: str = "member"


class Figures(NamedTuple):
    """Result of a round, in seconds."""

    wall: float
    """From the start of the first process until all know all."""
    after_last: float
    """From the start of the last."""
    start: float
    """CPU time of all processes until each had its nodes."""
    cpu: float
    """CPU time of all until all knew all."""


@contextmanager
def crowd(contender: Contender, options: argparse.Namespace) -> Iterator[list[subprocess.Popen[str]]]:
    """Start the processes; end them at the end of the `with` block."""
    found: list[subprocess.Popen[str]] = []
    environment = ENVIRONMENT | {"ROS_DOMAIN_ID": str(options.domain)}
    try:
        begin = time.monotonic()
        for number in range(options.processes):
            time.sleep(max(0.0, begin + number * options.every - time.monotonic()))
            words = [contender.python, __file__, "--part", contender.part, "--number", str(number)]
            words += ["--processes", str(options.processes), "--nodes", str(options.nodes)]
            pipe = subprocess.PIPE
            found.append(subprocess.Popen(words, stdin=pipe, stdout=pipe, text=True, env=environment, cwd="/"))
            if options.one_by_one:
                select.select([*filter(None, [found[-1].stdout])], [], [], PATIENCE)
        yield found
    finally:
        for process in found:
            process.kill()
        for process in found:
            process.communicate()


def answer(process: subprocess.Popen[str]) -> Any:
    """Return the figures that a process reports."""
    assert process.stdout is not None
    return json.loads(process.stdout.readline())


def reports(processes: Sequence[subprocess.Popen[str]]) -> list[Any]:
    """Ask all for their next report, and return these."""
    for process in processes:
        assert process.stdin is not None
        process.stdin.write("\n")
        process.stdin.flush()
    return [answer(each) for each in processes]


def play(contender: Contender, options: argparse.Namespace) -> Figures:
    """Run one round."""
    begin = time.monotonic()
    with crowd(contender, options) as processes:
        last = time.monotonic()
        made = [answer(each) for each in processes]
        seen, cost = (reports(processes) for _ in range(2))
    end = max(each["time"] for each in seen)
    start, cpu = (sum(each["cpu"] for each in found) for found in (made, cost))
    return Figures(end - begin, end - last, start, cpu)


def show(name: str, found: Sequence[Figures], first: Sequence[Figures]) -> None:
    """Print medians, least and most, and the ratio to the first contender's."""
    parts = []
    for field in Figures._fields:
        values, others = ([getattr(each, field) for each in figures] for figures in (found, first))
        median, other = statistics.median(values), statistics.median(others)
        parts.append(f"{field} {median:6.2f} ({min(values):.2f}-{max(values):.2f}) {median / (other or 1.0):5.2f}")
    print(f"  {name:24} {'; '.join(parts)}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--processes", type=int, default=20)
    parser.add_argument("--nodes", type=int, default=4, help="nodes of each process")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--every", type=float, default=0.0, help="seconds from the start of a process to the next")
    parser.add_argument("--one-by-one", action="store_true", help="start a process when the one before has its nodes")
    parser.add_argument("--domain", type=int, default=DOMAIN)
    parser.add_argument("--beside", nargs="*", default=[], help="folders of other checkouts, each with a .venv")
    parser.add_argument("--bare", action="store_true", help="Zenoh alone plays, too")
    parser.add_argument("--json", help="file for the figures")
    parser.add_argument("--part", help=argparse.SUPPRESS)
    parser.add_argument("--number", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.part:
        {"member": be_member, "bare": be_bare}[options.part](options.number, options.processes, options.nodes)
        return
    others = [Contender(path, str(Path(path).resolve() / ".venv/bin/python")) for path in options.beside]
    bare = [Contender("bare Zenoh", sys.executable, "bare")] if options.bare else []
    contenders = [*others, Contender("robolink", sys.executable), *bare]
    found: dict[str, list[Figures]] = {each.name: [] for each in contenders}
    for _ in range(options.rounds):
        for each in contenders:
            found[each.name].append(play(each, options))
            print(f"    {each.name}: {found[each.name][-1]}", file=sys.stderr, flush=True)
    print(
        f"{options.processes} processes of {options.nodes} nodes, s;"
        f" median of {options.rounds} rounds (least, most), ratio"
    )
    for name, figures in found.items():
        show(name, figures, found[contenders[0].name])
    if options.json:
        figures_of = {name: [each._asdict() for each in figures] for name, figures in found.items()}
        Path(options.json).write_text(json.dumps(figures_of), encoding="utf-8")


if __name__ == "__main__":
    main()
