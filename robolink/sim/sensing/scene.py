"""What sensors can see in a world: the fixed shapes, and where the moving ones are now."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import pymunk

from robolink.sim.arrays import Place
from robolink.sim.description import Shape, WorldDescription
from robolink.sim.sensing.fixed import fixed_circles, fixed_reflectances, fixed_segments
from robolink.sim.sensing.surroundings import FIXED, Circles, Edges, Surroundings, circles_of
from robolink.sim.sensing.tiles import Tiles, columns


class Scene:
    """All shapes of a world; those that move are looked at anew when `step` has changed or `moved` was called."""

    def __init__(self, description: WorldDescription) -> None:
        self.fixed_segments, self.fixed_circles = fixed_segments(description), fixed_circles(description)
        of_segments, of_circles = fixed_reflectances(description)
        self._walls = Tiles(self.fixed_segments, of_segments)
        self._standing = circles_of(self.fixed_circles, of_circles, np.full(len(of_circles), FIXED))
        self._discs, self._polygons = _Discs(self._standing), _Polygons()
        self._moving: dict[pymunk.Body, _Moving] = {}
        self._next_number = 0
        self.step, self._seen = 0, -1
        self._places: dict[pymunk.Body, Place] = {}
        self._surroundings = Surroundings(self._walls, self._standing)

    def add(self, body: pymunk.Body, shape: Shape, reflectance: float = 1.0) -> None:
        """Add something that moves."""
        self._moving[body] = _Moving(body, shape, reflectance, self._next_number)
        self._next_number += 1
        self._sort()

    def remove(self, body: pymunk.Body) -> None:
        """Take away something that moves; raises `KeyError` if it isn't there."""
        del self._moving[body]
        self._sort()

    def number(self, body: pymunk.Body) -> int:
        """Give the number of what moves: a sensor that is told it doesn't see it. Raises `KeyError`."""
        return self._moving[body].number

    def moved(self) -> None:
        """Take note that something was moved other than by a step."""
        self._seen = -1

    def surroundings(self) -> Surroundings:
        """Give all that can be seen now."""
        if self._seen != self.step:
            self._look()
        return self._surroundings

    def places(self) -> Mapping[pymunk.Body, Place]:
        """Give where everything is now that moves."""
        if self._seen != self.step:
            self._look()
        return self._places

    def _look(self) -> None:
        self._places = places = {body: (*body.position, body.angle) for body in self._moving}
        self._surroundings = Surroundings(self._walls, self._discs.at(places), self._polygons.at(places))
        self._seen = self.step

    def _sort(self) -> None:
        moving = list(self._moving.values())
        self._discs = _Discs(self._standing, [each for each in moving if each.shape.circle is not None])
        self._polygons = _Polygons([each for each in moving if each.shape.circle is None])
        self.moved()


class _Moving(NamedTuple):
    body: pymunk.Body
    shape: Shape
    reflectance: float
    number: int


class _Discs:
    """Fixed circles and those that move: all but where these are is known beforehand."""

    def __init__(self, fixed: Circles, moving: Sequence[_Moving] = ()) -> None:
        self._bodies, self._first = [each.body for each in moving], len(fixed.x)
        own = Circles(
            np.zeros(len(moving)),
            np.zeros(len(moving)),
            np.array([each.shape.circle for each in moving], dtype=np.float64),
            np.array([each.reflectance for each in moving], dtype=np.float64),
            np.array([each.number for each in moving], dtype=np.intp),
        )
        self._all = Circles(*(np.concatenate(both) for both in zip(fixed, own, strict=True)))
        self._centres = np.stack(self._all[:2])

    def at(self, places: Mapping[pymunk.Body, Place]) -> Circles:
        """Give all circles, with these places of those that move."""
        if not self._bodies:
            return self._all
        centres = self._centres.copy()
        centres[:, self._first :] = np.array([places[body] for body in self._bodies])[:, :2].T
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
        """Give all edges, if there are any, with the bodies at these places."""
        if not self._bodies:
            return None
        poses = [(x, y, math.cos(angle), math.sin(angle)) for x, y, angle in map(places.__getitem__, self._bodies)]
        x, y, cos, sin = np.array(poses).T.take(self._which, axis=1)
        first, second = ((x + cos * a - sin * b, y + sin * a + cos * b) for a, b in (self._first, self._second))
        return Edges(columns(np.stack((*first, *second), axis=1), self._reflectance), x, y, self._radius, self._number)
