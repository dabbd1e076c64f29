"""Circles hidden behind other shapes are left out of a scan's arithmetic, which changes no bit of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robolink.sim.arrays import Array, Indices
from robolink.sim.quantities import Pose
from robolink.sim.sensing import lidar as module
from robolink.sim.sensing.lidar import Beams, distances, returns_batch
from robolink.sim.sensing.scene import FIXED, Circles, Surroundings, Tiles, circles_of
from robolink.sim.sensors import Lidar

LIDARS = [
    Lidar("round"),
    Lidar("few", beams=7),
    Lidar("odd", beams=61, fov=250),
    Lidar("ahead", beams=181, fov=180, start=-30.0),
    Lidar("near", beams=720, range=(0.1, 3.0)),
]


def hall(seed: int) -> tuple[Surroundings, Array]:
    """Return ten robots among walls and a hundred pillars, some of which touch a robot, or hold it inside."""
    random = np.random.default_rng(seed)
    starts = random.uniform(0, 10, (30, 2))
    walls = np.concatenate((starts, starts + random.uniform(-3, 3, (30, 2))), axis=1)
    circles = np.column_stack((random.uniform(0, 10, (100, 2)), random.uniform(0.02, 0.5, 100)))
    poses = np.column_stack((random.uniform(0, 10, (10, 2)), random.uniform(-3, 3, 10)))
    owner = np.where(np.arange(100) < 10, np.arange(100), FIXED)
    circles[:10, :2] = poses[:, :2]
    return Surroundings(Tiles(walls, np.full(30, 0.5)), circles_of(circles, random.uniform(0.1, 1, 100), owner)), poses


@pytest.mark.slow
@settings(max_examples=25)
@given(st.integers(0, 10**6), st.sampled_from(LIDARS))
def test_hidden_circles_change_no_bit(seed: int, lidar: Lidar) -> None:
    (around, poses), beams = hall(seed), Beams(lidar)
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(module, "_MANY", 10**9)
        ranges, light = returns_batch(beams, poses, around, np.arange(10))
        patched.setattr(module, "_MANY", 1)
        found, lit = returns_batch(beams, poses, around, np.arange(10))
        assert (found.tobytes(), lit.tobytes()) == (ranges.tobytes(), light.tobytes())
        for row, pose in enumerate(poses.tolist()):
            assert distances(beams, Pose(*pose), around, row).tobytes() == ranges[row].tobytes()


def test_most_circles_behind_walls_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    seen, see = [], module._see_circles

    def look(beams: Beams, eyes: module._Eyes, circles: Circles, lit: bool) -> module._Hits:
        seen.append(len(circles.x))
        return see(beams, eyes, circles, lit)

    monkeypatch.setattr(module, "_see_circles", look)
    box = np.array([[-1, -1, 1, -1], [1, -1, 1, 1], [1, 1, -1, 1], [-1, 1, -1, -1]], dtype=np.float64)
    ring = np.array([(4 * np.cos(turn), 4 * np.sin(turn), 0.1) for turn in np.arange(0, 6.2, 0.06)])
    inside = np.array([[0.5, 0.5, 0.1]])
    fixed: Indices = np.full(len(ring) + 1, FIXED)
    circles = circles_of(np.concatenate((ring, inside)), np.ones(len(fixed)), fixed)
    ranges = distances(Beams(Lidar("scan")), Pose(0.0, 0.0), Surroundings(Tiles(box, np.ones(4)), circles))
    assert seen == [1]
    assert ranges.min() == pytest.approx(0.5 * np.sqrt(2) - 0.1, abs=1e-3)
