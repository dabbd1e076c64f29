"""Scans of robots in a world: noise, dropout, mounting, and what they see of each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.sim import World, load_world
from robolink.sim.sensing.lidar import Beams, distances
from robolink.sim.sensing.scene import standing
from robolink.sim.sensors import Lidar

NO_CIRCLES = np.zeros((0, 3))
ROOM = np.array([[0, 0, 8, 0], [8, 0, 8, 5], [8, 5, 0, 5], [0, 5, 0, 0]], dtype=np.float64)

WORLD = """
world: {{seed: {seed}}}
walls: [{{polyline: [[0, 0], [8, 0], [8, 5], [0, 5]], closed: true}}]
robots:
  - name: first
    pose: [2, 2, 0]
    sensors: [{{lidar: scan, noise: 0.02, dropout: 0.1}}, {{lidar: rear, noise: 0.02}}]
  {others}
"""
SECOND = "- {name: second, pose: [6, 3, 1], sensors: [{lidar: scan, noise: 0.02}]}"


def noisy(seed: int = 1, others: str = "") -> World:
    return World(load_world("noisy.yaml", text=WORLD.format(seed=seed, others=others)))


def test_noise_has_its_size_and_dropout_its_share() -> None:
    robot = noisy().robots["first"]
    exact = distances(Beams(Lidar("scan")), robot.pose, standing(ROOM, NO_CIRCLES))
    ranges = np.array([robot.scan().ranges for _ in range(50)])
    lost = np.isposinf(ranges)
    assert lost.mean() == pytest.approx(0.1, abs=0.01)
    assert (ranges - exact)[~lost].std() == pytest.approx(0.02, rel=0.03)
    assert (ranges - exact)[~lost].mean() == pytest.approx(0.0, abs=0.001)


def test_the_same_seed_gives_the_same_noise_and_another_seed_another() -> None:
    scans = [noisy(seed).robots["first"].scan().ranges.tobytes() for seed in (1, 1, 2)]
    assert scans[0] == scans[1] != scans[2]


def test_sensors_and_robots_have_streams_of_their_own() -> None:
    alone, together = noisy(), noisy(others=SECOND)
    distances_to_second = together.robots["second"].scan().ranges
    assert np.isfinite(distances_to_second).all()
    rear = [world.robots["first"].scan("rear").ranges for world in (alone, together)]
    unhidden = rear[0] == rear[1]
    assert unhidden.mean() > 0.95  # only the beams that meet the other robot differ
    assert not np.isclose(rear[0], alone.robots["first"].scan().ranges).all()


def test_a_lidar_sees_from_where_it_is_mounted() -> None:
    text = """
    walls: [{polyline: [[5, -9], [5, 9]]}]
    robots:
      - name: r
        pose: [0, 0, 1.5707963267948966]
        sensors: [{lidar: s, beams: 4, offset: [0.1, -0.2, -1.5707963267948966]}]
    """
    scan = World(load_world("mount.yaml", text=text)).robots["r"].scan()
    assert scan.ranges[2] == pytest.approx(4.8)  # 0.2 m to the right of a robot that faces up is nearer to x = 5


def test_robots_see_each_other_and_not_themselves() -> None:
    text = """
    robots:
      - {name: a, pose: [0, 0], sensors: [{lidar: scan, beams: 4}]}
      - {name: b, pose: [2, 0], shape: {box: [0.4, 0.4]}, sensors: [{lidar: scan, beams: 4}]}
      - {name: c, pose: [0, 3], shape: {circle: 0.5}}
    """
    robots = World(load_world("three.yaml", text=text)).robots
    assert robots["a"].scan().ranges.tolist() == pytest.approx([math.inf, math.inf, 1.8, 2.5])
    assert robots["b"].scan().ranges.tolist() == pytest.approx([1.83, math.inf, math.inf, math.inf])
