"""Drive of a robot: cuts velocity and motor commands to the limits of its kind of drive."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pymunk

from robolink.exceptions import RobolinkError
from robolink.sim.description import GRAVITY, Drive, RobotDescription
from robolink.sim.driving.arithmetic import clipped
from robolink.sim.driving.motion import NEVER, Motion, motion_of_one
from robolink.sim.driving.wheels import Wheels
from robolink.sim.readings import Velocity, WheelState

GRIP = 0.8
"""Friction between wheels and floor: the drive's force is at most this share of the robot's weight."""


class CommandError(RobolinkError, ValueError):
    """A velocity command that is not a finite number."""


class Driver:
    """Driver of one robot: sets the targets of its `motion`.

    The reference point of every drive is the body's origin, base_link; of `ackermann` that is the middle of the
    rear axle. Its mass is taken to be centred there.
    """

    def __init__(self, robot: RobotDescription, body: pymunk.Body, dt: float) -> None:
        self._drive, self._timeout_steps = robot.drive, round(robot.drive.timeout / dt)
        self._wheels = Wheels(robot.wheels, robot.name, sideways=robot.drive.type == "omni")
        limits = _limits(robot.drive, body, robot.shape.outer_radius(), dt)
        self.motion: Motion[float] = motion_of_one(dt, robot.pose, limits, wheeled=bool(robot.wheels))

    def command(self, wanted: Velocity, step: int) -> None:
        """Set the target velocity from `step` on, cut to the limits; it holds for the drive's timeout.

        Raises `CommandError` when it is not finite.
        """
        if not all(map(math.isfinite, wanted)):
            v, w, sideways = wanted
            raise CommandError(f"expected a finite velocity, got v={v:g} m/s, w={w:g} rad/s, sideways={sideways:g} m/s")
        self._wheels.forget()
        self._aim(self._within_limits(wanted))
        self.motion.deadline = self.motion.expiry = step + self._timeout_steps

    def turn_wheels(self, speeds: Mapping[str, float]) -> None:
        """Turn motors at these speeds (rad/s), each until its next command or a velocity command.

        Raises `NotFoundError` for an unknown motor and `CommandError` for a speed that is not finite.
        """
        for name, speed in speeds.items():
            if not math.isfinite(speed):
                raise CommandError(f"expected a finite speed of motor '{name}', got {speed:g} rad/s")
        self._aim(self._slowed(self._wheels.turn(speeds)))
        self.motion.deadline = self.motion.expiry = NEVER

    def wheels(self, motion: Motion[float], twist: Velocity) -> tuple[WheelState, ...]:
        """Return the state of each wheel: its angle on the way of a motion, and its speed at these true speeds."""
        wheels, way = self._wheels, Velocity(motion.rolled, motion.turned, motion.slid)
        return tuple(map(WheelState, wheels.names, wheels.speeds(way), wheels.speeds(twist)))

    def _within_limits(self, wanted: Velocity) -> Velocity:
        drive, (v, w, s) = self._drive, wanted
        if drive.type == "omni":
            share = min(1.0, drive.v_max / max(math.sqrt(v * v + s * s), drive.v_max))
            return Velocity(v * share, clipped(w, drive.w_max), s * share)
        if drive.type == "ackermann":  # slower, but on the path that was asked for
            return self._slowed(Velocity(v, w))
        return Velocity(clipped(v, drive.v_max), clipped(w, drive.w_max))

    def _slowed(self, wanted: Velocity) -> Velocity:
        """Multiply all speeds by one factor, so that the way stays the same and none is too fast."""
        v_max, w_max, (v, w, s) = self._drive.v_max, self._drive.w_max, wanted
        share = min(v_max / max(math.sqrt(v * v + s * s), v_max), w_max / max(abs(w), w_max))
        return Velocity(v * share, w * share, s * share)

    def _aim(self, wanted: Velocity) -> None:
        """Set the targets; a car that stops keeps its steering angle."""
        motion, drive, (v, w, s) = self.motion, self._drive, wanted
        motion.target_v, motion.target_s, motion.target_w = v, s, w
        if drive.type == "ackermann" and v:
            motion.target_steer = clipped(math.atan(drive.wheelbase * w / v), drive.steer_max)


def _limits(drive: Drive, body: pymunk.Body, radius: float, dt: float) -> dict[str, float]:
    """Return the limits of a robot's `Motion`; infinite where only grip limits it."""
    return {
        "a_dt": drive.a_max * dt,
        "side_dt": drive.a_max * dt if drive.type == "omni" else math.inf,
        "alpha_dt": drive.alpha_max * dt,
        "steer_dt": drive.steer_rate * dt,
        "grip_dt": max(GRIP * GRAVITY, drive.a_max) * dt,
        "turn_grip_dt": max(GRIP * GRAVITY * radius * body.mass / body.moment, drive.alpha_max) * dt,
        "mass_dt": body.mass / dt,
        "inertia_dt": body.moment / dt,
        "wheelbase": drive.wheelbase,
        "car": float(drive.type == "ackermann"),
        "omni": float(drive.type == "omni"),
    }
