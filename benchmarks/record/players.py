"""Who plays in the benchmark of record: robolink, another build of it, and its peers, each by a Python that has it."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from benchmarks.messages.running import Contender


class Player(NamedTuple):
    """A player: its name in the file, its title, how it plays, and the packages whose versions are recorded."""

    name: str
    title: str
    contender: Contender
    packages: tuple[str, ...]
    """The first is what must be installed."""
    option: str = ""
    """Option of the Python that has it; "" is the one that measures."""


PLAYERS = (
    Player("robolink", "robolink", Contender("robolink", "nodes", "spin"), ("robolink", "eclipse-zenoh")),
    Player("build", "other build", Contender("build", "nodes", "spin"), ("robolink", "eclipse-zenoh"), "build"),
    Player("bare", "bare Zenoh", Contender("bare", "bare"), ("eclipse-zenoh",)),
    Player("rclpy", "rclpy", Contender("rclpy", "nodes", "spin"), ("rclpy", "ros-rmw-fastrtps-cpp"), "real"),
    Player("sdk", "zenoh-ros2-sdk", Contender("sdk", "ros2_sdk"), ("zenoh-ros2-sdk", "eclipse-zenoh"), "peers"),
    Player("dora", "dora", Contender("dora", "dora_node"), ("dora-rs", "dora-rs-cli", "pyarrow"), "peers"),
    Player("zeromq", "pyzmq", Contender("zeromq", "zeromq"), ("pyzmq", "msgspec"), "peers"),
)

ASK = """
import importlib.metadata, json, os, platform, subprocess, sys
found = {}
for name in sys.argv[1:]:
    try:
        found[name] = importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        pass
if "robolink" in found:
    import robolink
    git = ["git", "-C", os.path.dirname(robolink.__file__), "describe", "--always", "--dirty"]
    try:
        found["commit"] = subprocess.run(git, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        pass
print(json.dumps({"python": platform.python_version(), **found}))
"""
"""Program that prints the versions of packages."""


class Field(NamedTuple):
    """Those who play, their versions, and why others do not."""

    players: dict[str, Player]
    versions: dict[str, dict[str, str]]
    missing: dict[str, str]


def field(pythons: Mapping[str, str | None]) -> Field:
    """Return the players that are installed.

    Args:
        pythons: For each option the path of a Python. Peers may be installed beside robolink as well.
    """
    found = Field({}, {}, {})
    for player in PLAYERS:
        if player.option in ("build", "real") and not pythons.get(player.option):
            found.missing[player.name] = f"no --{player.option} is given"
            continue
        python = pythons.get(player.option) or sys.executable
        try:
            versions = versions_of(python, player.packages)
        except (OSError, subprocess.SubprocessError, ValueError) as error:
            found.missing[player.name] = f"{python} does not run: {error}"
            continue
        if player.packages[0] not in versions:
            found.missing[player.name] = f"{player.packages[0]} is not installed"
            continue
        found.versions[player.name] = versions
        found.players[player.name] = player._replace(contender=player.contender._replace(python=python))
    return found


def versions_of(python: str, packages: tuple[str, ...]) -> dict[str, str]:
    """Return the versions that a Python has of some packages, its own, and the commit of a checkout of robolink."""
    done = subprocess.run(
        [python, "-c", ASK, *packages], capture_output=True, text=True, check=True, timeout=60, cwd=Path(python).parent
    )  # in a folder without a robolink, which Python would find first
    return dict(json.loads(done.stdout))
