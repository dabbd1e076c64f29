"""Rows of the benchmark of record: what is measured, who plays, and how; a game gives figures of one or more rows."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from benchmarks import simulating
from benchmarks.messages import dataflow, running
from benchmarks.messages.running import Contender, GameError
from benchmarks.record.players import Player

Figures = dict[str, float]
"""Figures of a round by their row; `ROW/lost` and the like stand beside a row's own."""


class Row(NamedTuple):
    """A row: its titles in English and in Portuguese, and the unit of its figures: us, /s, %, s or MB."""

    english: str
    portuguese: str
    unit: str


ROWS = {
    "twist": Row("round trip of a Twist", "ida e volta de um Twist", "us"),
    "scan": Row("round trip of a scan of 360", "ida e volta de um scan de 360", "us"),
    "1mb": Row("round trip of an image of 1 MB", "ida e volta de uma imagem de 1 MB", "us"),
    "6mb": Row("round trip of an image of 6.2 MB", "ida e volta de uma imagem de 6,2 MB", "us"),
    "rate-1mb": Row("images of 1 MB received a second", "imagens de 1 MB recebidas por segundo", "/s"),
    "flood-10": Row("Twists of a flood received a second, depth 10", "Twists recebidos por segundo, depth 10", "/s"),
    "flood-1000": Row("the same, depth 1000", "o mesmo, depth 1000", "/s"),
    "flood-all": Row("the same, KEEP_ALL", "o mesmo, KEEP_ALL", "/s"),
    "beat": Row("share of a core: a Twist sent at 100 Hz", "parte de um núcleo: um Twist enviado a 100 Hz", "%"),
    "start": Row("from the import to an announced node", "do import a um node anunciado", "s"),
    "start/used": Row("processor time of that", "tempo de processador disso", "s"),
    "memory": Row(
        "memory of an idle node beside another (PSS)", "memória de um node parado ao lado de outro (PSS)", "MB"
    ),
    "fifty": Row(
        "50 processes of 4 nodes at once, until all know all",
        "50 processos de 4 nodes de uma vez, até que todos conheçam todos",
        "s",
    ),
    "hour": Row("a simulated hour of three nodes with faults", "uma hora simulada de três nodes com falhas", "s"),
    "follow": Row("`robolink simulate follow --duration 600`", "`robolink simulate follow --duration 600`", "s"),
    "dds": Row(
        "a Twist to a real rclpy and back, over DDS", "um Twist a um rclpy de verdade e de volta, por DDS", "us"
    ),
}
OURS = ("robolink", "build")
ROS = (*OURS, "rclpy")
TALKERS = (*OURS, "bare", "rclpy", "sdk", "dora", "zeromq")
SETTLE = 1.0
"""Seconds for which a node idles before its memory is read."""
FIFTY = (50, 4)


class Options(NamedTuple):
    """How long games are: whole ones, or a look whether all of them run."""

    quick: bool = False

    def seconds(self, whole: float) -> float:
        return 0.1 if self.quick else whole


class Turn(NamedTuple):
    """One turn of a game: who plays, everybody who is there, and the lengths."""

    name: str
    player: Player
    everybody: Mapping[str, Player]
    options: Options

    @property
    def contender(self) -> Contender:
        return self.player.contender


class Game(NamedTuple):
    """A game: its name is that of its row, or the first of its rows."""

    name: str
    players: tuple[str, ...]
    play: Callable[[Turn], Figures]
    needs: str = ""
    """A player without whom nobody can play."""
    more: tuple[str, ...] = ()
    """Other rows of which it gives figures."""

    @property
    def rows(self) -> tuple[str, ...]:
        return (self.name, *self.more)


def trips(turn: Turn) -> Figures:
    """Round trips, by `spin` at both ends."""
    seconds = turn.options.seconds(0.5)
    if turn.player.name == "dora":
        trip = statistics.median(dataflow.trips(turn.contender, turn.name, seconds))
    else:
        trip = running.round_trips(turn.contender, turn.name, seconds)
    return {turn.name: trip}


