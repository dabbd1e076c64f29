"""Scene that sensors look at: fixed and moving shapes by tiles, and what cameras see."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
import pymunk

from robolink.sim.arrays import Array, Indices, Place
from robolink.sim.description import Obstacle, RobotDescription, Shape, WorldDescription
from robolink.sim.physics.body_columns import BodyPlaces
from robolink.sim.quantities import Pose
from robolink.sim.rendering.renderer import Backdrop, Setting
from robolink.sim.scene.scenery import robot_surfaces, scenery
from robolink.sim.scene.solids import Scenery, Surfaces

Corners: TypeAlias = Sequence[tuple[float, float]]


def fixed_segments(description: WorldDescription) -> Array:
    """Return walls and the edges of fixed boxes and polygons as rows x1, y1, x2, y2."""
    rows = [[*start, *end] for wall in description.walls for start, end in wall.segments()]
    parts = [np.array(rows, dtype=np.float64).reshape(-1, 4)]
    for thing in _fixed(description):
        if thing.circle is None:
            parts.append(edges(thing.corners(), thing.start))
    return np.concatenate(parts)


def fixed_circles(description: WorldDescription) -> Array:
    """Return the fixed circles as rows x, y, radius."""
    rows = [[thing.start.x, thing.start.y, thing.circle] for thing in _fixed(description) if thing.circle is not None]
    return np.array(rows, dtype=np.float64).reshape(-1, 3)


def fixed_reflectances(description: WorldDescription) -> tuple[Array, Array]:
    """Return the reflectances of the fixed segments and of the fixed circles, in their order."""
    of_walls = [wall.reflectance for wall in description.walls for _ in wall.segments()]
    fixed = _fixed(description)
    of_edges = [thing.reflectance for thing in fixed for _ in thing.corners()]
    of_circles = [thing.reflectance for thing in fixed if thing.circle is not None]
    return np.array(of_walls + of_edges, dtype=np.float64), np.array(of_circles, dtype=np.float64)


def edges(corners: Corners, pose: Pose) -> Array:
    """Return the edges of a polygon at a pose as rows x1, y1, x2, y2."""
    cos, sin = math.cos(pose.theta), math.sin(pose.theta)
    local = np.asarray(corners, dtype=np.float64)
    moved = np.column_stack(
        (pose.x + cos * local[:, 0] - sin * local[:, 1], pose.y + sin * local[:, 0] + cos * local[:, 1])
    )
    return np.concatenate((moved, np.roll(moved, -1, axis=0)), axis=1)


def nearest_wall_distance(segments: Array, circles: Array, x: float, y: float) -> float:
    """Return the distance in metres from a point to the nearest segment or circle; inf in an empty world."""
    to_segments = float(np.min(segment_distances(segments, x, y), initial=math.inf))
    to_circles = np.hypot(circles[:, 0] - x, circles[:, 1] - y) - circles[:, 2]
    return min(to_segments, float(np.min(to_circles, initial=math.inf)))


def segment_distances(segments: Array, x: float, y: float) -> Array:
    """Return the distance from a point to each segment, in metres."""
    start, along = segments[:, :2], segments[:, 2:] - segments[:, :2]
    to_point = np.array((x, y)) - start
    square = np.maximum((along * along).sum(axis=1), 1e-300)  # a segment without length is a point
    share = np.clip((to_point * along).sum(axis=1) / square, 0.0, 1.0)
    gap = to_point - share[:, None] * along
    distances: Array = np.hypot(gap[:, 0], gap[:, 1])
    return distances


def _fixed(description: WorldDescription) -> list[Obstacle]:
    return [thing for thing in description.obstacles if thing.mass is None and thing.path is None]


X, Y, NORMAL, REFLECTANCE = slice(0, 2), slice(2, 4), slice(4, 7), 7
"""Rows of `columns`: x of both ends, y of both ends, the unit normal (x, y, and -x to turn it by), the reflectance."""

_FEW = 64
"""Number of segments up to which checking all is faster than choosing."""

_TILES_ACROSS = 6
"""Number of tiles in the length of the reach: more of them fit closer and are left sooner."""

_MOST_COLUMNS = 1_000_000
"""Most columns that are stored in all tiles together: 64 MB."""


def columns(segments: Array, reflectances: Array) -> Array:
    """Return segments (rows x1, y1, x2, y2) as columns with all that a scanner needs of each."""
    x1, y1, x2, y2 = segments.T
    dx, dy = x2 - x1, y2 - y1
    length = np.sqrt(dx * dx + dy * dy)
    point = length == 0.0  # as good as a short piece of a line that goes up
    length[point], dy = 1.0, np.where(point, 1.0, dy)
    return np.stack((x1, x2, y1, y2, dy / length, -dx / length, -dy / length, reflectances))


class Tiles:
    """Fixed segments with `reflectances`; those near a tile of the plane are searched once."""

    def __init__(self, segments: Array, reflectances: Array) -> None:
        self._segments, self._columns = segments, columns(segments, reflectances)
        x1, y1, x2, y2 = segments.T
        self._middle_x, self._middle_y = (x1 + x2) / 2, (y1 + y2) / 2
        self._half = np.sqrt((x2 - x1) ** 2 + (y2 - y1) ** 2) / 2
        self._near: dict[tuple[int, int, float], Array] = {}
        self._count = 0

    def near(self, x: float, y: float, reach: float) -> Array:
        """Return the columns of all segments within `reach` metres of a place, in order, and some farther ones."""
        if len(self._half) <= _FEW:
            return self._columns
        side = reach / _TILES_ACROSS
        tile = (math.floor(x / side), math.floor(y / side), reach)
        found = self._near.get(tile)
        return self._remember(tile, side) if found is None else found

    def _remember(self, tile: tuple[int, int, float], side: float) -> Array:
        column, row, reach = tile
        found = self._within((column + 0.5) * side, (row + 0.5) * side, reach + 0.75 * side)  # 0.71: to its corners
        while self._near and self._count + found.shape[1] > _MOST_COLUMNS:
            self._count -= self._near.pop(next(iter(self._near))).shape[1]
        self._count += found.shape[1]
        self._near[tile] = found
        return found

    def _within(self, x: float, y: float, reach: float) -> Array:
        dx, dy, farthest = self._middle_x - x, self._middle_y - y, self._half + reach
        perhaps = np.flatnonzero(dx * dx + dy * dy <= farthest * farthest)
        which = perhaps[segment_distances(self._segments[perhaps], x, y) <= reach]
        found: Array = self._columns.take(which, axis=1)
        return found


FIXED = -1
"""Owner number of fixed shapes; moving ones are numbered from 0."""

NOBODY = -2
"""Owner number of a sensor that is mounted on nothing and sees everything."""


class Circles(NamedTuple):
    """Circles as arrays, one for each of their properties."""

    x: Array
    y: Array
    radius: Array
    reflectance: Array
    owner: Indices

    def taken(self, which: Indices) -> Circles:
        """Return some of them."""
        x, y, radius, reflectance = (each.take(which) for each in self[:4])
        return Circles(x, y, radius, reflectance, self.owner.take(which))


class Edges(NamedTuple):
    """Segments that move, as `tiles.columns`, and the circle about the whole shape that each belongs to."""

    columns: Array
    x: Array
    y: Array
    radius: Array
    owner: Indices


class Surroundings(NamedTuple):
    """All that can be seen. A sensor does not see the shape that it is mounted on, which it names by its number."""

    walls: Tiles
    circles: Circles
    edges: Edges | None = None

    def segments_near(self, x: float, y: float, reach: float, own: int) -> Array:
        """Return the columns of the segments that a sensor at a place may see."""
        walls = self.walls.near(x, y, reach)
        if self.edges is None:
            return walls
        dx, dy, farthest = self.edges.x - x, self.edges.y - y, self.edges.radius + reach
        seen = (dx * dx + dy * dy <= farthest * farthest) & (self.edges.owner != own)
        return np.concatenate((walls, self.edges.columns.compress(seen, axis=1)), axis=1)

    def has_circles_but(self, own: Sequence[int]) -> bool:
        """True if there is any circle besides the only sensor's own."""
        owner = self.circles.owner
        return len(owner) > 1 or (len(owner) == 1 and (len(own) > 1 or own[0] != owner[0]))

    def circles_near(self, places: Sequence[Place], reach: float, own: Sequence[int]) -> tuple[Indices, Indices]:
        """Return all pairs (sensor, circle) of which the one may see the other; `own` is for each sensor."""
        x, y = np.array(places)[:, :2].T
        farthest = self.circles.radius + reach
        near = np.flatnonzero(
            (self.circles.x >= x.min() - farthest)
            & (self.circles.x <= x.max() + farthest)
            & (self.circles.y >= y.min() - farthest)
            & (self.circles.y <= y.max() + farthest)
        )
        dx, dy = self.circles.x.take(near) - x[:, None], self.circles.y.take(near) - y[:, None]
        farthest = farthest.take(near)
        others = self.circles.owner.take(near) != np.array(own)[:, None]
        sensors, found = np.nonzero((dx * dx + dy * dy <= farthest * farthest) & others)
        return sensors, near.take(found)


