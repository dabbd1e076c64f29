"""The differential drive: commands with limits and a watchdog, and the force that follows them on exact arcs.

A body whose velocity is set drives through walls, because Chipmunk moves it before it solves contacts. So the
drive pushes, and only as hard as wheels grip the floor.
"""

from __future__ import annotations

import math

import pymunk

from robolink.exceptions import RobolinkError
from robolink.sim.bodies import GRAVITY
from robolink.sim.description import Drive
from robolink.sim.odometry import sinc

GRIP = 0.8
"""Friction between wheels and floor: the drive's force is at most this share of the robot's weight."""


class CommandError(RobolinkError, ValueError):
    """A velocity command that is not a finite number."""


class DiffDrive:
    """Drives one body: `v` and `w` are its true speeds (m/s, rad/s) of the step that is about to be made."""

    __slots__ = (
        "_a_max_dt",
        "_alpha_max_dt",
        "_deadline",
        "_dt",
        "_grip_dt",
        "_inertia_dt",
        "_limits",
        "_mass_dt",
        "_ramp_v",
        "_ramp_w",
        "_target",
        "_timeout_steps",
        "_turn_grip_dt",
        "v",
        "w",
    )

    def __init__(self, drive: Drive, body: pymunk.Body, radius: float, dt: float) -> None:
        self._dt = dt
        self._limits = (drive.v_max, drive.w_max)
        self._a_max_dt, self._alpha_max_dt = drive.a_max * dt, drive.alpha_max * dt
        grip = max(GRIP * GRAVITY, drive.a_max)
        self._grip_dt = grip * dt
        self._turn_grip_dt = max(grip * radius * body.mass / body.moment, drive.alpha_max) * dt
        self._mass_dt, self._inertia_dt = body.mass / dt, body.moment / dt
        self._timeout_steps = round(drive.timeout / dt)
        self._target = (0.0, 0.0)
        self._deadline = -1
        self._ramp_v = self._ramp_w = self.v = self.w = 0.0

    def command(self, v: float, w: float, step: int) -> None:
        """Ask for a velocity from `step` on, cut to the limits; it holds for the drive's timeout.

        Raises `CommandError` when it is not finite.
        """
        if not (math.isfinite(v) and math.isfinite(w)):
            raise CommandError(f"expected a finite velocity, got v={v:g} m/s, w={w:g} rad/s")
        v_max, w_max = self._limits
        self._target = (clipped(v, v_max), clipped(w, w_max))
        self._deadline = step + self._timeout_steps

    def target(self, step: int) -> tuple[float, float]:
        """Give the velocity that is asked for at `step`: nothing once the last command is too old."""
        return self._target if step < self._deadline else (0.0, 0.0)

    def push(self, body: pymunk.Body, step: int) -> None:
        """Read the body's true speeds, and apply the force and torque of one step.

        The step first moves the body by its present velocity, which is the chord of this arc; the force then
        turns that into the chord of the next one: heading theta + w dt + w' dt / 2, length v' sinc(w' dt / 2).
        """
        velocity, w, dt = body.velocity, body.angular_velocity, self._dt
        heading, half = body.angle + w * dt, w * dt / 2
        self.v, slip = along(velocity, heading - half, half)
        self.w = w
        self._ramp(step)
        half = self._ramp_w * dt / 2
        cos, sin = math.cos(heading + half), math.sin(heading + half)
        chord, slip = self._ramp_v * sinc(half), slip - clipped(slip, self._grip_dt)
        vx, vy = chord * cos - slip * sin, chord * sin + slip * cos
        body.force = (self._mass_dt * (vx - velocity[0]), self._mass_dt * (vy - velocity[1]))
        body.torque = self._inertia_dt * (self._ramp_w - w)

    def _ramp(self, step: int) -> None:
        """Move the set speeds towards the target, within the limits and never far from the true speeds."""
        target_v, target_w = self.target(step)
        ramp_v = self._ramp_v + clipped(target_v - self._ramp_v, self._a_max_dt)
        ramp_w = self._ramp_w + clipped(target_w - self._ramp_w, self._alpha_max_dt)
        self._ramp_v = self.v + clipped(ramp_v - self.v, self._grip_dt)
        self._ramp_w = self.w + clipped(ramp_w - self.w, self._turn_grip_dt)


def along(velocity: tuple[float, float], middle: float, half: float) -> tuple[float, float]:
    """Split a step's chord velocity into the speed along the arc and the slip across it, in m/s.

    `middle` is the heading halfway through the step, `half` half of the angle that the step turns by.
    """
    (vx, vy), cos, sin = velocity, math.cos(middle), math.sin(middle)
    return (vx * cos + vy * sin) / sinc(half), vy * cos - vx * sin


def clipped(value: float, limit: float) -> float:
    """Bring a value into [-limit, limit]."""
    return limit if value > limit else -limit if value < -limit else value
