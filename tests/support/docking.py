"""Measure how exactly the node tag_docker docks, from many starts: python -m tests.support.docking --starts 20"""

from __future__ import annotations

import argparse
import math
import random
import sys
import tempfile
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from robolink.testing import System

WORLDS = Path(__file__).resolve().parents[2] / "configs" / "worlds"

DOCK = 7.6, 3.6
"""Place 0.4 m before the tag 36h11/0 of the world signs, which looks along -x."""

MOST_METRES, MOST_DEGREES = 0.01, 2.0
"""Largest errors of a dock that is good."""


class Docked(NamedTuple):
    """End of a run: metres off the dock, degrees off its heading, and the simulated seconds that it took."""

    metres: float
    degrees: float
    seconds: float


def start(number: int) -> tuple[float, float, float]:
    """Return a start: 0.9 to 2.3 m from the tag, up to 45 degrees aside, with any heading."""
    chance = random.Random(f"docking/{number}")
    aside, far = chance.uniform(-0.8, 0.8), chance.uniform(0.9, 2.3)
    x, y = 8.0 - far * math.cos(aside), min(4.7, max(2.5, 3.6 + far * math.sin(aside)))
    if math.hypot(x - 5.0, y - 3.2) < 0.6:  # the box with a tag of its own
        x = 5.8
    return x, y, chance.uniform(-math.pi, math.pi)


def dock(folder: Path, number: int) -> Docked:
    """Let the robot of the world signs dock from a start; `folder` is for its world file."""
    world: Any = yaml.safe_load((WORLDS / "signs.yaml").read_text(encoding="utf-8"))
    for sign in world["signs"]:
        if "image" in sign:
            sign["image"] = str(WORLDS / sign["image"])
    world["robots"][0]["pose"] = list(start(number))
    path = folder / f"signs_{number}.yaml"
    path.write_text(yaml.safe_dump(world), encoding="utf-8")
    with System(seed=number) as system:
        simulated: Any = system.start("world", parameters={"world": str(path)})
        docker: Any = system.start("tag_docker")
        system.wait_until(lambda: docker.phase.value == "docked", within=120.0)
        pose, simulation = simulated.simulation.world.robots["robot"].pose, simulated.simulation
        off = math.hypot(pose.x - DOCK[0], pose.y - DOCK[1])
        return Docked(off, abs(math.degrees(pose.theta)), simulation.world.time_ns / 1e9)


def main() -> None:
    """Dock from so many starts, and write a line for each and one for all."""
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--starts", type=int, default=20, help="number of starts")
    runs, say = list[Docked](), sys.stdout.write
    with tempfile.TemporaryDirectory() as folder:
        for number in range(words.parse_args().starts):
            run = dock(Path(folder), number)
            runs.append(run)
            say(f"{number:3}: {1000 * run.metres:4.1f} mm, {run.degrees:4.2f} degrees, after {run.seconds:5.1f} s\n")
    good = sum(run.metres <= MOST_METRES and run.degrees <= MOST_DEGREES for run in runs)
    worst = max(run.metres for run in runs), max(run.degrees for run in runs)
    say(f"{good} of {len(runs)} within 10 mm and 2 degrees; worst {1000 * worst[0]:.1f} mm, {worst[1]:.2f} degrees\n")


if __name__ == "__main__":
    main()
