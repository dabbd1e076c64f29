"""Drive of a robot: its speeds within limits, and its wheels."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pymunk

from robolink.exceptions import NotFoundError, RobolinkError
from robolink.sim.description import GRAVITY, Drive, RobotDescription, Wheel
from robolink.sim.driving.arithmetic import clipped
from robolink.sim.driving.motion import NEVER, RAMPS, Motion, motion_of_one
from robolink.sim.readings import Velocity, WheelState

# Wheel kinematics: a robot's speeds from those of its wheels, and the other way round.
#
# A wheel at (x, y) that rolls towards theta goes over the floor at (v - w y) cos theta + (s + w x) sin theta, which
# is its own speed times its radius. A robot whose wheels contradict each other goes the way of the least squares.


_DIGITS = 15
"""Decimals kept of the pseudo-inverse: later ones differ between versions of the linear algebra below numpy."""


class Wheels:
    """The wheels of one robot; only with `sideways` can they make it go to the left."""

    def __init__(self, wheels: Sequence[Wheel], robot: str, *, sideways: bool) -> None:
        self.names = [wheel.motor for wheel in wheels]
        self._robot, self._limits = robot, [wheel.speed_max for wheel in wheels]
        self._rows = [_row(wheel) for wheel in wheels]
        self._inverse = _pseudo_inverse(self._rows, sideways)
        self._speeds = dict.fromkeys(self.names, 0.0)

    def turn(self, speeds: Mapping[str, float]) -> Velocity:
        """Set the speeds of motors, in rad/s; return the robot's speeds that all of them together ask for.

        Raises `NotFoundError` when there is no such motor, and changes none then.
        """
        for name in speeds:
            if name not in self._speeds:
                raise NotFoundError("motor", name, self.names, f"robot '{self._robot}'")
        self._speeds.update(speeds)
        cut = [max(-most, min(most, self._speeds[name])) for name, most in zip(self.names, self._limits, strict=True)]
        v, s, w = (math.fsum(share * speed for share, speed in zip(row, cut, strict=True)) for row in self._inverse)
        return Velocity(v, w, s)

    def forget(self) -> None:
        """Set all motors to 0: a velocity command has come."""
        self._speeds = dict.fromkeys(self.names, 0.0)

    def speeds(self, robot: Velocity) -> list[float]:
        """Return the speed of each wheel in rad/s from a robot's speeds; or its angle in rad from its way."""
        v, w, s = robot
        return [row[0] * v + row[1] * s + row[2] * w for row in self._rows]


def _row(wheel: Wheel) -> tuple[float, float, float]:
    """Return the speed of a wheel for each of v, s and w."""
    at, cos, sin = wheel.at, math.cos(wheel.at.theta), math.sin(wheel.at.theta)
    return cos / wheel.radius, sin / wheel.radius, (at.x * sin - at.y * cos) / wheel.radius


def _pseudo_inverse(rows: Sequence[tuple[float, float, float]], sideways: bool) -> list[list[float]]:
    forward = np.array(rows, dtype=np.float64).reshape(-1, 3)
    if not sideways:
        forward[:, 1] = 0.0
    inverse: list[list[float]] = np.round(np.linalg.pinv(forward, rcond=1e-9), _DIGITS).tolist()
    return inverse


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
        self.held = False
        """True while it brakes and obeys no command."""
        self._ramps = {name: limits[name] for name in RAMPS}

    def hold(self) -> None:
        """Brake as hard as the wheels grip, and obey no command until `release`."""
        self.held = True
        self._wheels.forget()
        self._aim(Velocity(0.0, 0.0, 0.0))
        self.motion.deadline = self.motion.expiry = NEVER
        for name in RAMPS:
            setattr(self.motion, name, math.inf)

    def release(self) -> None:
        """Obey commands again, within the drive's limits; until the next one it stands."""
        self.held = False
        for name, limit in self._ramps.items():
            setattr(self.motion, name, limit)

    def command(self, velocity: Velocity, step: int) -> None:
        """Set the target velocity from `step` on, cut to the limits; it holds for the drive's timeout.

        While the robot is held, it changes nothing. Raises `CommandError` when it is not finite.
        """
        if not all(map(math.isfinite, velocity)):
            v, w, sideways = velocity
            raise CommandError(f"expected a finite velocity, got v={v:g} m/s, w={w:g} rad/s, sideways={sideways:g} m/s")
        if self.held:
            return
        self._wheels.forget()
        self._aim(self._within_limits(velocity))
        self.motion.deadline = self.motion.expiry = step + self._timeout_steps

    def turn_wheels(self, speeds: Mapping[str, float]) -> None:
        """Turn motors at these speeds (rad/s), each until its next command or a velocity command.

        While the robot is held, it changes nothing. Raises `NotFoundError` for an unknown motor and `CommandError` for
        a speed that is not finite.
        """
        for name, speed in speeds.items():
            if not math.isfinite(speed):
                raise CommandError(f"expected a finite speed of motor '{name}', got {speed:g} rad/s")
        velocity = self._wheels.turn(speeds)
        if self.held:
            self._wheels.forget()
            return
        self._aim(self._slowed(velocity))
        self.motion.deadline = self.motion.expiry = NEVER

    def wheels(self, motion: Motion[float], twist: Velocity) -> tuple[WheelState, ...]:
        """Return the state of each wheel: its angle on the way of a motion, and its speed at these true speeds."""
        wheels, way = self._wheels, Velocity(motion.rolled, motion.turned, motion.slid)
        return tuple(map(WheelState, wheels.names, wheels.speeds(way), wheels.speeds(twist)))

    def _within_limits(self, velocity: Velocity) -> Velocity:
        drive, (v, w, s) = self._drive, velocity
        if drive.type == "omni":
            share = min(1.0, drive.v_max / max(math.sqrt(v * v + s * s), drive.v_max))
            return Velocity(v * share, clipped(w, drive.w_max), s * share)
        if drive.type == "ackermann":  # slower, but on the path that was asked for
            return self._slowed(Velocity(v, w))
        return Velocity(clipped(v, drive.v_max), clipped(w, drive.w_max))

    def _slowed(self, velocity: Velocity) -> Velocity:
        """Multiply all speeds by one factor, so that the way stays the same and none is too fast."""
        v_max, w_max, (v, w, s) = self._drive.v_max, self._drive.w_max, velocity
        share = min(v_max / max(math.sqrt(v * v + s * s), v_max), w_max / max(abs(w), w_max))
        return Velocity(v * share, w * share, s * share)

    def _aim(self, velocity: Velocity) -> None:
        """Set the targets; a car that stops keeps its steering angle."""
        motion, drive, (v, w, s) = self.motion, self._drive, velocity
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
