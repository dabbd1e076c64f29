"""Fleet of a world: drives all robots, one by one while they are few, vectorized with numpy when they are many."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pymunk

from robolink.geometry.plane import wrapped
from robolink.sim.arrays import Array
from robolink.sim.driving.arithmetic import ARRAYS, FLOATS
from robolink.sim.driving.motion import NEVER, Motion, fetch, motion_of_many, speeds, store
from robolink.sim.driving.odometry_errors import BLOCK, COLUMNS, OdometryErrors
from robolink.sim.physics.body_columns import BodyColumns
from robolink.sim.quantities import Pose
from robolink.sim.readings import Velocity

MANY = 20
"""Number of robots from which on numpy's fixed costs are less than Python's per robot; the results are the same."""

_set_force, _set_torque = (vars(pymunk.Body)[name].fset for name in ("force", "torque"))
"""Setters of pymunk's Body: half the time of an assignment, which passes through a `__setattr__` in Python."""

_angle, _velocity, _turn = (vars(pymunk.Body)[name].fget for name in ("angle", "velocity", "angular_velocity"))
"""Getters of pymunk's Body: Python 3.11 calls a function faster than that of a property."""


class Member(NamedTuple):
    """A robot's body, its own motion, and the errors of its odometry."""

    body: pymunk.Body
    motion: Motion[float]
    errors: OdometryErrors | None


class Fleet:
    """Drives robots step by step and keeps their odometry."""

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._members: list[Member] = []
        self._rows: dict[pymunk.Body, int] = {}
        self._bodies = BodyColumns(space, ())
        self._columns: _Columns | None = None
        self._changed = False
        self._states: dict[pymunk.Body, tuple[float, float, float, float]] = {}
        """Angles and velocities of bodies that were read since they moved."""

    def add(self, member: Member) -> None:
        """Add a robot whose body is in the space."""
        self._disband()
        self._members.append(member)

    def remove(self, member: Member) -> None:
        """Remove a robot whose body has left the space."""
        self._disband()
        self._members = [each for each in self._members if each.body is not member.body]

    def motion(self, member: Member) -> Motion[float]:
        """Return a robot's own motion, up to date."""
        if self._columns is not None:
            fetch(member.motion, self._columns.motion, self._rows[member.body])
        return member.motion

    def odometry(self, member: Member) -> Pose:
        """Return a robot's pose by odometry."""
        if self._columns is not None:
            return self._columns.odometry()[self._rows[member.body]]
        motion = member.motion
        return Pose(motion.x, motion.y, wrapped(motion.theta))

    def twist(self, member: Member) -> Velocity:
        """Return a robot's true speeds."""
        if self._columns is not None:
            return self._columns.twists(self._bodies)[self._rows[member.body]]
        return Velocity(*speeds(FLOATS, member.motion.dt, *self._state(member.body)))

    def _state(self, body: pymunk.Body) -> tuple[float, float, float, float]:
        """Return the angle, velocity along x and y, and angular velocity of a body."""
        found = self._states.get(body)
        if found is None:
            found = self._states[body] = (_angle(body), *_velocity(body), _turn(body))
        return found

    def moved(self) -> None:
        """Note that the bodies have made a step, or that one of them was put elsewhere."""
        self._states.clear()
        if self._columns is not None:
            self._columns.moved()

    def take_targets(self, member: Member) -> None:
        """Take over new targets of a robot's own motion."""
        if self._columns is not None:
            store(member.motion, self._columns.motion, self._rows[member.body])

    def take_limits(self) -> None:
        """Take over new limits of robots' own motions, from the next step on."""
        self._disband()

    def rest(self, member: Member) -> None:
        """Stop a robot that has been put elsewhere."""
        self._disband()
        self._states.clear()
        motion = member.motion
        motion.ramp_v = motion.ramp_s = motion.ramp_w = 0.0
        motion.vx = motion.vy = motion.v = motion.s = motion.w = 0.0

    def advance(self, step: int) -> None:
        """Set the forces of all robots for the coming step, and add its arcs to their odometry."""
        if self._changed:
            self._gather()
        if self._columns is not None:
            self._bodies.write(self._columns.advance(step, self._columns.states(self._bodies)))
            return
        if not self._bodies.batched:
            for body, motion, errors in self._members:
                force_x, force_y, torque = _advanced(motion, errors, self._state(body), step)
                _set_force(body, (force_x, force_y))
                _set_torque(body, torque)
            return
        states = self._bodies.read_rows()
        self._bodies.write(
            [
                _advanced(motion, errors, row, step)
                for (_, motion, errors), row in zip(self._members, states, strict=True)
            ]
        )

    def _disband(self) -> None:
        """Return to one motion per robot, until the next step."""
        for member in self._members:
            self.motion(member)
        self._columns, self._changed = None, True

    def _gather(self) -> None:
        self._changed, members = False, self._members
        self._rows = {member.body: row for row, member in enumerate(members)}
        self._bodies = BodyColumns(self._space, [member.body for member in members])
        self._columns = _Columns(members) if len(members) >= MANY else None


