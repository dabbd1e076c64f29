"""Covariances of a robot's odometry, propagated from the noise that its world file states.

Noise is a share of the speeds, drawn at each step, so that errors grow with the root of the way.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from robolink.sim import Pose, Velocity
from robolink.sim.description import OdomNoise

Covariance: TypeAlias = npt.NDArray[np.float64]
"""The 36 numbers of a 6 x 6 matrix, row by row: x, y, z, and the turns about them."""

_IN_PLANE = np.ix_((0, 1, 5), (0, 1, 5))
"""Rows and columns of x, y and the heading in such a matrix."""


class Uncertainty:
    """The covariance of a robot's odometry since its start; `dt` is the length of a step in seconds."""

    def __init__(self, noise: OdomNoise, dt: float) -> None:
        self._noise, self._dt = noise, dt
        self._matrix = np.zeros((3, 3))

    def advance(self, pose: Pose, twist: Velocity, steps: int) -> None:
        """Add the uncertainty of a number of steps at about these speeds, which led to `pose`."""
        dt, noise = self._dt, self._noise
        sin, cos = math.sin(pose.theta), math.cos(pose.theta)
        ahead, across = twist.v * dt, twist.sideways * dt
        to_world = np.array(((cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)))
        errors = np.diag(((noise.v * ahead) ** 2, (noise.v * across) ** 2, (noise.w * twist.w * dt) ** 2))
        turned = np.eye(3)  # a wrong heading leads the whole way astray
        turned[:2, 2] = to_world[:2, :2] @ (-across * steps, ahead * steps)
        self._matrix = turned @ self._matrix @ turned.T + steps * to_world @ errors @ to_world.T

    def of_pose(self) -> Covariance:
        """Return the covariance of the pose, in the frame of the odometry."""
        whole = np.zeros((6, 6))
        whole[_IN_PLANE] = self._matrix
        return whole.ravel()

    def of_twist(self, twist: Velocity) -> Covariance:
        """Return the covariance of these speeds, in the robot's own frame."""
        noise = self._noise
        return np.diag(
            ((noise.v * twist.v) ** 2, (noise.v * twist.sideways) ** 2, 0.0, 0.0, 0.0, (noise.w * twist.w) ** 2)
        ).ravel()
