"""Contacts of movers (obstacles on a path): a body that one presses against a wall is passed over.

A mover goes on whatever it meets. A solver that resolved such a contact would shoot the body away.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from operator import itemgetter
from typing import TypeAlias

import pymunk

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
