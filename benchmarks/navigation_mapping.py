"""Benchmark of mapping: three worlds with things that move, odometry spoiled by systematic errors, a lidar with noise.

    python benchmarks/navigation_mapping.py [--only lab] [--seeds 3] [--seconds 240] [--still]

A line for each drive: root mean squares of the poses' errors by odometry and by the map, of the distances from occupied
cells to the nearest true wall (without those where something moved), loops that are believed, and what it took: a
keyframe in the mean and at worst, and the whole map drawn anew. Expected: walls within 5 cm, 40 ms a keyframe.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one core is what is measured
sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np

from robolink.geometry.plane import Pose
from robolink.navigation.mapper import Mapper
from robolink.navigation.occupancy import Lidar, beams_of
from tests.support.mapping_drives import TOURS, Drive, driven, standing, wall_distances


class Row(NamedTuple):
    """Figures of a drive: metres, and milliseconds."""

    scans: int
    keyframes: int
    odometry: float
    poses: float
    walls: float
    worst_wall: float
    loops: int
    mean: float
    most: float
    drawing: float


def measured(drive: Drive) -> Row:
    """Map a drive."""
    mapper, truth, spent = Mapper(), [], []
    for true, odometry, ranges in zip(drive.truth, drive.odometry, drive.ranges, strict=True):
        before = len(mapper.keyframes)
        began = time.perf_counter()
        beams = beams_of(ranges, drive.angles, (0.12, 12.0), 12.0, Lidar())
        fit = mapper.process(beams, Pose(*odometry.tolist()))
        if fit is not None:
            spent.append(1e3 * (time.perf_counter() - began))
        if len(mapper.keyframes) > before:
            truth.append(true)
    began = time.perf_counter()
    grid = mapper.grid()
    drawing = 1e3 * (time.perf_counter() - began)
    cells = np.column_stack(grid.cell_to_world(*np.nonzero(grid.cells == 100)))
    walls = wall_distances(drive, standing(drive, cells))
    return Row(
        len(drive.truth),
        len(mapper.keyframes),
        rms(np.hypot(*(drive.odometry - drive.truth)[:, :2].T)),
        rms(np.hypot(*(mapper.graph.poses - np.array(truth))[:, :2].T)),
        rms(walls),
        float(walls.max()),
        sum(each.weight > 0.5 for each in mapper.graph.loops),
        float(np.mean(spent)),
        max(spent),
        drawing,
    )


def rms(numbers: np.ndarray) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(np.square(numbers))))


def main() -> None:
    """Run what the command line requests."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=TOURS, nargs="*", default=list(TOURS), help="worlds")
    parser.add_argument("--seeds", type=int, default=3, help="drives in each world")
    parser.add_argument("--seconds", type=float, default=240.0, help="length of a drive")
    parser.add_argument("--still", action="store_true", help="without things that move")
    requested = parser.parse_args()
    print("world      seed keyframes  odometry   poses    walls (worst)  loops   a keyframe (most)  drawing")
    for world in requested.only:
        for seed in range(requested.seeds):
            with tempfile.TemporaryDirectory() as folder:
                drive = driven(Path(folder), world, requested.seconds, seed, movers=not requested.still)
            row = measured(drive)
            print(
                f"{world:10} {seed:4} {row.keyframes:9}  {row.odometry:6.2f} m  {100 * row.poses:4.1f} cm"
                f"  {100 * row.walls:4.1f} cm ({100 * row.worst_wall:3.0f})  {row.loops:5}"
                f"  {row.mean:6.1f} ms ({row.most:3.0f})  {row.drawing:6.0f} ms",
                flush=True,
            )


if __name__ == "__main__":
    main()
