"""Motion of robots: the force of a step that leads onto the next exact arc, and odometry along those arcs.

A body whose velocity is set drives through walls, because Chipmunk moves it before it solves contacts. So robots
are pushed, and only as hard as wheels grip the floor.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Generic

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.driving.arithmetic import ARRAYS, FLOATS, Arithmetic, Number
from robolink.sim.quantities import Pose

NEVER = 1e18
"""The deadline, in steps, of a command that holds until the next one."""

RAMPS = ("a_dt", "side_dt", "alpha_dt")
"""Names of the most that a step may change the set speeds by, in m/s and rad/s; infinite where only grip is a limit."""

_LIMITS = (
    *RAMPS,
    "steer_dt",
    "grip_dt",  # the most that a step can change the true speeds by, for the wheels' grip
    "turn_grip_dt",
    "mass_dt",  # mass and moment of inertia over dt: the force that changes a speed by 1 in a step
    "inertia_dt",
    "wheelbase",
    "car",  # 1 for one that steers, else 0
    "omni",  # 1 for one that goes sideways, else 0
)
_TARGETS = ("target_v", "target_s", "target_w", "target_steer", "deadline")
_STATE = (
    "ramp_v",  # the set speeds
    "ramp_s",
    "ramp_w",
    "steer",  # the angle of a car's front wheels
    "vx",  # the true velocity in the world
    "vy",
    "chord",  # of the arc of a step, as a share of the arc
    "v",  # the true speeds
    "s",
    "w",
    "x",  # odometry
    "y",
    "theta",
    "rolled",  # the true ways: metres ahead, metres to the left, radians
    "slid",
    "turned",
    "driven",  # the true way, ahead and back alike; a step that only an omni makes to the side counts too
)


class Motion(Generic[Number]):
    """Motion of one robot (numbers are floats) or many (arrays, an element for each robot): limits, targets, state.

    `v`, `s` and `w` are the true speeds ahead (m/s), to the left (m/s) and about the robot (rad/s).
    """

    __slots__ = (*_LIMITS, *_TARGETS, *_STATE, "arithmetic", "cars", "dt", "expiry", "sideways", "wheeled")

    arithmetic: Arithmetic[Number]
    dt: float
    expiry: float
    cars: bool
    sideways: bool
    wheeled: bool
    a_dt: Number
    side_dt: Number
    alpha_dt: Number
    steer_dt: Number
    grip_dt: Number
    turn_grip_dt: Number
    mass_dt: Number
    inertia_dt: Number
    wheelbase: Number
    car: Number
    omni: Number
    target_v: Number
    target_s: Number
    target_w: Number
    target_steer: Number
    deadline: Number
    ramp_v: Number
    ramp_s: Number
    ramp_w: Number
    steer: Number
    vx: Number
    vy: Number
    v: Number
    s: Number
    w: Number
    chord: Number
    x: Number
    y: Number
    theta: Number
    rolled: Number
    slid: Number
    turned: Number
    driven: Number

    def __init__(self, arithmetic: Arithmetic[Number], dt: float) -> None:
        self.arithmetic, self.dt = arithmetic, dt
        self.cars = self.sideways = self.wheeled = False
        self.expiry = 0.0

    def push(self, vx: Number, vy: Number, angle: Number, w: Number) -> tuple[Number, Number, Number]:
        """Return the force (N, in the world) and the torque (N m) of one step, from the bodies' true velocity.

        The step first moves a body by its present velocity, which is the chord of this arc; the force then turns
        that into the chord of the next one: heading theta + w dt + w' dt / 2, length v' sinc(w' dt / 2).
        """
        arithmetic, turn = self.arithmetic, w * self.dt
        half = turn / 2
        cos, sin = arithmetic.cos(angle + half), arithmetic.sin(angle + half)
        self.vx, self.vy, self.w, self.chord = vx, vy, w, arithmetic.sinc(half)
        self.v, self.s = (vx * cos + vy * sin) / self.chord, (vy * cos - vx * sin) / self.chord
        self._ramp()
        half = self.ramp_w * self.dt / 2
        chord, middle = arithmetic.sinc(half), angle + turn + half
        cos, sin = arithmetic.cos(middle), arithmetic.sin(middle)
        ahead, aside = self.ramp_v * chord, self.ramp_s * chord
        force_x = self.mass_dt * (ahead * cos - aside * sin - vx)
        force_y = self.mass_dt * (ahead * sin + aside * cos - vy)
        return force_x, force_y, self.inertia_dt * (self.ramp_w - w)

    def _ramp(self) -> None:
        """Move the set speeds towards the targets, within the limits and never far from the true speeds."""
        clipped = self.arithmetic.clipped
        v = self.ramp_v + clipped(self.target_v - self.ramp_v, self.a_dt)
        self.ramp_v = self.v + clipped(v - self.v, self.grip_dt)
        if self.sideways:
            s = self.ramp_s + clipped(self.target_s - self.ramp_s, self.side_dt)
            self.ramp_s = self.s + clipped(s - self.s, self.grip_dt)
        else:
            self.ramp_s = self.s - clipped(self.s, self.grip_dt)
        w = self.ramp_w + clipped(self.target_w - self.ramp_w, self.alpha_dt)
        if self.cars:
            w = self.arithmetic.where(self.car, self._steered(), w)
        self.ramp_w = self.w + clipped(w - self.w, self.turn_grip_dt)

    def _steered(self) -> Number:
        """Turn a car's front wheels; return the turning speed that follows from their angle."""
        self.steer = self.steer + self.arithmetic.clipped(self.target_steer - self.steer, self.steer_dt)
        tangent = self.arithmetic.sin(self.steer) / self.arithmetic.cos(self.steer)
        return self.ramp_v * tangent / self.wheelbase

    def count(self, errors: tuple[Number, Number, Number, Number] | None) -> None:
        """Add the step's arc to the odometry; `errors` are factors of v, s and w, and the drift in rad/m; None: none.

        Wheels that only roll ahead do not notice how a robot slips. The true way is added up too, if there are wheels
        that measure it.
        """
        dt, v, s, turn, chord = self.dt, self.v, self.s, self.w * self.dt, self.chord
        self.driven = self.driven + self._way(v, s) * dt
        if self.wheeled:
            self.rolled, self.slid, self.turned = self.rolled + v * dt, self.slid + s * dt, self.turned + turn
        if errors is not None:
            v, s, turn = v * errors[0], s * errors[1], turn * errors[2] + v * dt * errors[3]
            chord = self.arithmetic.sinc(turn / 2)
        chord, middle = chord * dt, self.theta + turn / 2
        cos, sin, ahead = self.arithmetic.cos(middle), self.arithmetic.sin(middle), v * chord
        x, y = ahead * cos, ahead * sin
        if self.sideways:
            aside = s * self.omni * chord
            x, y = x - aside * sin, y + aside * cos
        self.x, self.y, self.theta = self.x + x, self.y + y, self.theta + turn

    def _way(self, v: Number, s: Number) -> Number:
        """Return the speed of the wheels' way over the floor; a robot that slips does not drive sideways."""
        if not self.sideways:
            return abs(v)
        aside = s * self.omni
        return self.arithmetic.root(v * v + aside * aside)


def speeds(
    arithmetic: Arithmetic[Number], dt: float, angle: Number, vx: Number, vy: Number, w: Number
) -> tuple[Number, Number, Number]:
    """Return the speeds along, about and across the heading of a body with these velocities, on the arc of a step."""
    half = w * dt / 2
    cos, sin, chord = arithmetic.cos(angle + half), arithmetic.sin(angle + half), arithmetic.sinc(half)
    return (vx * cos + vy * sin) / chord, w, (vy * cos - vx * sin) / chord


def motion_of_one(dt: float, start: Pose, limits: Mapping[str, float], wheeled: bool = False) -> Motion[float]:
    """Make the motion of a robot at rest; odometry begins at its pose."""
    made = Motion[float](FLOATS, dt)
    for name in (*_LIMITS, *_TARGETS, *_STATE):
        setattr(made, name, limits.get(name, 0.0))
    made.x, made.y, made.theta = start.x, start.y, start.theta
    made.deadline = made.expiry = NEVER
    made.cars, made.sideways, made.wheeled = made.car > 0.0, made.omni > 0.0, wheeled
    return made


def motion_of_many(ones: Sequence[Motion[float]]) -> Motion[Array]:
    """Join the motions of several robots, in their order."""
    made = Motion[Array](ARRAYS, ones[0].dt)
    for name in (*_LIMITS, *_TARGETS, *_STATE):
        setattr(made, name, np.array([getattr(each, name) for each in ones]))
    made.expiry = float(made.deadline.min())
    made.cars, made.sideways = any(each.cars for each in ones), any(each.sideways for each in ones)
    made.wheeled = any(each.wheeled for each in ones)
    return made


def fetch(one: Motion[float], many: Motion[Array], row: int) -> None:
    """Copy the state of a robot's row of many into its own motion."""
    for name in _STATE:
        setattr(one, name, float(getattr(many, name)[row]))


def store(one: Motion[float], many: Motion[Array], row: int) -> None:
    """Copy the targets of a robot's own motion into its row of many."""
    for name in _TARGETS:
        getattr(many, name)[row] = getattr(one, name)
    many.expiry = min(many.expiry, one.deadline)
