"""Regulated pure pursuit: arcs to the path, its speeds, and stops before obstacles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.critics import Surroundings
from robolink.navigation.footprint import INSCRIBED, LETHAL, cover, parse_footprint
from robolink.navigation.grid import Floats, Grid
from robolink.navigation.local_path import LocalPath, ahead, lengths, nearest
from robolink.navigation.movers import Mover
from robolink.navigation.pursuit import BACK, Options, Pursuit

X = np.linspace(0.0, 4.0, 81)
STRAIGHT = np.column_stack((X, np.zeros(81), np.zeros(81)))
BENT = np.column_stack((2 * np.sin(X / 2), 2 - 2 * np.cos(X / 2), X / 2))


def around() -> Surroundings:
    return Surroundings(Grid(np.zeros((120, 120), np.uint8), 0.05, (-3.0, -3.0, 0.0)))


def part(path: Floats, place: float = 0.0) -> LocalPath:
    return ahead(path, lengths(path), place, 1.5, 0.05)


def pursuit(**options: float | bool) -> Pursuit:
    return Pursuit(Options(**options), inscribed=0.17)  # type: ignore[arg-type]


def driven(control: Pursuit, path: Floats, start: Pose) -> tuple[list[Pose], list[float]]:
    x, y, theta = start
    v = w = place = 0.0
    places, speeds, along = [start], [0.0], lengths(path)
    for _ in range(600):
        place = nearest(path, along, x, y, place, 1.5)
        v, w, is_valid, _ = control.step(Pose(x, y, theta), (v, w), part(path, place), around(), 0.1)
        assert is_valid
        theta += w * 0.05
        x, y = x + v * 0.05 * math.cos(theta), y + v * 0.05 * math.sin(theta)
        places.append(Pose(x, y, theta))
        speeds.append(v)
    return places, speeds


@pytest.mark.parametrize("path", [STRAIGHT, BENT])
def test_a_path_is_followed_to_its_end_and_heading(path: Floats) -> None:
    places, speeds = driven(pursuit(), path, Pose(0.0, 0.0, 0.3))
    assert math.hypot(places[-1].x - path[-1, 0], places[-1].y - path[-1, 1]) < 0.12
    assert math.remainder(places[-1].theta - path[-1, 2], 2 * math.pi) == pytest.approx(0.0, abs=0.05)
    assert max(speeds) == pytest.approx(0.5)
    assert speeds[-1] == 0.0
    for each in places:
        assert np.hypot(path[:, 0] - each.x, path[:, 1] - each.y).min() < 0.15


def test_a_robot_that_looks_away_turns_on_the_spot() -> None:
    command = pursuit().step(Pose(0.0, 0.0, 2.0), (0.0, 0.0), part(STRAIGHT), around(), 0.1)
    assert (command.v, command.w) == pytest.approx((0.0, -3.2 * 0.05))
    command = pursuit().step(Pose(0.0, 0.0, 2.0), (0.0, -1.8), part(STRAIGHT), around(), 0.1)
    assert command.w == pytest.approx(-1.8)


def test_the_arc_leads_through_the_point_that_is_pursued() -> None:
    command = pursuit(use_rotate_to_heading=False).step(Pose(0.0, 0.2, 0.0), (0.5, 0.0), part(STRAIGHT), around(), 0.1)
    x, y = math.sqrt(0.6**2 - 0.2**2), -0.2
    assert command.w / command.v == pytest.approx(2 * y / 0.6**2)
    radius = command.v / command.w
    assert math.hypot(x, y - radius) == pytest.approx(abs(radius))


def test_bends_costs_and_the_goal_slow_it_down() -> None:
    place, speed = Pose(0.0, 0.0, 0.0), (0.5, 0.0)
    assert pursuit().step(place, speed, part(STRAIGHT), around(), 0.1).v == 0.5
    circle = np.column_stack((0.5 * np.sin(X), 0.5 - 0.5 * np.cos(X), X))
    assert pursuit().step(place, speed, part(circle), around(), 0.1).v < 0.35
    near = around()
    near.costs.cells[:] = 200
    assert pursuit().step(place, speed, part(STRAIGHT), near, 0.1).v == pytest.approx(
        0.5 * (0.17 - math.log(200 / 253) / 3) / 0.6, abs=0.05
    )
    slow = pursuit().step(Pose(3.7, 0.0, 0.0), speed, part(STRAIGHT, 3.7), around(), 0.1)
    assert slow.v == pytest.approx(0.25)
    faster = pursuit(use_velocity_scaled_lookahead_dist=True)
    assert faster._carrot(place, (0.5, 0.0), part(STRAIGHT))[0] == pytest.approx(0.75)
    assert faster._carrot(place, (0.0, 0.0), part(STRAIGHT))[0] == pytest.approx(0.3)


def test_an_obstacle_ahead_is_not_valid() -> None:
    blocked = around()
    blocked.costs.cells[:, 66:70] = INSCRIBED
    assert pursuit().step(Pose(0.0, 0.0, 0.0), (0.5, 0.0), part(STRAIGHT), blocked, 0.1)[:3] == (0.0, 0.0, False)
    assert pursuit(use_collision_detection=False).step(Pose(), (0.5, 0.0), part(STRAIGHT), blocked, 0.1).is_valid


def test_a_corner_of_the_footprint_counts() -> None:
    costs = Grid(np.full((120, 120), 10, np.uint8), 0.05, (-3.0, -3.0, 0.0))
    costs.cells[66, 66] = LETHAL  # 0.3 m ahead and to the left
    outline = cover(parse_footprint("[[0.1, 0.32], [0.1, -0.32], [-0.1, -0.32], [-0.1, 0.32]]"), 0.03)
    for possible, is_valid in ((5.0, False), (50.0, True)):
        found = pursuit().step(Pose(), (0.5, 0.0), part(STRAIGHT), Surroundings(costs, outline, possible), 0.1)
        assert found.is_valid is is_valid


def test_speed_limits() -> None:
    assert Options().limited(0.2, percentage=False).desired_linear_vel == 0.2
    assert Options().limited(50.0, percentage=True).desired_linear_vel == 0.25
    assert Options().limited(2.0, percentage=False).desired_linear_vel == 0.5
    assert Options().limited(0.0, percentage=False) == Options()


def met(mover: Mover, control: Pursuit | None = None, seconds: float = 8.0) -> tuple[float, float, float]:
    """Drive along the straight path past a mover: the least distance left to it, how far it comes, the lowest speed."""
    control = control or pursuit()
    x = y = theta = v = w = place = 0.0
    least, slowest, along = math.inf, 0.0, lengths(STRAIGHT)
    for step in range(round(seconds / 0.05)):
        now = mover.later(step * 0.05)
        place = nearest(STRAIGHT, along, x, y, place, 1.5)
        surroundings = around()._replace(movers=[now])
        v, w, _, _ = control.step(Pose(x, y, theta), (v, w), part(STRAIGHT, place), surroundings, 0.1)
        theta += w * 0.05
        x, y = x + v * 0.05 * math.cos(theta), y + v * 0.05 * math.sin(theta)
        least, slowest = min(least, math.hypot(x - now.x, y - now.y) - now.radius), min(slowest, v)
    return least, x, slowest


@pytest.mark.parametrize(
    "mover",
    [
        Mover(1.5, -1.2, 0.0, 0.4, 0.37),  # crosses from the right
        Mover(1.2, 0.9, 0.0, -0.3, 0.37),  # crosses from the left
        Mover(1.4, 0.9, -0.2, -0.35, 0.37),  # comes nearer while it crosses
    ],
)
def test_it_lets_what_crosses_its_way_pass_and_goes_on(mover: Mover) -> None:
    least, way, _ = met(mover)
    assert least > 0.0
    assert way > 1.5
    assert met(mover, pursuit(predict_movers=False))[0] < 0.0


def test_it_backs_away_from_what_comes_towards_it() -> None:
    least, _, slowest = met(Mover(1.5, 0.0, -0.2, 0.0, 0.37), seconds=6.0)
    assert (slowest, least > 0.0) == (-BACK, True)


def test_a_robot_that_is_driven_off_at_the_goal_comes_back() -> None:
    control, path = pursuit(), part(STRAIGHT, 3.6)

    def speed(x: float) -> float:
        return control.step(Pose(x, 0.0, 0.5), (0.0, 0.0), path, around(), 0.25).v

    assert speed(3.85) == 0.0  # it only turns
    assert speed(3.77) == 0.0
    assert speed(3.7) > 0.0