def circles_of(circles: Array, reflectance: Array, owner: Indices) -> Circles:
    """Return circles (rows x, y, radius) as arrays, one for each of their properties."""
    x, y, radius = np.ascontiguousarray(circles.T)
    return Circles(x, y, radius, reflectance, owner)


def standing(segments: Array, circles: Array) -> Surroundings:
    """Return surroundings in which nothing moves: rows x1, y1, x2, y2, and rows x, y, radius."""
    everything = circles_of(circles, np.ones(len(circles)), np.full(len(circles), FIXED, dtype=np.intp))
    return Surroundings(Tiles(segments, np.ones(len(segments))), everything)


class Sights:
    """Surfaces of a world that cameras see.

    Args:
        description: The world.
    """

    def __init__(self, description: WorldDescription) -> None:
        self._description = description
        self._scenery: Scenery | None = None
        self._backdrop: Backdrop | None = None
        self._settings: dict[int, Setting] = {}

    def forget(self) -> None:
        """Forget what moves: something has come or gone."""
        self._settings.clear()

    def setting(self, viewer: int, things: Iterable[tuple[int, RobotDescription | int | None]]) -> Setting:
        """Return the surfaces that a viewer sees, made once.

        Args:
            viewer: Number of the viewer.
            things: What moves, each with the row of its place: robots, obstacles by their places in the description, or
                None for what is not seen.
        """
        if self._scenery is None or self._backdrop is None:
            self._scenery = scenery(self._description)
            self._backdrop = Backdrop(self._scenery)
        if viewer not in self._settings:
            movable = self._scenery.movable
            self._settings[viewer] = Setting(
                self._backdrop, [(row, _surfaces(each, movable)) for row, each in things if each is not None]
            )
        return self._settings[viewer]


def _surfaces(thing: RobotDescription | int, movable: dict[int, Surfaces]) -> Surfaces:
    return movable[thing] if isinstance(thing, int) else robot_surfaces(thing)


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
        """Return the setting that a camera on a body sees, without this body, and the present places of what moves."""
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
