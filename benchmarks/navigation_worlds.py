"""Benchmark of navigation: thirty worlds of obstacles, from start to goal, by all servers in virtual time.

    python benchmarks/navigation_worlds.py [--only NUMBER ...] [--parameters FILE] [--jobs 1] [--own-map]

A line for each world: whether the goal was reached, contacts, the time as a multiple of the shortest way's at full
speed, recoveries, and how many times as fast as life it was on one core. Expected: at least 28 of 30 reached without
contact within 1.5. With `--own-map` the first six worlds are driven with a map that the robot made
before, led to the goal and back. Figures are in benchmarks/notes/navigation.md.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.support.navigation_lives import PARAMETERS, Life, lived
from tests.support.navigation_worlds import WORLDS, navigation_world


def tried(job: tuple[int, str, bool]) -> tuple[int, Life]:
    """Drive through the world of a number, with a file of parameters, and perhaps with a map that was made before."""
    number, parameters, has_own_map = job
    with tempfile.TemporaryDirectory() as folder:
        return number, lived(navigation_world(number), Path(folder), Path(parameters), has_own_map=has_own_map)


def line(number: int, life: Life) -> str:
    """Return the line of a world."""
    world = navigation_world(number)
    mark = "ok  " if life.is_good else "FAIL"
    return (
        f"{mark} {world.name:14} {world.length:5.1f} m  reached {life.has_reached!s:5}  contacts {life.contacts}"
        f"  {life.seconds:5.1f} s  x{life.ratio:.2f}  recoveries {life.recoveries}  {life.speed:5.1f} times life"
        f"  {life.words[:120]}"
    )


def main() -> None:
    """Run what the command line requests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", type=int, nargs="*", help="numbers of worlds")
    parser.add_argument("--own-map", action="store_true", help="six worlds, with maps that the robot makes first")
    parser.add_argument("--parameters", default=str(PARAMETERS), help="file of parameters")
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    requested = parser.parse_args()
    numbers = requested.only or (WORLDS[:6] if requested.own_map else WORLDS)
    jobs = [(number, requested.parameters, requested.own_map) for number in numbers]
    lives = []
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):  # of the processes, as `robolink simulate` sets them
        os.environ.setdefault(name, "1")
    with multiprocessing.get_context("spawn").Pool(requested.jobs, maxtasksperchild=4) as pool:
        for number, life in pool.imap(tried, jobs):
            print(line(number, life), flush=True)
            lives.append(life)
    good = sum(each.is_good for each in lives)
    speed = sum(each.seconds for each in lives) / sum(each.seconds / each.speed for each in lives)
    print(f"{good} of {len(lives)} reached without contact within 1.5; {speed:.1f} times as fast as life")


if __name__ == "__main__":
    main()
