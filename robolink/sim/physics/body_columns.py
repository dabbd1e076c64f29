"""Batched access to the bodies of a space: read and written in one call, as numpy columns.

pymunk calls its batch module experimental, so its result is compared once with the bodies themselves, and they
are read one by one if it is not as expected. That is the same, only slower.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pymunk
import pymunk.batch
from pymunk.batch import BodyFields

from robolink.sim.arrays import Array

_READ = BodyFields.ANGLE | BodyFields.VELOCITY | BodyFields.ANGULAR_VELOCITY
_WRITE = BodyFields.FORCE | BodyFields.TORQUE
_PLACE = BodyFields.POSITION | BodyFields.ANGLE

_FLOAT = 8
"""Size of a float in bytes."""

_SOME = 4
"""Number of bodies below which reading them one by one is quicker."""


class BodyRows:
    """Numbers of some bodies of a space; make another one when any body has been added to the space or removed from it.

    `batched` is True if pymunk reads (and writes) them in one call.

    Args:
        space: The space.
        bodies: The bodies, all of them in the space.
        fields: Fields of each that pymunk's batch module reads.
        read_one: Function that reads the same of one body.
    """

    def __init__(
        self,
        space: pymunk.Space,
        bodies: Sequence[pymunk.Body],
        fields: BodyFields,
        read_one: Callable[[pymunk.Body], list[float]],
    ) -> None:
        self._space, self._bodies, self._fields, self._read_one = space, bodies, fields, read_one
        self._read_buffer = pymunk.batch.Buffer()
        self.batched = _AVAILABLE and len(bodies) >= _SOME and self._prepare()

    def read(self) -> Array:
        """Return the numbers of each body as rows."""
        if self.batched:
            return self._read_all()[self._rows]
        return np.array(self.read_rows())

    def read_rows(self) -> list[list[float]]:
        """Return the same as lists."""
        if self.batched:
            rows: list[list[float]] = self.read().tolist()
            return rows
        return [self._read_one(body) for body in self._bodies]

    def _prepare(self) -> bool:
        """Find the order in which the space lists its bodies; return True if all is as expected."""
        buffer = pymunk.batch.Buffer()
        pymunk.batch.get_space_bodies(self._space, BodyFields.BODY_ID, buffer)
        order = {number: row for row, number in enumerate(memoryview(buffer.int_buf()).cast("P"))}
        self._rows = np.array([order[body.id] for body in self._bodies], dtype=np.intp)
        self._listed = len(order)
        return self._reads_as_expected()

    def _read_all(self) -> Array:
        self._read_buffer.clear()
        pymunk.batch.get_space_bodies(self._space, self._fields, self._read_buffer)
        return np.frombuffer(self._read_buffer.float_buf(), dtype=np.float64).reshape(self._listed, -1)

    def _reads_as_expected(self) -> bool:
        expected = [self._read_one(body) for body in self._bodies]
        pymunk.batch.get_space_bodies(self._space, self._fields, self._read_buffer)
        if len(self._read_buffer.float_buf()) != len(expected[0]) * _FLOAT * self._listed:
            return False
        return np.array_equal(self._read_all()[self._rows], expected)


class BodyPlaces(BodyRows):
    """Places of some bodies of a space: x, y and angle."""

    def __init__(self, space: pymunk.Space, bodies: Sequence[pymunk.Body]) -> None:
        super().__init__(space, bodies, _PLACE, lambda body: [*body.position, body.angle])


class BodyColumns(BodyRows):
    """Motion of some bodies of a space, angle, velocity along x and y and angular velocity, and the forces on them."""

    def __init__(self, space: pymunk.Space, bodies: Sequence[pymunk.Body]) -> None:
        self._write_buffer = pymunk.batch.Buffer()
        super().__init__(space, bodies, _READ, lambda body: [body.angle, *body.velocity, body.angular_velocity])

    def write(self, forces: Array | list[tuple[float, float, float]]) -> None:
        """Set each body's force (x, y) and torque of the next step; the other bodies of the space get none."""
        if self.batched:
            self._forces[self._rows] = forces
            pymunk.batch.set_space_bodies(self._space, _WRITE, self._write_buffer)
            return
        rows = forces if isinstance(forces, list) else forces.tolist()
        for body, (x, y, torque) in zip(self._bodies, rows, strict=True):
            body.force, body.torque = (x, y), torque

    def _prepare(self) -> bool:
        if not super()._prepare():
            return False
        self._forces = np.zeros((self._listed, 3))
        self._write_buffer.set_float_buf(self._forces)
        return self._writes_as_expected()

    def _writes_as_expected(self) -> bool:
        expected = np.arange(3.0 * len(self._bodies)).reshape(-1, 3)
        self._forces[self._rows] = expected
        pymunk.batch.set_space_bodies(self._space, _WRITE, self._write_buffer)
        found = [(*body.force, body.torque) for body in self._bodies]
        self._forces[:] = 0.0
        for body in self._bodies:
            body.force, body.torque = (0.0, 0.0), 0.0
        return np.array_equal(found, expected)


_AVAILABLE = hasattr(pymunk.batch, "get_space_bodies") and hasattr(pymunk.batch, "set_space_bodies")
