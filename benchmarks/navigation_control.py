"""Benchmark of controllers: the time of one step of MPPI and of pursuit, by their sizes.

    python benchmarks/navigation_control.py [--rounds 60]

A robot stands before a bent path, beside an obstacle; the least of the rounds counts. Expected: at most 10 ms with
Nav2's own size, about half a millisecond with robolink's.
"""

from __future__ import annotations

import argparse
import functools
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

from robolink.geometry.plane import Pose
from robolink.navigation import pursuit, rollouts
from robolink.navigation.critics import Surroundings
from robolink.navigation.footprint import INSCRIBED, LETHAL
from robolink.navigation.grid import Grid
from robolink.navigation.local_path import ahead, lengths
from robolink.navigation.movers import Mover
from robolink.navigation.rollouts import Command

SIZES = ((400, 28, 0.1), (600, 28, 0.1), (1000, 56, 0.05), (2000, 56, 0.05))
"""Rollouts, steps, and seconds of a step: robolink's default first, Nav2's and that of its bringup last."""


def least(step: Callable[[], Command], rounds: int) -> float:
    """Return the least time of a step in milliseconds."""
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        assert step().is_valid
        times.append(time.perf_counter() - began)
    return 1000 * min(times)


def main() -> None:
    """Print a line for each controller."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=60, help="steps of each controller")
    rounds = parser.parse_args().rounds
    x = np.linspace(0.0, 4.0, 81)
    path = np.column_stack((x, 0.3 * np.sin(x), np.arctan(0.3 * np.cos(x))))
    part = ahead(path, lengths(path), 0.0, 1.7, 0.05)
    costs = Grid(np.zeros((60, 60), np.uint8), 0.05, (-1.5, -1.5, 0.0))
    costs.cells[44:, 44:], costs.cells[48:, 48:] = INSCRIBED, LETHAL
    pose, goal, speed = Pose(0.0, 0.0, 0.0), Pose(*map(float, path[-1])), (0.3, 0.0)
    for title, movers in (("nobody walks", []), ("two people walk", [Mover(1.5, -1.0, 0.0, 0.4, 0.37)] * 2)):
        around = Surroundings(costs, movers=movers)
        print(title)
        for size, steps, dt in SIZES:
            options = rollouts.Options(batch_size=size, time_steps=steps, model_dt=dt)
            control = rollouts.Rollouts(options, random=np.random.default_rng(1))
            took = least(functools.partial(control.step, pose, speed, part, goal, around), rounds)
            print(f"  MPPI, {size:4} rollouts of {steps} steps of {dt:g} s: {took:5.2f} ms")
        follower = pursuit.Pursuit(pursuit.Options(), inscribed=0.17)
        took = least(functools.partial(follower.step, pose, speed, part, around, 0.25), rounds)
        print(f"  pursuit: {took:5.2f} ms")


if __name__ == "__main__":
    main()
