"""Benchmark of `robolink launch`: start and stop of 30 nodes, and the launcher's CPU and memory use.

    python benchmarks/launching.py [--rounds 3] [--nodes 30] [--idle 2] [--only run,script,silent,python,bare]

Beside it in the same run: as many bare Python and Zenoh scripts, started by a plain loop of Popen and stopped by a
SIGINT to each. They take turns, so that whatever disturbs the machine disturbs all; the ratios carry over to other
machines, the figures do not.

A system is up when every node has announced itself and its publisher to a session that watches; it is down when the
launcher, or the last script, has ended. What is idle is the launcher, for `--idle` seconds.
"""

from __future__ import annotations

import argparse
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from typing import NamedTuple

import psutil

from robolink.transport import Transport, connect
from robolink.wire import graph_pattern

DOMAIN = 97
UP, DOWN, IDLE, RUN, MORE = 3.0, 2.0, 0.01, 0.3, 0.2
"""Goals: for 30 nodes seconds, seconds, and the share of a core; for one `robolink run` seconds; and the seconds that a
launch file of ROS 2 may take more than robolink's own of the same nodes."""
LABELS = {
    "run": "robolink run, one node",
    "script": "a bare script, one",
    "silent": "launcher, silent nodes",
    "python": "the same, a ROS 2 file",
    "logging": "launcher, nodes that log",
    "bare": "bare scripts",
}
"""Rows, in the order of measurement: the first two are one process, the others `--nodes`."""
SINGLE = ("run", "script")
PATIENCE = 60.0
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
ENVIRONMENT["ROS_DOMAIN_ID"] = str(DOMAIN)

NODE = '''
"""A small node: it publishes, hears and, if asked to, logs a line a second."""
from robolink.interfaces.std_msgs.msg import String
from robolink.node import Node


class Member(Node):
    def __init__(self):
        super().__init__("member")
        self.logs = self.declare_parameter("logs", False).value
        self.publisher = self.create_publisher(String, "said", 10)
        self.create_subscription(String, "heard", self.hear, 10)
        self.create_timer(1.0, self.tell)

    def hear(self, message):
        pass

    def tell(self):
        self.publisher.publish(String(data="hello"))
        if self.logs:
            self.get_logger().info("hello")
'''

BARE = f"""
import sys, time, zenoh
session = zenoh.open(zenoh.Config.from_json5('''{{
    mode: "peer",
    connect: {{endpoints: ["tcp/127.0.0.1:{17447 + DOMAIN}"]}},
    listen: {{endpoints: ["tcp/127.0.0.1:0"]}},
    scouting: {{delay: 20, multicast: {{enabled: false}}}},
}}'''))
publisher = session.declare_publisher("{DOMAIN}/said")
subscriber = session.declare_subscriber("{DOMAIN}/heard", lambda sample: None)
name, announce = f"@ros2_lv/{DOMAIN}/{{sys.argv[1]}}", session.liveliness().declare_token
tokens = [announce(f"{{name}}/{{kind}}/%said") for kind in ("NN", "MP")]
try:
    while True:
        publisher.put(b"hello")
        time.sleep(1.0)
except KeyboardInterrupt:
    session.close()
"""
"""The least that does what a node does: it meets the others, announces itself, publishes and hears."""


PYTHON = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node


def generate_launch_description():
    member = PathJoinSubstitution([ThisLaunchFileDir(), "..", "nodes", "member.py"])
    return LaunchDescription([
        DeclareLaunchArgument("logs", default_value="false"),
        *(Node(executable=member, name=f"member_{{i}}", parameters=[{{"logs": LaunchConfiguration("logs")}}])
          for i in range({nodes})),
    ])
"""
"""The same nodes as those of `silent`, in a launch file of ROS 2."""


class Taken(NamedTuple):
    """Cost of one start and stop: seconds, the share of a core, and each process's own memory in MiB."""

    up: float
    down: float
    idle: float
    memory: float


class Watcher:
    """Counts who is announced, on a session that was there before them."""

    def __init__(self, transport: Transport) -> None:
        self._changed = threading.Condition()
        self._tokens: set[str] = set()
        transport.watch(graph_pattern(DOMAIN), self._change)

    def _change(self, token: str, alive: bool) -> None:
        with self._changed:
            (self._tokens.add if alive else self._tokens.discard)(token)
            self._changed.notify_all()

    def count(self) -> tuple[int, int]:
        """How many nodes there are, and how many of their publishers."""
        nodes = sum("/NN/" in token for token in self._tokens)
        return nodes, sum("/MP/" in token and "%said" in token for token in self._tokens)

    def wait(self, nodes: int) -> None:
        """Wait until so many nodes are announced, each with its publisher."""
        with self._changed:
            if not self._changed.wait_for(lambda: self.count() == (nodes, nodes), PATIENCE):
                raise SystemExit(f"not {nodes} nodes and publishers but {self.count()} are announced")


def write_workspace(folder: Path, nodes: int) -> None:
    """Write the script, and the node with two launch files: one where nodes are silent, one where they log."""
    for name in ("nodes", "configs"):
        (folder / name).mkdir()
    (folder / "bare.py").write_text(BARE)
    (folder / "nodes" / "member.py").write_text(NODE)
    for name, logs in (("silent", "false"), ("logging", "true")):
        entry = f'{{node: member, name: "member_{{i}}", count: {nodes}, parameters: {{logs: {logs}}}}}'
        (folder / "configs" / f"{name}.yaml").write_text(f"nodes:\n  - {entry}\n")
    (folder / "configs" / "python.launch.py").write_text(PYTHON.format(nodes=nodes))


