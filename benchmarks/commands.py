"""Benchmark of commands: run time beside 30 nodes and 200 topics, and of a bare Zenoh script in the same run.

    python benchmarks/commands.py [--runs 10] [--processes 5]

The programs take turns, so that whatever disturbs the machine disturbs all of them; the ratios carry over to other
machines, the figures do not. What a program prints is checked each time: a command that lists less than all fails.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

DOMAIN = 98
NODES, TOPICS = 30, 200
ENVIRONMENT = {**os.environ, "ROS_DOMAIN_ID": str(DOMAIN), "PYTHONUNBUFFERED": "1"}
ROBOLINK = (sys.executable, "-m", "robolink")

BARE = f"""
import os, queue, sys, zenoh
config = zenoh.Config.from_json5('''{{
    mode: "peer",
    connect: {{endpoints: ["tcp/127.0.0.1:{17447 + DOMAIN}"]}},
    listen: {{endpoints: ["tcp/127.0.0.1:0"]}},
    scouting: {{delay: 20, multicast: {{enabled: false}}}},
}}''')
session, names, arrived = zenoh.open(config), set(), queue.SimpleQueue()
watch = session.liveliness().declare_subscriber("@ros2_lv/{DOMAIN}/**", arrived.put, history=True)
while len(names) < {TOPICS + 2}:
    fields = str(arrived.get(timeout=5).key_expr).split("/")
    if fields[5] == "MP":
        names.add(fields[9].replace("%", "/"))
print(*sorted(names), sep="\\n", flush=True)
os._exit(0)
"""
"""The least that a program can do to list topics: it knows how many there are, and leaves at once."""


class Row(NamedTuple):
    """A program, what it must print and how many lines at least, and how many seconds its median may be."""

    name: str
    command: Sequence[str]
    shown: str = ""
    lines: int = 0
    limit: float | None = None


def robolink(arguments: str, shown: str, lines: int = 0, limit: float | None = None) -> Row:
    """A command of robolink."""
    return Row(f"robolink {arguments}", (*ROBOLINK, *arguments.split()), shown, lines, limit)


ROWS = (
    Row("python -c pass", (sys.executable, "-c", "pass")),
    Row("python -c 'import typer'", (sys.executable, "-c", "import typer")),
    Row("bare Zenoh script", (sys.executable, "-c", BARE), "/bench/topic_199", TOPICS),
    robolink("--help", "Commands:", limit=0.2),
    robolink("run --list", "wall_follower"),
    robolink("topic list", "/bench/topic_199", TOPICS, 0.7),
    robolink("node list", "/bench/node_29", NODES, 0.7),
    robolink("node info /bench/node_7", "/bench/topic_7: ", limit=0.7),
    robolink("topic info -v /bench/topic_7", "node_7", limit=0.7),
    robolink("service list", "/bench/switch_29", NODES, 0.7),
    robolink("interface list", "sensor_msgs/msg/LaserScan", limit=0.7),
    robolink("topic echo --once /bench/topic_0", "linear:", limit=1.0),
    robolink("service call /bench/switch_7 std_srvs/srv/SetBool", "success=True", limit=1.0),
    robolink("param list", "/bench/node_29:", NODES, 1.0),
    robolink("param get /bench/node_7 use_sim_time", "Boolean value is: False", limit=1.0),
    robolink("doctor", "", limit=2.0),
)


def run_nodes(first: int, count: int) -> None:
    """Be a process of the system: `count` nodes from number `first` on, which move and answer until killed."""
    import robolink as rclpy
    from robolink.executors import SingleThreadedExecutor
    from robolink.interfaces.geometry_msgs.msg import Twist
    from robolink.interfaces.std_srvs.srv import SetBool

    def switch(_: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        response.success = True
        return response

    rclpy.init(args=[], domain_id=DOMAIN)
    executor = SingleThreadedExecutor()
    for number in range(first, first + count):
        node = rclpy.create_node(f"node_{number}", namespace="/bench")
        for topic in range(number, TOPICS, NODES):
            publisher = node.create_publisher(Twist, f"topic_{topic}", 10)
            node.create_subscription(Twist, f"topic_{(topic + 1) % TOPICS}", id, 10)
            if topic % 10 == 0:
                node.create_timer(0.05, lambda publisher=publisher: publisher.publish(Twist()))
        node.create_service(SetBool, f"switch_{number}", switch)
        executor.add_node(node)
    print("ready")
    executor.spin()


@contextmanager
def system(processes: int) -> Iterator[None]:
    """All nodes, in so many processes, until the end of the block."""
    share = -(-NODES // processes)
    with ExitStack() as stack:
        started = []
        for first in range(0, NODES, share):
            command = [sys.executable, __file__, "nodes", str(first), str(min(share, NODES - first))]
            process = subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True)
            stack.enter_context(process)
            stack.callback(process.kill)
            started.append(process)
        for process in started:
            assert process.stdout
            if process.stdout.readline() != "ready\n":
                raise SystemExit("a process of the system did not start")
        yield


def seconds(row: Row) -> float:
    """Run a program once; check what it prints."""
    started = time.perf_counter()
    done = subprocess.run(row.command, env=ENVIRONMENT, capture_output=True, text=True, check=False, timeout=60)
    took = time.perf_counter() - started
    if row.shown not in done.stdout or done.stdout.count("\n") < row.lines:
        expected = f"'{row.shown}' and {row.lines} lines"
        raise SystemExit(f"{row.name}: expected {expected}, got {len(done.stdout)} bytes: {done.stdout}{done.stderr}")
    return took


def report(runs: int, processes: int) -> bool:
    """Print the table; say whether all medians keep to their limits."""
    with system(processes):
        rounds = [[seconds(row) for row in ROWS] for _ in range(runs + 1)][1:]  # the first fills caches
    columns = list(zip(*rounds, strict=True))
    medians = [statistics.median(column) for column in columns]
    bare = medians[[row.name for row in ROWS].index("bare Zenoh script")]
    stored = True
    print(f"{NODES} nodes and {TOPICS} topics in {processes} processes; {runs} runs, median and worst in ms")
    print(f"{'':56} median  worst  / bare  limit")
    for row, median, column in zip(ROWS, medians, columns, strict=True):
        verdict = ""
        if row.limit is not None:
            verdict = f"{row.limit * 1e3:5.0f} {'stored' if median < row.limit else 'BROKEN'}"
            stored = stored and median < row.limit
        print(f"{row.name:56} {median * 1e3:6.0f} {max(column) * 1e3:6.0f} {median / bare:7.2f}  {verdict}".rstrip())
    return stored


def main() -> None:
    if sys.argv[1:2] == ["nodes"]:
        run_nodes(int(sys.argv[2]), int(sys.argv[3]))
        return
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--processes", type=int, default=5)
    arguments = parser.parse_args()
    raise SystemExit(0 if report(arguments.runs, arguments.processes) else 1)


if __name__ == "__main__":
    main()
