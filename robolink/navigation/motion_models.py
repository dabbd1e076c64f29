"""Motion models: where a robot may be after its odometry has measured a way, with the errors that odometry has.

The models and their parameters `alpha1` to `alpha5` are AMCL's: `sample_motion_model_odometry` (Thrun, Burgard, Fox:
Probabilistic Robotics, table 5.6), with backward driving as good as forward, and its extension to robots that can drive
sideways.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from robolink.geometry.plane import Pose, seen_from, wrapped
from robolink.geometry.trigonometry import cos_and_sin
from robolink.navigation.grid import Floats

SHORT = 0.01
"""Way in metres below which its direction is not known: the robot has turned on the spot."""


class Alphas(NamedTuple):
    """Errors of odometry, as variances per unit squared.

    1: of turning, by turning; 2: of turning, by driving; 3: of driving, by driving; 4: of driving, by turning; 5: of
    driving sideways, by driving (omnidirectional robots only).
    """

    alpha1: float = 0.2
    alpha2: float = 0.2
    alpha3: float = 0.2
    alpha4: float = 0.2
    alpha5: float = 0.2


MotionModel: TypeAlias = "Callable[[Floats, Pose, Pose, Alphas, np.random.Generator], None]"
"""Function that moves poses (rows x, y, heading) as a robot may have moved from one pose of its odometry to another."""


def move_differential(poses: Floats, before: Pose, after: Pose, alphas: Alphas, random: np.random.Generator) -> None:
    """Move poses as a robot does that turns, drives ahead or back, and turns again; see `MotionModel`."""
    way = seen_from(before, after)
    driven = math.hypot(way.x, way.y)
    first = math.atan2(way.y, way.x) if driven >= SHORT else 0.0
    second = wrapped(way.theta - first)
    turn1, turn2 = _least_turn(first), _least_turn(second)
    a1, a2, a3, a4, _ = alphas
    error = random.standard_normal((3, poses.shape[1]))
    turned = first + error[0] * math.sqrt(a1 * turn1 * turn1 + a2 * driven * driven)
    length = driven + error[1] * math.sqrt(a3 * driven * driven + a4 * (turn1 * turn1 + turn2 * turn2))
    cos, sin = cos_and_sin(poses[2] + turned)
    poses[0] += length * cos
    poses[1] += length * sin
    poses[2] += turned + (second + error[2] * math.sqrt(a1 * turn2 * turn2 + a2 * driven * driven))
    wrap_headings(poses)


def move_omni(poses: Floats, before: Pose, after: Pose, alphas: Alphas, random: np.random.Generator) -> None:
    """Move poses as a robot does that drives in any direction while it turns; see `MotionModel`."""
    way = seen_from(before, after)
    driven, turn = math.hypot(way.x, way.y), abs(way.theta)
    a1, a2, a3, a4, a5 = alphas
    error = random.standard_normal((3, poses.shape[1]))
    length = driven + error[0] * math.sqrt(a3 * driven * driven + a4 * turn * turn)
    aside = error[1] * math.sqrt(a4 * turn * turn + a5 * driven * driven)
    cos, sin = cos_and_sin(poses[2] + math.atan2(way.y, way.x))
    poses[0] += length * cos + aside * sin
    poses[1] += length * sin - aside * cos
    poses[2] += way.theta + error[2] * math.sqrt(a1 * turn * turn + a2 * driven * driven)
    wrap_headings(poses)


def roughen(poses: Floats, far: float, turned: float, random: np.random.Generator) -> None:
    """Scatter poses by standard deviations in metres and radians, in place of a motion.

    Without it resampling makes the particles of a robot at rest one and the same (Gordon, Salmond, Smith 1993).
    """
    error = random.standard_normal((3, poses.shape[1]))
    poses[0] += error[0] * far
    poses[1] += error[1] * far
    poses[2] += error[2] * turned
    wrap_headings(poses)


def _least_turn(angle: float) -> float:
    """Return how far a turn is from none, or from one to drive backwards."""
    return min(abs(angle), math.pi - abs(angle))


def wrap_headings(poses: Floats) -> None:
    """Bring the headings of poses into [-pi, pi]."""
    poses[2] -= np.rint(poses[2] / math.tau) * math.tau