def commands(system: str, nodes: int) -> list[list[str]]:
    """Return the commands to start by hand for a system."""
    if system == "run":
        return [[sys.executable, "-m", "robolink", "run", "nodes/member.py"]]
    if system in ("bare", "script"):
        return [[sys.executable, "bare.py", str(number)] for number in range(nodes)]
    file = f"configs/{system}.launch.py" if system == "python" else f"configs/{system}.yaml"
    return [[sys.executable, "-m", "robolink", "launch", file]]


def measured(system: str, folder: Path, watcher: Watcher, nodes: int, idle: float) -> Taken:
    """Start a system, look at it, stop it."""
    nodes = 1 if system in SINGLE else nodes
    watcher.wait(0)
    environment = ENVIRONMENT | {"ROBOLINK_LOG_DIR": str(folder / "logs")}
    with ExitStack() as stack:
        started = time.perf_counter()
        processes = []
        for command in commands(system, nodes):
            process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
            stack.callback(process.kill)
            processes.append(process)
        watcher.wait(nodes)
        up = time.perf_counter() - started
        time.sleep(1.0)  # what a start leaves to do
        looks = [psutil.Process(process.pid) for process in processes]
        share, memory = share_of_a_core(looks, idle), own_memory(looks)
        return Taken(up, seconds_to_stop(processes), share, memory)


def share_of_a_core(processes: Sequence[psutil.Process], seconds: float) -> float:
    """How much of one core processes use within so many seconds, on average."""

    def used() -> float:
        return statistics.mean(sum(process.cpu_times()[:2]) for process in processes)

    before = used()
    time.sleep(seconds)
    return (used() - before) / seconds


def own_memory(processes: Sequence[psutil.Process]) -> float:
    """The MiB that no other process shares, on average."""
    return statistics.mean(process.memory_full_info().uss for process in processes) / 2**20


def seconds_to_stop(processes: Sequence[subprocess.Popen[bytes]]) -> float:
    """Interrupt processes, wait for their end."""
    options = time.perf_counter()
    for process in processes:
        process.send_signal(signal.SIGINT)
    for process in processes:
        if process.wait(PATIENCE) != 0:
            raise SystemExit(f"{process.args!r} ended with exit code {process.returncode}")
    return time.perf_counter() - options


def report(rounds: int, nodes: int, idle: float, systems: Sequence[str]) -> bool:
    """Print the table; say whether the launcher keeps to what is wanted of it."""
    with tempfile.TemporaryDirectory() as name, closing(connect(domain=DOMAIN)) as transport:
        watcher = Watcher(transport)
        write_workspace(Path(name), nodes)
        taken = [[measured(each, Path(name), watcher, nodes, idle) for each in systems] for _ in range(rounds)]
    medians = [Taken(*map(statistics.median, zip(*runs, strict=True))) for runs in zip(*taken, strict=True)]
    worst = [Taken(*map(max, zip(*runs, strict=True))) for runs in zip(*taken, strict=True)]
    print(f"{nodes} nodes, {psutil.cpu_count()} cores; medians of {rounds} rounds, and the worst")
    print(f"{'':26}  up s  worst  down s  worst  idle %  own MiB")
    for label, row, last in zip([LABELS[each] for each in systems], medians, worst, strict=True):
        times = f"{row.up:5.2f}  {last.up:5.2f}  {row.down:6.2f}  {last.down:5.2f}"
        print(f"{label:26} {times}  {row.idle * 100:6.2f}  {row.memory:7.1f}")
    found = dict(zip(systems, medians, strict=True))
    for ours, bare in (("run", "script"), ("silent", "bare")):
        if ours in found and bare in found:
            up, down = found[ours].up / found[bare].up, found[ours].down / found[bare].down
            print(f"{LABELS[ours]} / {LABELS[bare]}: up {up:.2f}, down {down:.2f}")
    silent, run = found.get("silent"), found.get("run")
    stored = silent is None or (silent.up < UP and silent.down < DOWN and silent.idle < IDLE)
    stored = stored and (run is None or run.up < RUN)
    python = found.get("python")
    if silent is not None and python is not None:
        print(f"a ROS 2 file takes {python.up - silent.up:+.2f} s more to be up than robolink's own of the same nodes")
        stored = stored and python.up - silent.up < MORE
    expected = f"of 30 nodes: up {UP} s, down {DOWN} s, idle {IDLE:.0%}; of one: up {RUN} s; a ROS 2 file: +{MORE} s"
    print(f"wanted {expected}: {'stored' if stored else 'BROKEN'}")
    return stored


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--nodes", type=int, default=30)
    parser.add_argument("--idle", type=float, default=2.0)
    parser.add_argument("--only", default="run,script,silent,python,bare", help=f"rows, of {','.join(LABELS)}")
    arguments = parser.parse_args()
    rows = [each for each in LABELS if each in arguments.only.split(",")]
    raise SystemExit(0 if report(arguments.rounds, arguments.nodes, arguments.idle, rows) else 1)


if __name__ == "__main__":
    main()
