"""Scene of a world as sensors see it: the fixed shapes, and the present places of the moving ones."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pymunk

from robolink.sim.arrays import Array, Place
from robolink.sim.description import RobotDescription, Shape, WorldDescription
from robolink.sim.physics.body_columns import BodyPlaces
from robolink.sim.rendering.renderer import Setting
from robolink.sim.sensing.fixed import fixed_circles, fixed_reflectances, fixed_segments
from robolink.sim.sensing.sights import Sights
from robolink.sim.sensing.surroundings import FIXED, Circles, Edges, Surroundings, circles_of
from robolink.sim.sensing.tiles import Tiles, columns


class Scene:
    """All shapes of a world; those that move are updated when `step` has changed or `moved` was called.

    Their bodies are those of `space`.
    """

    def __init__(self, description: WorldDescription, space: pymunk.Space) -> None:
        self._space = space
        self.fixed_segments, self.fixed_circles = fixed_segments(description), fixed_circles(description)
        of_segments, of_circles = fixed_reflectances(description)
        self._walls = Tiles(self.fixed_segments, of_segments)
        self._standing = circles_of(self.fixed_circles, of_circles, np.full(len(of_circles), FIXED))
        self._discs, self._polygons = _Discs(self._standing), _Polygons()
        self._moving: dict[pymunk.Body, _Moving] = {}
        self._next_number = 0
        self.step, self._seen = 0, -1
        self._bodies: BodyPlaces | None = None
        self._rows: Array = np.empty((0, 3))
        self._places: dict[pymunk.Body, Place] = {}
        self._surroundings: Surroundings | None = None
        self._sights = Sights(description)

    def add(
        self, body: pymunk.Body, shape: Shape, reflectance: float = 1.0, thing: RobotDescription | int | None = None
    ) -> None:
        """Add a shape that moves.

        Args:
            body: Its body.
            shape: Its outline.
            reflectance: Share of light that it sends back.
            thing: What cameras see there: a robot, or an obstacle by its place in the description; None: nothing.
        """
        self._moving[body] = _Moving(body, shape, reflectance, self._next_number, thing)
        self._next_number += 1
        self._sort()

    def remove(self, body: pymunk.Body) -> None:
        """Remove a shape that moves; raises `KeyError` if it is not there."""
        del self._moving[body]
        self._sort()

    def number(self, body: pymunk.Body) -> int:
        """Return the number of a moving shape, by which a sensor leaves out its own. Raises `KeyError`."""
        return self._moving[body].number

    def moved(self) -> None:
        """Note that something was moved other than by a step."""
        self._seen = -1

    def surroundings(self) -> Surroundings:
        """Return all that can be seen now."""
        places = self.poses()
        if self._surroundings is None:
            self._surroundings = Surroundings(self._walls, self._discs.at(self._rows), self._polygons.at(places))
        return self._surroundings

    def poses(self) -> Mapping[pymunk.Body, Place]:
        """Return the present place of each moving body."""
        if self._seen != self.step:
            self._look()
        return self._places

    def sight(self, body: pymunk.Body) -> tuple[Setting, Array]:
        """Return what a camera on a body sees, all but this body itself, and the present places of what moves."""
        self.poses()
        number = self.number(body)
        things = [(row, each.thing) for row, each in enumerate(self._moving.values()) if each.number != number]
        return self._sights.setting(number, things), self._rows

    def _look(self) -> None:
        if self._bodies is None:
            self._bodies = BodyPlaces(self._space, list(self._moving))
        self._rows = self._bodies.read()
        self._places = dict(zip(self._moving, map(_place, self._rows.tolist()), strict=True))
        self._seen, self._surroundings = self.step, None

    def _sort(self) -> None:
        moving = list(self._moving.values())
        self._discs = _Discs(self._standing, moving)
        self._polygons = _Polygons([each for each in moving if each.shape.circle is None])
        self._bodies = None
        self._sights.forget()
        self.moved()


def _place(row: list[float]) -> Place:
    x, y, angle = row
    return x, y, angle


class _Moving(NamedTuple):
    body: pymunk.Body
    shape: Shape
    reflectance: float
    number: int
    thing: RobotDescription | int | None


class _Discs:
    """Fixed circles and those that move: all but the places of these is computed once."""

    def __init__(self, fixed: Circles, all_moving: Sequence[_Moving] = ()) -> None:
        self._which = [row for row, each in enumerate(all_moving) if each.shape.circle is not None]
        self._first, moving = len(fixed.x), [all_moving[row] for row in self._which]
        own = Circles(
            np.zeros(len(moving)),
            np.zeros(len(moving)),
            np.array([each.shape.circle for each in moving], dtype=np.float64),
            np.array([each.reflectance for each in moving], dtype=np.float64),
            np.array([each.number for each in moving], dtype=np.intp),
        )
        self._all = Circles(*(np.concatenate(both) for both in zip(fixed, own, strict=True)))
        self._centres = np.stack(self._all[:2])

    def at(self, rows: Array) -> Circles:
        """Return all circles, with the bodies that move at these places (x, y, angle)."""
        if not self._which:
            return self._all
        centres = self._centres.copy()
        centres[:, self._first :] = rows[self._which, :2].T
        return Circles(centres[0], centres[1], *self._all[2:])


class _Polygons:
    """Boxes and polygons that move: their edges in their own frames."""

    def __init__(self, moving: Sequence[_Moving] = ()) -> None:
        self._bodies = [each.body for each in moving]
        corners = [each.shape.corners() for each in moving]
        counts = [len(each) for each in corners]
        self._which = np.repeat(np.arange(len(moving)), counts)
        self._first = np.array([point for each in corners for point in each]).reshape(-1, 2).T
        self._second = np.array([point for each in corners for point in [*each[1:], each[0]]]).reshape(-1, 2).T
        self._radius = np.repeat([each.shape.outer_radius() for each in moving], counts)
        self._reflectance = np.repeat([each.reflectance for each in moving], counts)
        self._number = np.repeat(np.array([each.number for each in moving], dtype=np.intp), counts)

    def at(self, places: Mapping[pymunk.Body, Place]) -> Edges | None:
        """Return all edges with the bodies at these places; None if there are none."""
        if not self._bodies:
            return None
        poses = [(x, y, math.cos(angle), math.sin(angle)) for x, y, angle in map(places.__getitem__, self._bodies)]
        x, y, cos, sin = np.array(poses).T.take(self._which, axis=1)
        first, second = ((x + cos * a - sin * b, y + sin * a + cos * b) for a, b in (self._first, self._second))
        return Edges(columns(np.stack((*first, *second), axis=1), self._reflectance), x, y, self._radius, self._number)
