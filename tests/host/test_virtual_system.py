"""A whole robot system in one process: a minute of its life in well under a second, twice the same byte for byte."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import msgspec
import pytest

from robolink.launch import read_launch_file
from robolink.simulate import SimulationResult, simulate

FOLLOW = """
nodes:
  - node: world
    parameters: {world: corners}
  - node: wall_follower
    parameters: {speed: %s}
"""


def follow(folder: Path, seconds: float, speed: float) -> SimulationResult:
    """Let a robot follow the walls of the cornered room."""
    file = folder / "follow.yaml"
    file.write_text(FOLLOW % speed)
    return simulate(read_launch_file(file), duration=seconds)


def laboratory(hash_seed: str) -> dict[str, Any]:
    """Simulate the laboratory, with noise on everything, in a process of its own."""
    command = [sys.executable, "-m", "robolink", "simulate", "lab", "--duration", "5", "--json"]
    env = {**os.environ, "PYTHONHASHSEED": hash_seed}
    done = subprocess.run(command, env=env, stdout=subprocess.PIPE, text=True, check=True, timeout=60)
    found: dict[str, Any] = msgspec.json.decode(done.stdout.splitlines()[-1])
    return found


@pytest.mark.slow
@pytest.mark.timeout(30)
def test_a_minute_of_a_robots_life_is_the_same_twice_byte_for_byte(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    first, again = follow(tmp_path, 60.0, speed=0.4), follow(tmp_path, 60.0, speed=0.4)
    assert first.hash == again.hash
    assert first.messages == again.messages
    assert [first.messages[topic] for topic in ("/scan", "/odom", "/tf")] == pytest.approx([600, 3000, 3000], abs=1)
    assert first.messages["/cmd_vel"] == pytest.approx(first.messages["/scan"], abs=1)
    assert first.messages["/rosout"] > 30
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
def test_another_robot_leaves_another_trace(tmp_path: Path) -> None:
    assert follow(tmp_path, 2.0, speed=0.4).hash != follow(tmp_path, 2.0, speed=0.3).hash


@pytest.mark.processes
def test_a_noisy_laboratory_is_the_same_in_two_processes() -> None:
    """The same on other Pythons too: .ci/run compares them."""
    one, other = laboratory("1"), laboratory("2")
    assert one["hash"] == other["hash"]
    assert one["messages"] == other["messages"]
    assert {each["name"] for each in one["robots"]} == {"ada", "bob"}
