"""Obstacles that move are found in scans, and nothing else is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.grid import Floats
from robolink.navigation.movers import Movers

ANGLES: Floats = np.linspace(-math.pi, math.pi, 360, endpoint=False)


def scan(sensor: Pose, *circles: tuple[float, float, float], wall: float = math.inf) -> Floats:
    """Ranges to circles, x, y and radius, and to a wall at `wall` on x."""
    ranges = np.full(360, math.inf)
    cos, sin = np.cos(ANGLES + sensor.theta), np.sin(ANGLES + sensor.theta)
    with np.errstate(divide="ignore"):
        ranges = np.where(cos > 1e-9, (wall - sensor.x) / cos, math.inf)
    for x, y, radius in circles:
        along = (x - sensor.x) * cos + (y - sensor.y) * sin
        off = (x - sensor.x) ** 2 + (y - sensor.y) ** 2 - along**2
        hit = (along > 0) & (off < radius**2)
        ranges = np.where(hit, np.minimum(ranges, along - np.sqrt(np.maximum(radius**2 - off, 0.0))), ranges)
    return ranges


def test_a_person_who_walks_is_followed() -> None:
    movers = Movers()
    for index in range(15):
        time = 0.1 * index
        sensor = Pose(0.3 * time, 0.0, 0.5 * time)
        movers.look(scan(sensor, (2.0, -1.0 + 0.6 * time, 0.2), wall=4.0), ANGLES, sensor, time)
    (mover,) = movers.now(1.4)
    assert (mover.x, mover.y) == pytest.approx((2.0, -0.16), abs=0.1)
    assert (mover.vx, mover.vy) == pytest.approx((0.0, 0.6), abs=0.12)
    assert mover.radius == pytest.approx(0.2, abs=0.05)
    assert movers.now(1.7)[0].y == pytest.approx(mover.y + 0.3 * mover.vy)
    assert movers.now(2.5) == []


def test_a_robot_that_drives_sees_nothing_else_move() -> None:
    movers = Movers()
    things = ((1.5, 0.6, 0.2), (2.5, -0.4, 0.3), (3.0, 0.4, 0.15))
    for index in range(40):
        time = 0.1 * index
        sensor = Pose(0.5 * time, 0.0, 0.3 * math.sin(time))
        movers.look(scan(sensor, *things, wall=3.5), ANGLES, sensor, time)
        assert movers.now(time) == []


def test_a_time_that_goes_back_forgets_all() -> None:
    movers = Movers()
    for index in range(15):
        movers.look(scan(Pose(), (2.0, -1.0 + 0.06 * index, 0.2)), ANGLES, Pose(), 0.1 * index)
    movers.look(scan(Pose(), (2.0, 0.0, 0.2)), ANGLES, Pose(), 0.0)
    assert movers.now(0.0) == []


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0.0, -1.0])
def test_scans_without_a_return_show_nothing(value: float) -> None:
    movers = Movers()
    for index in range(10):
        movers.look(np.full(360, value), ANGLES, Pose(), 0.1 * index)
    assert movers.now(0.9) == []
