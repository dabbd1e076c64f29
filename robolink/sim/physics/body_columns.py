"""All bodies of a space read and written in one call, as numpy columns.

pymunk calls its batch module experimental, so what it gives is compared once with the bodies themselves, and they
are asked one by one where it is not as expected. That is the same, only slower.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pymunk
import pymunk.batch
from pymunk.batch import BodyFields

from robolink.sim.arrays import Array

_READ = BodyFields.ANGLE | BodyFields.VELOCITY | BodyFields.ANGULAR_VELOCITY
_WRITE = BodyFields.FORCE | BodyFields.TORQUE

_FLOAT = 8
"""Bytes."""

_SOME = 4
"""Fewer bodies are quicker asked one by one."""


class BodyColumns:
    """Some bodies of a space; make another one when any body has been added to the space or removed from it.

    `batched` says whether pymunk reads and writes them in one call.
    """

    def __init__(self, space: pymunk.Space, bodies: Sequence[pymunk.Body]) -> None:
        self._space, self._bodies = space, bodies
        self._read_buffer, self._write_buffer = pymunk.batch.Buffer(), pymunk.batch.Buffer()
        self.batched = _AVAILABLE and len(bodies) >= _SOME and self._prepare()

    def read(self) -> Array:
        """Give each body's angle, velocity along x and y and angular velocity, as rows."""
        if self.batched:
            return self._read_all()[self._rows]
        return np.array(self.read_rows())

    def read_rows(self) -> list[list[float]]:
        """Give the same as lists."""
        if self.batched:
            rows: list[list[float]] = self.read().tolist()
            return rows
        return [[body.angle, *body.velocity, body.angular_velocity] for body in self._bodies]

    def write(self, forces: Array | list[tuple[float, float, float]]) -> None:
        """Give each body its force (x, y) and torque of the next step; the other bodies of the space get none."""
        if self.batched:
            self._forces[self._rows] = forces
            pymunk.batch.set_space_bodies(self._space, _WRITE, self._write_buffer)
            return
        rows = forces if isinstance(forces, list) else forces.tolist()
        for body, (x, y, torque) in zip(self._bodies, rows, strict=True):
            body.force, body.torque = (x, y), torque

    def _prepare(self) -> bool:
        """Find out in which order the space tells its bodies; say whether all is as expected."""
        buffer = pymunk.batch.Buffer()
        pymunk.batch.get_space_bodies(self._space, BodyFields.BODY_ID, buffer)
        order = {number: row for row, number in enumerate(memoryview(buffer.int_buf()).cast("P"))}
        self._rows = np.array([order[body.id] for body in self._bodies], dtype=np.intp)
        self._forces = np.zeros((len(order), 3))
        self._write_buffer.set_float_buf(self._forces)
        return self._reads_as_expected() and self._writes_as_expected()

    def _read_all(self) -> Array:
        self._read_buffer.clear()
        pymunk.batch.get_space_bodies(self._space, _READ, self._read_buffer)
        return np.frombuffer(self._read_buffer.float_buf(), dtype=np.float64).reshape(-1, 4)

    def _reads_as_expected(self) -> bool:
        pymunk.batch.get_space_bodies(self._space, _READ, self._read_buffer)
        if len(self._read_buffer.float_buf()) != 4 * _FLOAT * len(self._forces):
            return False
        expected = [(body.angle, *body.velocity, body.angular_velocity) for body in self._bodies]
        return np.array_equal(self._read_all()[self._rows], expected)

    def _writes_as_expected(self) -> bool:
        wanted = np.arange(3.0 * len(self._bodies)).reshape(-1, 3)
        self._forces[self._rows] = wanted
        pymunk.batch.set_space_bodies(self._space, _WRITE, self._write_buffer)
        found = [(*body.force, body.torque) for body in self._bodies]
        self._forces[:] = 0.0
        for body in self._bodies:
            body.force, body.torque = (0.0, 0.0), 0.0
        return np.array_equal(found, wanted)


_AVAILABLE = hasattr(pymunk.batch, "get_space_bodies") and hasattr(pymunk.batch, "set_space_bodies")
