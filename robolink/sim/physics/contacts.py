"""Contacts of robots with things, and with obstacles that move by themselves."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from operator import itemgetter
from typing import TypeAlias

import numpy as np
import pymunk
import pymunk.batch
from pymunk.batch import ArbiterFields

from robolink.sim.sensors import Bumper

# Contacts of movers (obstacles on a path): a body that one presses against a wall is passed over.
#
# A mover goes on whatever it meets. A solver that resolved such a contact would shoot the body away.


MOVER = 2
"""Chipmunk's collision type of obstacles that move by themselves."""

_STRAIGHT = 0.6
"""Least dot product of two contact normals that count as one direction: within 53 degrees."""

_DEEP = 0.02
"""Depth inside of a mover, in metres beyond the way of both in two steps, from which on a body cannot give way."""


Contact: TypeAlias = tuple[list[int], list[float]]
"""Two bodies that touch: the ids of both, and the number of points (1 or 2); then the direction from the first to the
second, and x, y and distance (negative inside) of two points."""


class MoverContacts:
    """Decides at each contact of a mover if it collides; `free` are the ids of bodies that give way.

    A body that cannot give way is passed over until both are apart.
    """

    def __init__(self, space: pymunk.Space, dt: float) -> None:
        self.free, self._dt = set[int](), dt
        self._met = set[tuple[pymunk.Shape, pymunk.Shape]]()
        self._neighbours: dict[int, list[tuple[int, float, float]]] = {}
        self._passed = set[tuple[pymunk.Shape, pymunk.Shape]]()
        self._pushed: dict[pymunk.Body, float] = {}
        space.on_collision(MOVER, None, begin=self._begin, pre_solve=self._meet, separate=self._separate)

    @property
    def active(self) -> bool:
        """True while any mover touches anything."""
        return bool(self._met)

    def settle(self, contacts: Iterable[Contact]) -> None:
        """Note all contacts after a step; a body that slipped out from between a mover and a wall goes no faster."""
        if not self._met:
            return
        for body, fastest in self._pushed.items():
            if body.velocity.length > fastest:
                body.velocity = body.velocity.scale_to_length(fastest)
        self._pushed.clear()
        neighbours = defaultdict[int, list[tuple[int, float, float]]](list)
        in_order = sorted(contacts, key=itemgetter(1))  # Chipmunk's is that of memory addresses
        for (one, other, _), (x, y, *_points) in in_order:
            neighbours[one].append((other, x, y))
            neighbours[other].append((one, -x, -y))
        self._neighbours = neighbours

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        self._met.add((arbiter.shapes[0], arbiter.shapes[1]))

    def _separate(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        one, other = arbiter.shapes
        for pair in ((one, other), (other, one)):  # when a shape is removed, Chipmunk names that one first
            self._met.discard(pair)
            self._passed.discard(pair)

    def _meet(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        pair = (arbiter.shapes[0], arbiter.shapes[1])
        if pair not in self._passed and self._is_trapped(arbiter):
            self._passed.add(pair)
        mover, body = arbiter.bodies
        if pair in self._passed:
            arbiter.process_collision = False
        else:
            self._pushed[body] = max(self._pushed.get(body, 0.0), mover.velocity.length, body.velocity.length)

    def _is_trapped(self, arbiter: pymunk.Arbiter) -> bool:
        mover, body = arbiter.bodies
        push = arbiter.contact_point_set
        deepest = max((-point.distance for point in push.points), default=0.0)
        if deepest > _DEEP + 2 * (mover.velocity.length + body.velocity.length) * self._dt:
            return True
        return self._blocked(body.id, push.normal.x, push.normal.y, {mover.id, body.id})

    def _blocked(self, body: int, x: float, y: float, seen: set[int]) -> bool:
        """True if a body cannot move in a direction, for one that never gives way or one that cannot move either."""
        for other, to_x, to_y in self._neighbours.get(body, ()):
            if other in seen or x * to_x + y * to_y < _STRAIGHT:
                continue
            seen.add(other)
            if other not in self.free or self._blocked(other, to_x, to_y, seen):
                return True
        return False


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