class _Columns:
    """The motions of many robots as numpy columns."""

    def __init__(self, members: list[Member]) -> None:
        self.motion = motion_of_many([member.motion for member in members])
        self._each = [member.errors for member in members]
        self._err = any(errors is not None for errors in self._each)
        self._errors, self._block = np.ones((COLUMNS, BLOCK, len(members))), -1
        self._errors[3] = 0.0
        self._odometry: list[Pose] | None = None
        self._states: Array | None = None
        self._twists: list[Velocity] | None = None

    def odometry(self) -> list[Pose]:
        """Return the odometry of all robots; at once, since a reader of one reads the others too."""
        if self._odometry is None:
            motion = self.motion
            columns = motion.x.tolist(), motion.y.tolist(), map(wrapped, motion.theta.tolist())
            self._odometry = list(map(Pose, *columns))
        return self._odometry

    def moved(self) -> None:
        """Forget how the bodies were before."""
        self._states = self._twists = None

    def states(self, bodies: BodyColumns) -> Array:
        """Return the bodies' angles and velocities after the last step."""
        if self._states is None:
            self._states = bodies.read()
        return self._states

    def twists(self, bodies: BodyColumns) -> list[Velocity]:
        """Return the true speeds of all robots; at once, as odometry."""
        if self._twists is None:
            found = speeds(ARRAYS, self.motion.dt, *self.states(bodies).T)
            self._twists = list(map(Velocity, *(each.tolist() for each in found)))
        return self._twists

    def advance(self, step: int, rows: Array) -> Array:
        """Return the forces of a step from the bodies' angles and velocities before it."""
        motion = self.motion
        if step >= motion.expiry:
            self._stop_late(step)
        forces: Array = np.array(motion.push(rows[:, 1], rows[:, 2], rows[:, 0], rows[:, 3])).T
        motion.count(self._errors_at(step) if self._err else None)
        self._odometry = None
        return forces

    def _stop_late(self, step: int) -> None:
        motion = self.motion
        late = motion.deadline <= step
        for target in (motion.target_v, motion.target_s, motion.target_w):
            target[late] = 0.0
        motion.deadline[late] = NEVER
        motion.expiry = float(motion.deadline.min())

    def _errors_at(self, step: int) -> tuple[Array, Array, Array, Array]:
        if step // BLOCK != self._block:
            self._block = step // BLOCK
            for row, errors in enumerate(self._each):
                if errors is not None:
                    self._errors[:, :, row] = errors.block(step).T
        v, s, w, drift = self._errors[:, step % BLOCK]
        return v, s, w, drift


def _advanced(
    motion: Motion[float], errors: OdometryErrors | None, state: Sequence[float], step: int
) -> tuple[float, float, float]:
    """Advance one robot; return its force and torque."""
    if step >= motion.expiry:
        motion.target_v = motion.target_s = motion.target_w = 0.0
        motion.deadline = motion.expiry = NEVER
    angle, vx, vy, w = state
    force = motion.push(vx, vy, angle, w)
    motion.count(None if errors is None else errors.at(step))
    return force
