"""All robots of a world driven together: one by one while they are few, as columns of numbers when they are many."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pymunk

from robolink.sim.arrays import Array
from robolink.sim.driving.motion import NEVER, Motion, fetch, motion_of_many, store
from robolink.sim.driving.odometry_noise import BLOCK, OdometryNoise
from robolink.sim.physics.body_columns import BodyColumns

MANY = 20
"""From so many robots on, numpy's fixed costs are less than Python's for each robot; the results are the same."""

_set_force, _set_torque = (vars(pymunk.Body)[name].fset for name in ("force", "torque"))
"""As an assignment, but in half the time: that passes through a `__setattr__` in Python."""


class Member(NamedTuple):
    """A robot's body, its own motion, and how wrong its odometry is."""

    body: pymunk.Body
    motion: Motion[float]
    noise: OdometryNoise | None


class Fleet:
    """Pushes robots step by step and keeps their odometry."""

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._members: list[Member] = []
        self._rows: dict[pymunk.Body, int] = {}
        self._bodies = BodyColumns(space, ())
        self._columns: _Columns | None = None
        self._changed = False

    def add(self, member: Member) -> None:
        """Take in a robot whose body is in the space."""
        self._disband()
        self._members.append(member)

    def remove(self, member: Member) -> None:
        """Let a robot go whose body has left the space."""
        self._disband()
        self._members = [each for each in self._members if each.body is not member.body]

    def motion(self, member: Member) -> Motion[float]:
        """Give a robot's own motion, up to date."""
        if self._columns is not None:
            fetch(member.motion, self._columns.motion, self._rows[member.body])
        return member.motion

    def odometry(self, member: Member) -> tuple[float, float, float]:
        """Give where a robot believes to be: x, y, theta."""
        if self._columns is not None:
            return self._columns.odometry()[self._rows[member.body]]
        motion = member.motion
        return motion.x, motion.y, motion.theta

    def told(self, member: Member) -> None:
        """Heed what a robot's own motion has been told."""
        if self._columns is not None:
            store(member.motion, self._columns.motion, self._rows[member.body])

    def rest(self, member: Member) -> None:
        """Let a robot stand that has been put elsewhere."""
        self._disband()
        motion = member.motion
        motion.ramp_v = motion.ramp_s = motion.ramp_w = 0.0
        motion.vx = motion.vy = motion.v = motion.s = motion.w = 0.0

    def advance(self, step: int) -> None:
        """Push all robots for the coming step, and count into their odometry the arcs that it makes."""
        if self._changed:
            self._gather()
        if self._columns is not None:
            self._bodies.write(self._columns.advance(step, self._bodies.read()))
            return
        if not self._bodies.batched:
            for body, motion, noise in self._members:
                (vx, vy), w = body.velocity, body.angular_velocity
                force_x, force_y, torque = _advanced(motion, noise, (body.angle, vx, vy, w), step)
                _set_force(body, (force_x, force_y))
                _set_torque(body, torque)
            return
        states = self._bodies.read_rows()
        self._bodies.write(
            [_advanced(motion, noise, row, step) for (_, motion, noise), row in zip(self._members, states, strict=True)]
        )

    def _disband(self) -> None:
        """Let each robot have its own motion again, until the next step."""
        for member in self._members:
            self.motion(member)
        self._columns, self._changed = None, True

    def _gather(self) -> None:
        self._changed, members = False, self._members
        self._rows = {member.body: row for row, member in enumerate(members)}
        self._bodies = BodyColumns(self._space, [member.body for member in members])
        self._columns = _Columns(members) if len(members) >= MANY else None


class _Columns:
    """Many robots."""

    def __init__(self, members: list[Member]) -> None:
        self.motion = motion_of_many([member.motion for member in members])
        self._noises = [member.noise for member in members]
        self._noisy = any(noise is not None for noise in self._noises)
        self._errors, self._block = np.ones((3, BLOCK, len(members))), -1
        self._odometry: list[tuple[float, float, float]] | None = None

    def odometry(self) -> list[tuple[float, float, float]]:
        """Give where the robots believe to be; all at once, since who asks for one asks for the others too."""
        if self._odometry is None:
            motion = self.motion
            self._odometry = list(zip(motion.x.tolist(), motion.y.tolist(), motion.theta.tolist(), strict=True))
        return self._odometry

    def advance(self, step: int, rows: Array) -> Array:
        """Take the bodies' angles and velocities before a step; give its forces."""
        motion = self.motion
        if step >= motion.expiry:
            self._stop_late(step)
        forces: Array = np.array(motion.push(rows[:, 1], rows[:, 2], rows[:, 0], rows[:, 3])).T
        motion.count(self._errors_at(step) if self._noisy else None)
        self._odometry = None
        return forces

    def _stop_late(self, step: int) -> None:
        motion = self.motion
        late = motion.deadline <= step
        for target in (motion.target_v, motion.target_s, motion.target_w):
            target[late] = 0.0
        motion.deadline[late] = NEVER
        motion.expiry = float(motion.deadline.min())

    def _errors_at(self, step: int) -> tuple[Array, Array, Array]:
        if step // BLOCK != self._block:
            self._block = step // BLOCK
            for row, noise in enumerate(self._noises):
                if noise is not None:
                    self._errors[:, :, row] = noise.block(step).T
        v, s, w = self._errors[:, step % BLOCK]
        return v, s, w


def _advanced(
    motion: Motion[float], noise: OdometryNoise | None, state: Sequence[float], step: int
) -> tuple[float, float, float]:
    """Move one robot on; give its force and torque."""
    if step >= motion.expiry:
        motion.target_v = motion.target_s = motion.target_w = 0.0
        motion.deadline = motion.expiry = NEVER
    angle, vx, vy, w = state
    force = motion.push(vx, vy, angle, w)
    motion.count(None if noise is None else noise.at(step))
    return force
