"""Solids of a scene, and their surfaces: colours and pictures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import cos, sin
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from robolink.geometry.plane import Pose
from robolink.sim.colours import Colour
from robolink.sim.description import Shape
from robolink.sim.physics.convex import convex_parts
from robolink.sim.quantities import Point

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


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


# Coloured surfaces of a world: planar faces, upright cylinders and the floor, as plain data for a renderer.
#
# Lengths are in metres, and z is the height above the floor. A colour is red, green, blue, 0 to 255 each, as it
# looks in white light: shading is a renderer's business.


Vector: TypeAlias = tuple[float, float, float]
"""A point or a direction in space: x, y, z in metres."""

Picture: TypeAlias = "npt.NDArray[np.uint8]"
"""Image of shape (rows, columns, 3): red, green, blue; read-only, and shared by all that show it."""

Outline: TypeAlias = Literal["parallelogram", "ellipse", "triangle"]
"""Part of a patch that is there: all of it, the ellipse inscribed in it, or its half with s + t at most 1."""


class Face(NamedTuple):
    """Planar patch: the points corner + s * a + t * b, with s and t from 0 to 1.

    A face of one colour is seen from both sides. One with a texture is seen only from the side where a leads to the
    right and b down (the cross product of a and b points away from the eye). It wins where a face without texture lies
    in the same plane, as a sign on its wall does.

    Args:
        corner: The point where s and t are 0.
        a: Side along s.
        b: Side along t.
        colour: Colour of a face without texture.
        texture: Picture on the face, or None; row 0 lies at t = 0, column 0 at s = 0.
        outline: The part of the patch that is there.
    """

    corner: Vector
    a: Vector
    b: Vector
    colour: Colour
    texture: Picture | None = None
    outline: Outline = "parallelogram"


class Cylinder(NamedTuple):
    """Side of an upright cylinder, without its lids, which are faces: axis at x, y, `radius`, from z0 up to z1."""

    x: float
    y: float
    radius: float
    z0: float
    z1: float
    colour: Colour


class Surfaces(NamedTuple):
    """Surfaces of one thing, in the frame of the thing (x ahead, z up, z = 0 on the floor) or in that of the world."""

    faces: tuple[Face, ...] = ()
    cylinders: tuple[Cylinder, ...] = ()


class Floor(NamedTuple):
    """Floor at z = 0, which has no end.

    Args:
        colour: Colour where there is no image.
        image: Picture of the floor, or None; row 0 has the lowest y, column 0 the lowest x.
        resolution: Side of a pixel in metres.
        origin: x and y of the outer corner of the first pixel of row 0.
    """

    colour: Colour
    image: Picture | None = None
    resolution: float = 0.01
    origin: tuple[float, float] = (0.0, 0.0)


class Scenery(NamedTuple):
    """All that can be seen of a world.

    Args:
        floor: The floor.
        sky: Colour where nothing is.
        fixed: Walls, signs and obstacles that never move, in the world's frame.
        movable: Surfaces of each obstacle that moves or can be pushed, in its own frame, by its place in the
            description's `obstacles`.
        robots: Surfaces of each robot, in its own frame, by its name.
    """

    floor: Floor
    sky: Colour
    fixed: Surfaces
    movable: dict[int, Surfaces]
    robots: dict[str, Surfaces]