def dds(turn: Turn) -> Figures:
    """A Twist to a real node and back: from a node of robolink over DDS, or from another real one."""
    real = turn.everybody["rclpy"].contender
    asks = turn.contender._replace(environ=(("ROBOLINK_NETWORK", "dds"),))
    return {"dds": running.round_trips(asks, "twist", turn.options.seconds(0.5), real)}


def flood(turn: Turn) -> Figures:
    """As many as one process can send, received by another: each numbered, its content looked at."""
    kind, variant = {
        "rate-1mb": ("1mb", "depth-10"),
        "flood-10": ("twist", "depth-10"),
        "flood-1000": ("twist", "depth-1000"),
        "flood-all": ("twist", ""),
    }[turn.name]
    contender = turn.contender._replace(variant=variant)
    pour = dataflow.flood if turn.player.name == "dora" else running.flood
    found = pour(contender, kind, turn.options.seconds(0.7))
    return {turn.name: found.rate, f"{turn.name}/lost": found.lost, f"{turn.name}/wrong": float(found.wrong)}


def beat(turn: Turn) -> Figures:
    """A hundred Twists a second from a timer, to a subscription in another process: the sender's processor time."""
    play = dataflow.beat if turn.player.name == "dora" else running.beat
    return {"beat": play(turn.contender._replace(variant="depth-10"), "twist", turn.options.seconds(1.5))}


def alone(turn: Turn) -> Figures:
    """A process with one node: its start, seen by another process of the same packages, and its memory beside that."""
    role = {"rclpy": "nodes", "sdk": "ros2_sdk"}.get(turn.player.name, "zenoh")
    watcher = turn.contender._replace(module="watch", variant=role)
    found = running.alone(turn.contender, watcher, turn.options.seconds(SETTLE))
    memory = {} if found.memory is None else {"memory": found.memory}
    return {"start": found.seconds, "start/used": found.used, **memory}


def fifty(turn: Turn) -> Figures:
    """Many processes that start at once."""
    processes, each = (5, 2) if turn.options.quick else FIFTY
    return {"fifty": running.crowd(turn.contender, processes, each)}


def simulated(turn: Turn) -> Figures:
    """Processor time of `robolink simulate`, in a process of its own."""
    seconds = {"hour": 3600.0, "follow": 600.0}[turn.name] / (60.0 if turn.options.quick else 1.0)
    with tempfile.TemporaryDirectory() as folder:
        given = ["follow"]
        if turn.name == "hour":
            given = ["./loop.yaml", "--faults", "./faults.yaml", "--seed", "3"]
            texts = {"loop.py": simulating.NODES, "loop.yaml": simulating.LAUNCH, "faults.yaml": simulating.FAULTS}
            for name, text in texts.items():
                Path(folder, name).write_text(text, encoding="utf-8")
        command = [turn.contender.python, "-m", "robolink", "simulate", *given, "--duration", str(seconds), "--json"]
        before = os.times()
        done = subprocess.run(
            command,
            cwd=folder,
            env=running.environment(turn.contender, first=False),
            capture_output=True,
            text=True,
            check=False,
        )
        after = os.times()
    if done.returncode:
        raise GameError((done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1])
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return {turn.name: used, f"{turn.name}/wall": float(json.loads(done.stdout.splitlines()[-1])["real_seconds"])}


GAMES = (
    Game("twist", TALKERS, trips),
    Game("scan", TALKERS, trips),
    Game("1mb", TALKERS, trips),
    Game("6mb", TALKERS, trips),
    Game("rate-1mb", TALKERS, flood),
    Game("flood-10", (*ROS, "dora"), flood),
    Game("flood-1000", (*ROS, "dora"), flood),
    Game("flood-all", (*OURS, "bare", "rclpy", "sdk", "zeromq"), flood),
    Game("beat", TALKERS, beat),
    Game("start", (*ROS, "bare", "sdk"), alone, more=("memory",)),
    Game("dds", ROS, dds, needs="rclpy"),
    Game("hour", OURS, simulated),
    Game("follow", OURS, simulated),
    Game("fifty", OURS, fifty),  # real ones did not know each other after 50 seconds of two cores
)
