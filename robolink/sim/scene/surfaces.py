"""Coloured surfaces of a world: planar faces, upright cylinders and the floor, as plain data for a renderer.

Lengths are in metres, and z is the height above the floor. A colour is red, green, blue, 0 to 255 each, as it looks in
white light: shading is a renderer's business.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias

from robolink.sim.colours import Colour

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

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
