"""Detours: a way round what a scanner has seen, without a map."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.detours import REACH, Detours


def seen(robot: Pose, *walls: tuple[float, float, float, float]) -> Detours:
    made = Detours(0.25)
    points = np.concatenate([np.linspace((x1, y1), (x2, y2), 200) for x1, y1, x2, y2 in walls])
    dx, dy, cos, sin = points[:, 0] - robot.x, points[:, 1] - robot.y, math.cos(robot.theta), math.sin(robot.theta)
    made.see(robot, cos * dx + sin * dy, cos * dy - sin * dx)
    return made


def test_the_goal_is_the_aim_where_nothing_is_between() -> None:
    robot, goal = Pose(5.0, 5.0, 1.0), Pose(30.0, 5.0, 0.0)
    assert seen(robot, (6.0, 7.0, 6.0, 9.0)).aim(robot, goal) == goal


def test_the_aim_leads_round_a_wall() -> None:
    robot, goal = Pose(5.0, 5.0, 0.3), Pose(9.0, 5.0, 0.0)
    aim = seen(robot, (6.5, 3.0, 6.5, 5.5)).aim(robot, goal)
    assert aim is not None
    assert math.dist(aim[:2], robot[:2]) <= REACH
    assert aim.y > 5.1


def test_a_robot_that_is_shut_in_has_no_aim() -> None:
    robot = Pose(0.0, 0.0, 0.0)
    cell = ((-1, -1, 1, -1), (1, -1, 1, 1), (1, 1, -1, 1), (-1, 1, -1, -1))
    assert seen(robot, *cell).aim(robot, Pose(3.0, 0.0, 0.0)) is None


@pytest.mark.parametrize("x", [0.4, 3.0, 1e6])
def test_any_goal_has_an_aim_in_the_open(x: float) -> None:
    robot, goal = Pose(0.0, 0.0, 0.0), Pose(x, 0.0, 0.0)
    assert Detours(0.25).aim(robot, goal) in (goal, None)
    assert seen(robot, (-3.0, 3.0, -2.0, 3.0)).aim(robot, goal) == goal
