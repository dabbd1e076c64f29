"""Contacts of robots: counted as they begin and end, and measured while they last."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import pymunk
import pymunk.batch
from pymunk.batch import ArbiterFields

from robolink.sim.physics.mover_contacts import MOVER, Contact, MoverContacts
from robolink.sim.sensors import Bumper

ROBOT = 1
"""Chipmunk's collision type of robots; walls, crates and fixed things have none."""

_WHO = ArbiterFields.BODY_A_ID | ArbiterFields.BODY_B_ID | ArbiterFields.CONTACT_COUNT
_POINTS = ArbiterFields.POINT_A_1 | ArbiterFields.DISTANCE_1 | ArbiterFields.POINT_A_2 | ArbiterFields.DISTANCE_2
_FIELDS = _WHO | ArbiterFields.NORMAL | _POINTS


class Sector:
    """Sector of a robot's surface: `touched` since it was last set to False."""

    def __init__(self, bumper: Bumper) -> None:
        self._middle, self._half = math.radians(bumper.right + bumper.fov / 2), math.radians(bumper.fov) / 2
        self.touched = False

    def feel(self, direction: float) -> None:
        """Note a touch in a direction, in radians from ahead."""
        if abs(math.remainder(direction - self._middle, math.tau)) <= self._half + 1e-9:
            self.touched = True


@dataclass
class Touches:
    """Contacts of one robot: begun so far (`contacts`), now (`touching`), and the deepest `penetration` in metres."""

    body: pymunk.Body
    contacts: int = 0
    touching: int = 0
    penetration: float = 0.0
    sectors: list[Sector] = field(default_factory=list)

    def feel(self, contact: Contact) -> None:
        """Note where the robot is touched after a step."""
        (_, _, count), (_, _, *points) = contact
        (x, y), theta = self.body.position, self.body.angle
        for first in range(0, 3 * count, 3):
            direction = math.atan2(points[first + 1] - y, points[first] - x) - theta
            for sector in self.sectors:
                sector.feel(direction)


class Contacts:
    """All contacts of a space's robots, and of its movers."""

    def __init__(self, space: pymunk.Space, dt: float) -> None:
        self._space = space
        self._touches: dict[pymunk.Shape, Touches] = {}
        self._by_body: dict[int, Touches] = {}
        self._movers = MoverContacts(space, dt)
        self._buffer = pymunk.batch.Buffer()
        self._pairs = set[tuple[pymunk.Shape, pymunk.Shape]]()
        self.begun = 0
        """Number of contacts of robots that have begun since the start."""
        space.on_collision(ROBOT, None, begin=self._begin, separate=self._separate)

    def add(self, touches: Touches, shapes: Iterable[pymunk.Shape]) -> None:
        """Count the contacts of a robot's shapes."""
        self._by_body[touches.body.id] = touches
        self._movers.free.add(touches.body.id)
        for shape in shapes:
            shape.collision_type = ROBOT
            self._touches[shape] = touches

    def remove(self, touches: Touches, shapes: Iterable[pymunk.Shape]) -> None:
        """Forget a robot that has left the space."""
        del self._by_body[touches.body.id]
        self._movers.free.discard(touches.body.id)
        for shape in shapes:
            del self._touches[shape]

    def add_pushable(self, body: pymunk.Body) -> None:
        """Add an obstacle that can be pushed."""
        self._movers.free.add(body.id)

    def add_mover(self, shapes: Iterable[pymunk.Shape]) -> None:
        """Add an obstacle that moves by itself."""
        for shape in shapes:
            shape.collision_type = MOVER

    def measure(self) -> None:
        """Measure all contacts after a step; costs nothing while there are none."""
        if not (self._pairs or self._movers.active):
            return
        buffer = self._buffer
        buffer.clear()
        pymunk.batch.get_space_arbiters(self._space, _FIELDS, buffer)
        bodies = np.frombuffer(buffer.int_buf(), dtype=np.uintp).reshape(-1, 3).tolist()
        numbers = np.frombuffer(buffer.float_buf(), dtype=np.float64).reshape(-1, 8).tolist()
        contacts = [contact for contact in zip(bodies, numbers, strict=True) if contact[0][2]]
        for contact in contacts:
            self._feel(contact)
        self._movers.settle(contacts)

    def _feel(self, contact: Contact) -> None:
        (one, other, count), (_, _, _, _, first, _, _, second) = contact
        deepest = -first if count == 1 or first < second else -second
        for body in (one, other):
            touches = self._by_body.get(body)
            if touches is not None:
                if deepest > touches.penetration:
                    touches.penetration = deepest
                if touches.sectors:
                    touches.feel(contact)

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        """Count a contact; if two robots meet, each is the first shape of a call of its own."""
        one, other = arbiter.shapes
        touches = self._touches[one]
        touches.contacts += 1
        self.begun += 1
        touches.touching += 1
        self._pairs.add((one, other))

    def _separate(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        """End a contact; if a shape is removed, Chipmunk names it first in both calls."""
        one, other = arbiter.shapes
        for pair in ((one, other), (other, one)):
            if pair in self._pairs:
                self._pairs.remove(pair)
                self._touches[pair[0]].touching -= 1
