"""Workspace with a small system for `robolink simulate`: a talker, a listener that counts, and ways to fail."""

from __future__ import annotations

from pathlib import Path

from robolink.faults import FaultsDescription, read_faults
from robolink.launch import read_launch_file
from robolink.simulate import SimulationResult, Watching, simulate

NODES = {
    "talker": '''
"""Publishes numbers on /chatter, ten a second; ends in an error at the number `fails_at`."""

from robolink import Node
from robolink.interfaces.std_msgs.msg import Int32


class Talker(Node):
    def __init__(self, **options):
        super().__init__("talker", **options)
        self.fails_at = self.declare_parameter("fails_at", -1).value
        self.chatter = self.create_publisher(Int32, "chatter", 10)
        self.count = 0
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.count += 1
        if self.count == self.fails_at:
            raise ZeroDivisionError("it was to fail")
        self.chatter.publish(Int32(data=self.count))
''',
    "listener": '''
"""Repeats what it hears on /heard, with its own stamp in /stamps."""

from robolink import Node
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.std_msgs.msg import Int32


class Listener(Node):
    def __init__(self, **options):
        super().__init__("listener", **options)
        self.heard = self.create_publisher(Int32, "heard", 10)
        self.stamps = self.create_publisher(Time, "stamps", 10)
        self.create_subscription(Int32, "chatter", self.hear, 10)

    def hear(self, message):
        self.heard.publish(message)
        self.stamps.publish(self.get_clock().now().to_msg())
''',
    "gambler": '''
"""Publishes random numbers, and the seed that it was given."""

import random

import numpy

from robolink import Node
from robolink.interfaces.std_msgs.msg import Float64, Int64


class Gambler(Node):
    def __init__(self, **options):
        super().__init__("gambler", **options)
        self.luck = self.create_publisher(Float64, "luck", 10)
        self.seed = self.create_publisher(Int64, "seed", 10)
        self.given = self.declare_parameter("seed", -1).value
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.luck.publish(Float64(data=random.random() + numpy.random.random()))
        self.seed.publish(Int64(data=self.given))
''',
}

TALK = "nodes:\n  - {node: talker}\n  - {node: listener}\n"


def workspace(folder: Path, **launch_files: str) -> Path:
    """Make a workspace with the nodes above and launch files by name; `talk` is one of talker and listener."""
    for name in ("nodes", "configs"):
        (folder / name).mkdir()
    for name, text in NODES.items():
        (folder / "nodes" / f"{name}.py").write_text(text)
    for name, text in {"talk": TALK, **launch_files}.items():
        (folder / "configs" / f"{name}.yaml").write_text(text)
    return folder


def simulated(
    folder: Path,
    launch: str = "talk",
    *,
    duration: float = 10.0,
    seed: int | None = None,
    faults: str = "",
    watching: Watching | None = None,
    record: Path | None = None,
) -> SimulationResult:
    """Simulate a launch file of a workspace, with faults written as in a file."""
    entries = read_launch_file(folder / "configs" / f"{launch}.yaml", {})
    wrong: FaultsDescription | None = read_faults("faults.yaml", text=faults).value if faults else None
    return simulate(entries, duration=duration, seed=seed, faults=wrong, watching=watching, record=record or "")
