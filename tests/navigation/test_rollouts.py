"""Rollouts (MPPI): limits, obstacles, repeatability, and whole drives along a path."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.critics import (
    USUAL,
    Batch,
    CostCritic,
    PreferForwardCritic,
    Surroundings,
    TwirlingCritic,
    costs_at,
    turned,
)
from robolink.navigation.footprint import INSCRIBED, LETHAL, UNKNOWN, cover, highest_costs, parse_footprint
from robolink.navigation.grid import Floats, Grid, distances
from robolink.navigation.local_path import LocalPath, ahead, lengths, nearest
from robolink.navigation.rollouts import Command, Options, Rollouts

SMALL = Options(batch_size=300)
RADIUS = 0.17


def straight(length: float = 4.0) -> Floats:
    x = np.linspace(0.0, length, 41)
    return np.column_stack((x, np.zeros(41), np.zeros(41)))


def part(path: Floats, place: float = 0.0) -> LocalPath:
    return ahead(path, lengths(path), place, 1.7, 0.05)


def costmap(*circles: tuple[float, float, float]) -> Grid:
    """A costmap of 8 x 4 m about the path, with obstacles: x, y and radius in metres."""
    costs = Grid(np.zeros((80, 160), np.uint8), 0.05, (-2.0, -2.0, 0.0))
    x, y = costs.cell_to_world(*np.mgrid[:80, :160])
    occupied = np.zeros((80, 160), bool)
    for cx, cy, radius in circles:
        occupied |= np.hypot(x - cx, y - cy) < radius
    far = distances(occupied, 20) * 0.05
    costs.cells[:] = np.where(far < 0.7, 252 * np.exp(-3.0 * (far - RADIUS)), 0).clip(0, 252)
    costs.cells[far <= RADIUS] = INSCRIBED
    costs.cells[occupied] = LETHAL
    return costs


def controller(options: Options = SMALL, seed: int = 1) -> Rollouts:
    return Rollouts(options, random=np.random.default_rng(seed))


def driven(control: Rollouts, path: Floats, costs: Grid, start: Pose, seconds: float = 20.0) -> list[Pose]:
    """Drive a robot that obeys at once along a path; return where it was, until it is within 0.2 m of the end."""
    x, y, theta = start.x, start.y, start.theta
    v = w = place = 0.0
    along, goal, places = lengths(path), Pose(*map(float, path[-1])), [start]
    while math.hypot(x - goal.x, y - goal.y) > 0.2 and len(places) < seconds / 0.05:
        place = nearest(path, along, x, y, place, 1.5)
        command = control.step(Pose(x, y, theta), (v, w), part(path, place), goal, Surroundings(costs))
        v, w = command.v, command.w
        theta += w * 0.05
        x, y = x + v * 0.05 * math.cos(theta), y + v * 0.05 * math.sin(theta)
        places.append(Pose(x, y, theta))
    return places


def step(control: Rollouts, costs: Grid, speed: tuple[float, float] = (0.0, 0.0)) -> Command:
    return control.step(Pose(0.0, 0.0, 0.0), speed, part(straight()), Pose(4.0, 0.0, 0.0), Surroundings(costs))


def test_an_empty_floor_is_crossed_at_full_speed() -> None:
    places = driven(controller(), straight(), costmap(), Pose(0.0, 0.0, 0.0))
    assert (len(places) - 1) * 0.05 < 1.3 * 4.0 / 0.5
    assert max(abs(each.y) for each in places) < 0.1


def test_a_robot_that_looks_away_turns_first() -> None:
    places = driven(controller(), straight(), costmap(), Pose(0.0, 0.0, 3.0))
    assert math.hypot(places[-1].x - 4.0, places[-1].y) < 0.2
    assert min(each.x for each in places) > -0.5


def test_an_obstacle_on_the_path_is_gone_round() -> None:
    places = driven(controller(), straight(), costmap((2.0, 0.05, 0.25)), Pose(0.0, 0.0, 0.0), 30.0)
    assert math.hypot(places[-1].x - 4.0, places[-1].y) < 0.2
    assert min(math.hypot(each.x - 2.0, each.y - 0.05) for each in places) > 0.25 + RADIUS - 0.04


def test_no_way_at_all_is_not_valid_and_stops() -> None:
    costs = costmap()
    costs.cells[:] = LETHAL
    command = step(controller(), costs, (0.3, 0.0))
    assert command[:3] == (0.0, 0.0, False)
    costs.cells[:] = 0
    assert step(controller(), costs).is_valid


def test_a_robot_that_is_too_near_to_an_obstacle_gets_away() -> None:
    costs = costmap((0.0, 0.3, 0.15))
    places = driven(controller(), straight(), costs, Pose(0.0, 0.0, 1.0))
    assert math.hypot(places[-1].x - 4.0, places[-1].y) < 0.2
    assert min(math.hypot(each.x, each.y - 0.3) for each in places) > 0.28


def test_the_same_seed_gives_the_same_commands() -> None:
    costs = costmap((1.0, 0.3, 0.3))
    runs = [
        [step(control, costs)[:2] for _ in range(5)] for control in (controller(), controller(), controller(seed=2))
    ]
    assert runs[0] == runs[1] != runs[2]


def test_noise_is_drawn_once_or_in_each_step() -> None:
    for regenerate in (False, True):
        control = controller(Options(batch_size=50, time_steps=10, regenerate_noises=regenerate))
        step(control, costmap())
        first = control._noise
        step(control, costmap())
        assert (control._noise is first) is not regenerate


@pytest.mark.parametrize("speed", [(0.0, 0.0), (0.5, 1.0), (-0.3, -1.9), (2.0, 9.0)])
def test_commands_keep_to_the_limits(speed: tuple[float, float]) -> None:
    control = controller(Options(batch_size=300, ax_max=1.0, ax_min=-2.0, az_max=2.0))
    command = step(control, costmap(), speed)
    v, w = speed
    assert v - 0.2 - 1e-6 <= command.v <= v + 0.1 + 1e-6
    assert w - 0.2 - 1e-6 <= command.w <= w + 0.2 + 1e-6


def test_a_speed_limit_holds_in_both_forms() -> None:
    assert Options().limited(0.2, percentage=False).vx_max == pytest.approx(0.2)
    assert Options().limited(50.0, percentage=True).vx_min == pytest.approx(-0.175)
    assert Options().limited(0.0, percentage=True) == Options()
    assert Options().limited(300.0, percentage=True) == Options()
    control = controller(Options(batch_size=300).limited(0.1, percentage=False))
    places = driven(control, straight(), costmap(), Pose(0.0, 0.0, 0.0), 5.0)
    assert max(a.x - b.x for a, b in zip(places[1:], places, strict=False)) < 0.1 * 0.05 + 1e-6


def test_a_robot_that_steers_is_not_turned_on_the_spot() -> None:
    control = controller(Options(batch_size=300, min_turning_r=0.5))
    drawn_v, drawn_w = control._drawn((0.0, 0.0))
    assert (np.abs(drawn_w) <= np.abs(drawn_v) / 0.5 + 1e-6).all()


def test_a_long_footprint_does_not_turn_into_a_wall() -> None:
    critics = tuple(replace(each, consider_footprint=True) if isinstance(each, CostCritic) else each for each in USUAL)
    outline = cover(parse_footprint("[[0.5, 0.1], [0.5, -0.1], [-0.5, -0.1], [-0.5, 0.1]]"), 0.05)
    costs = costmap((0.0, 0.4, 0.15))
    control = Rollouts(SMALL, critics, random=np.random.default_rng(1))
    pose, goal = Pose(0.0, 0.0, 0.0), Pose(0.0, 2.0, math.pi / 2)
    up = np.column_stack((np.zeros(41), np.linspace(0, 2, 41), np.full(41, math.pi / 2)))
    v, w = 0.0, 0.0
    for _ in range(20):
        command = control.step(pose, (v, w), part(up), goal, Surroundings(costs, outline, 1.0))
        v, w = command.v, command.w
        pose = Pose(pose.x + v * 0.05 * math.cos(pose.theta), pose.y + v * 0.05 * math.sin(pose.theta), pose.theta)
        pose = pose._replace(theta=pose.theta + w * 0.05)
        assert highest_costs(costs, outline, np.array([pose]))[0] < LETHAL
    assert pose.theta > 0.1


def test_turning_and_backing_up_cost() -> None:
    v = np.array([[0.5, -0.5]] * 10, np.float32)
    still, clear = np.zeros_like(v), np.ones(35, bool)
    goal, start = Pose(4.0, 0.0, 0.0), Pose(0.0, 0.0, 0.0)
    batch = Batch(still, still, still, v, 2 * v, 0.1, start, part(straight()), clear, 0, goal, Surroundings(costmap()))
    for critic, expected in ((PreferForwardCritic(), [0.0, 2.5]), (TwirlingCritic(), [10.0, 10.0])):
        judgement = critic.judge(batch)
        assert judgement is not None
        assert judgement.costs.tolist() == pytest.approx(expected)


def test_costs_off_the_costmap_are_unknown() -> None:
    costs = Grid(np.full((4, 4), 9, np.uint8), 0.5, (1.0, 1.0, 0.0))
    x, y = (np.array(each, np.float32) for each in ([1.1, 2.9, 3.1, 0.9, 1e9, -1e9], [1.1, 2.9, 1.1, 1.1, 0.0, 1.5]))
    assert costs_at(costs, x, y).tolist() == [9, 9, UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN]


def test_turns_are_the_shorter_ones() -> None:
    angles = np.array([0.1, math.pi, -3.1, 10.0], np.float32)
    assert turned(angles, 0.0).tolist() == pytest.approx([0.1, math.pi, 3.1, 4 * math.pi - 10.0], abs=1e-5)
