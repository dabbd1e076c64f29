"""Surfaces of solids that stand upright: walls, boxes, cylinders and prisms over polygons."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import cos, sin

from robolink.geometry.plane import Pose
from robolink.sim.colours import Colour
from robolink.sim.description import Shape
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point
from robolink.sim.scene.surfaces import Cylinder, Face, Surfaces

HERE = Pose()
"""Pose of a thing in its own frame."""


def upright(start: Point, end: Point, z0: float, z1: float, colour: Colour) -> Face:
    """Return the rectangle above the line from `start` to `end`, from the height z0 up to z1."""
    (x1, y1), (x2, y2) = start, end
    return Face((x1, y1, z0), (x2 - x1, y2 - y1, 0.0), (0.0, 0.0, z1 - z0), colour)


def solid(shape: Shape, pose: Pose, z0: float, z1: float, colour: Colour) -> Surfaces:
    """Return the surfaces of a solid over an outline: its sides, its top, and its bottom unless that is on the floor.

    Args:
        shape: Outline, about its own origin.
        pose: Pose of that origin.
        z0: Height of the bottom, in metres.
        z1: Height of the top.
        colour: Colour of all of it.
    """
    levels = [z1] if z0 <= 0.0 else [z1, z0]
    if shape.circle is not None:
        radius = shape.circle
        lids = tuple(_disc(pose.x, pose.y, z, radius, colour) for z in levels)
        return Surfaces(lids, (Cylinder(pose.x, pose.y, radius, z0, z1, colour),))
    corners = placed_corners(shape, pose)
    sides = [upright(p, q, z0, z1, colour) for p, q in zip(corners, [*corners[1:], corners[0]], strict=True)]
    if shape.box is not None:
        p, q, _, s = corners
        lids = tuple(Face((*p, z), _way(p, q), _way(p, s), colour) for z in levels)
    else:
        lids = tuple(_triangle(*each, z, colour) for each in _triangles(corners) for z in levels)
    return Surfaces((*sides, *lids))


def placed_corners(shape: Shape, pose: Pose) -> list[Point]:
    """Return the corners of an outline whose origin is at a pose."""
    c, s = cos(pose.theta), sin(pose.theta)
    return [(pose.x + c * x - s * y, pose.y + s * x + c * y) for x, y in shape.corners()]


def _disc(x: float, y: float, z: float, radius: float, colour: Colour) -> Face:
    side = 2 * radius
    return Face((x - radius, y - radius, z), (side, 0.0, 0.0), (0.0, side, 0.0), colour, outline="ellipse")


def _way(start: Point, end: Point) -> tuple[float, float, float]:
    return (end[0] - start[0], end[1] - start[1], 0.0)


def _triangle(p: Point, q: Point, r: Point, z: float, colour: Colour) -> Face:
    return Face((*p, z), _way(p, q), _way(p, r), colour, outline="triangle")


def _triangles(corners: Sequence[Point]) -> Iterator[tuple[Point, Point, Point]]:
    for part in convex_parts(corners):
        yield from ((part[0], q, r) for q, r in pairwise(part[1:]))
