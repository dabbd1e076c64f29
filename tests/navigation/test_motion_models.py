"""Motion models: where particles are after odometry has measured a way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robolink.geometry.plane import Pose
from robolink.navigation.motion_models import Alphas, MotionModel, move_differential, move_omni

ORIGIN = Pose()
EXACT = Alphas(0, 0, 0, 0, 0)
MODELS = [move_differential, move_omni]


def moved(
    model: MotionModel, before: Pose, after: Pose, alphas: Alphas, start: Pose = ORIGIN, count: int = 1
) -> np.ndarray:
    poses = np.repeat(np.array(start, np.float64)[:, None], count, axis=1)
    model(poses, before, after, alphas, np.random.default_rng(1))
    return poses


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    "after", [Pose(1, 0, 0), Pose(-1, 0, 0), Pose(1, 2, 3), Pose(0.001, 0, 1), Pose(0, 0.5, -3), Pose()]
)
def test_without_errors_a_particle_moves_as_odometry_does(model: MotionModel, after: Pose) -> None:
    x, y, theta = moved(model, Pose(), after, EXACT)[:, 0]
    assert (x, y) == pytest.approx(after[:2], abs=2e-3)
    assert math.remainder(theta - after.theta, math.tau) == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_a_way_is_turned_to_the_heading_of_the_particle(model: MotionModel) -> None:
    x, y, theta = moved(
        model, Pose(5, 5, 1), Pose(5 + math.cos(1), 5 + math.sin(1), 1), EXACT, Pose(2, 3, math.pi / 2)
    )[:, 0]
    assert (x, y, theta) == pytest.approx((2, 4, math.pi / 2))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_errors_grow_as_the_parameters_say(way: float) -> None:
    x, _, theta = moved(move_differential, Pose(), Pose(way, 0, 0), Alphas(0.1, 0.02, 0.04, 0.1), count=20_000)
    assert x.std() == pytest.approx(0.2, rel=0.05)
    assert theta.std() == pytest.approx(math.sqrt(2 * 0.02), rel=0.05)


def test_errors_of_turning_on_the_spot() -> None:
    x, _, theta = moved(move_differential, Pose(), Pose(0, 0, 1), Alphas(0.04, 0, 0, 0.09), count=20_000)
    assert theta.std() == pytest.approx(0.2, rel=0.05)
    assert x.std() == pytest.approx(0.3, rel=0.05)


def test_an_omnidirectional_robot_errs_sideways_too() -> None:
    x, y, _ = moved(move_omni, Pose(), Pose(0, 1, 0), Alphas(0, 0, 0, 0, 0.01), count=20_000)
    assert (x.std(), y.std()) == (pytest.approx(0.1, rel=0.05), pytest.approx(0, abs=1e-9))


@pytest.mark.parametrize("model", MODELS)
def test_headings_stay_within_a_turn(model: MotionModel) -> None:
    theta = moved(model, Pose(), Pose(0, 0, 3), Alphas(), Pose(0, 0, 3), 1000)[2]
    assert np.abs(theta).max() <= math.pi
