"""Worlds of obstacles, made from a seed, and navigation through them from start to goal."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from robolink.sim.maps.gridmap import load_map
from robolink.sim.world import World
from robolink.sim.worldfile import load_world
from tests.support.navigation_lives import lived
from tests.support.navigation_worlds import (
    GOAL,
    KINDS,
    NARROWEST,
    RADIUS,
    RIM,
    START,
    Box,
    Layout,
    navigation_world,
    shortest_way,
)


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(KINDS)))
def test_a_world_of_each_kind_can_be_simulated_and_crossed(number: int, tmp_path: Path) -> None:
    made = navigation_world(number)
    world, chart = made.write(tmp_path)
    simulated = World(load_world(world))
    pose = simulated.robots["robot"].pose
    assert (pose.x, pose.y, pose.theta) == pytest.approx(tuple(made.start), abs=1e-3)
    assert len(made.layout.people) == {"people": 3, "mixed": 1}.get(KINDS[number], 0)
    assert (made.way[0], made.way[-1]) == (START, GOAL)
    for (x1, y1), (x2, y2) in pairwise(made.way):
        share = np.linspace(0, 1, 20)
        assert made.layout.clearance(x1 + share * (x2 - x1), y1 + share * (y2 - y1)).min() > RADIUS - 0.01
    assert math.dist(START, GOAL) <= made.length < 25.0
    grid = load_map(chart)
    assert (grid.cells == made.cells()).all()
    assert not grid.is_occupied(*made.start[:2])
    assert grid.is_occupied(5.0, 0.01)


def test_the_same_number_makes_the_same_world() -> None:
    text = navigation_world(4).text()
    navigation_world.cache_clear()
    assert navigation_world(4).text() == text
    assert navigation_world(10).text() != text


def test_the_shortest_way_leads_round_a_corner() -> None:
    wall = [(5.0, 0.0), (5.0, 8.0)]
    way = shortest_way(Layout([RIM, wall], [], []), (3.0, 6.0), (7.0, 6.0))
    assert way is not None
    length = sum(math.dist(*pair) for pair in pairwise(way))
    # Straight to the circle around the wall's end, along it, and straight on.
    far = math.dist((3.0, 6.0), (5.0, 8.0))
    around = math.radians(270) - 2 * math.acos(RADIUS / far)
    assert length == pytest.approx(2 * math.sqrt(far**2 - RADIUS**2) + RADIUS * around, abs=0.06)


def test_a_gap_is_passed_if_the_robot_fits_and_not_if_it_does_not() -> None:
    for width, fits in ((NARROWEST * 2 * RADIUS, True), (1.95 * RADIUS, False)):
        walls = [RIM, [(5.0, 0.0), (5.0, 5.0 - width / 2)], [(5.0, 5.0 + width / 2), (5.0, 10.0)]]
        assert (shortest_way(Layout(walls, [], []), START, GOAL) is not None) == fits


def test_clearance_is_the_distance_from_a_box() -> None:
    layout = Layout([], [Box(0.0, 0.0, math.pi / 2, 2.0, 1.0, is_mapped=False)], [])
    assert layout.clearance([0, 1.5, 3.5], [3, 0, 5]) == pytest.approx([2.0, 1.0, 5.0])
    assert layout.clearance(0.0, 0.0) == pytest.approx(-0.5)
    assert layout.clearance(0.0, 0.0, mapped_only=True) == math.inf


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 10, 17])
def test_a_robot_reaches_its_goal_without_contact(number: int, tmp_path: Path) -> None:
    life = lived(navigation_world(number), tmp_path)
    assert life.is_good, life


@pytest.mark.slow
def test_a_robot_reaches_its_goal_with_the_map_that_it_made(tmp_path: Path) -> None:
    life = lived(navigation_world(2), tmp_path, has_own_map=True)
    assert life.is_good, life
