"""Patches: pictures on surfaces in space, with mipmaps, as a camera sees them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from robolink.geometry.trigonometry import cos_and_sin, cos_and_sin_of
from robolink.sim.rendering.pinhole import Array, Bytes, Indices, Packed, cross, dot, packed
from robolink.sim.scene.solids import Cylinder, Face, Picture, Surfaces

_SMALLEST = 4
"""Smallest side in pixels of a level that is halved again."""


class Level:
    """One resolution of a picture, packed, with a border; pixel i, j of it is `flat[(i + 1) * stride + j + 1]`.

    Args:
        picture: The picture at this resolution.
        scale: Pixels of it for each of the full picture's, along a side.
        border: Packed colour around it; None repeats its edge.
    """

    def __init__(self, picture: Bytes, scale: float, border: int | None) -> None:
        self.scale, (self.rows, self.columns) = scale, picture.shape[:2]
        whole = np.pad(packed(picture), 1, mode="edge")
        if border is not None:
            whole[0], whole[-1], whole[:, 0], whole[:, -1] = (border,) * 4
        self.flat: Packed = whole.reshape(-1)
        self.stride = self.columns + 2


def mipmaps(picture: Bytes, border: int | None = None) -> list[Level]:
    """Return the levels of a picture (rows, columns, 3), the finest first; `border` is that of `Level`."""
    levels = [Level(picture, 1.0, border)]
    while min(picture.shape[:2]) > _SMALLEST:
        picture = _halved(picture)
        levels.append(Level(picture, levels[-1].scale / 2, border))
    return levels


def _halved(picture: Bytes) -> Bytes:
    """Return the means of two by two pixels; an odd last row or column counts twice."""
    rows, columns = picture.shape[:2]
    even = np.pad(picture, ((0, rows % 2), (0, columns % 2), (0, 0)), mode="edge").astype(np.uint16)
    total = even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]
    return ((total + 2) >> 2).astype(np.uint8)


FIXED = -1
"""Owner of what does not move."""

PARALLELOGRAM, ELLIPSE, TRIANGLE = range(3)
_OUTLINES = {"parallelogram": PARALLELOGRAM, "ellipse": ELLIPSE, "triangle": TRIANGLE}

_LIGHT = np.array(((0.5,), (0.3,), (0.8,))) / (0.5 * 0.5 + 0.3 * 0.3 + 0.8 * 0.8) ** 0.5
_MANY = 16
"""Number of angles from which on an array is quicker than one after the other."""

_DARKEST = 0.7
"""Brightness of a face along which the light goes, as a share of that of one that faces it."""


class Patches(NamedTuple):
    """Patches as arrays: corner, sides a and b of shape (3, n), colours (n, 3), and for each outline and owner.

    `textured` is the number of each one's texture, or -1; `shades` are the colours as they look in the light.
    """

    corner: Array
    a: Array
    b: Array
    colours: Bytes
    outline: Indices
    owner: Indices
    textured: Indices
    shades: Packed


class Cylinders(NamedTuple):
    """Cylinders as arrays (n): axis, radius, lower and upper end; colours (n, 3); and the owner of each."""

    x: Array
    y: Array
    radius: Array
    low: Array
    high: Array
    colours: Bytes
    owner: Indices


class Textures:
    """Textures of patches by number; -1 has none. Pictures that are the same object are one texture."""

    def __init__(self) -> None:
        self._pictures: list[Picture] = []
        self._numbers: dict[int, int] = {}
        self._levels: dict[int, list[Level]] = {}

    def number(self, picture: Picture | None) -> int:
        """Return the number of a picture, a new one if it has not been seen before; -1 for None."""
        if picture is None:
            return -1
        if id(picture) not in self._numbers:
            self._numbers[id(picture)] = len(self._pictures)
            self._pictures.append(picture)
        return self._numbers[id(picture)]

    def levels(self, number: int) -> list[Level]:
        """Return the mipmaps of a texture, made once it is seen."""
        if number not in self._levels:
            self._levels[number] = mipmaps(self._pictures[number])
        return self._levels[number]


def patches_of(things: Sequence[tuple[int, Surfaces]], textures: Textures) -> Patches:
    """Return the faces of things, each with its owner, as arrays; new textures are added to `textures`."""
    faces: list[tuple[int, Face]] = [(owner, face) for owner, thing in things for face in thing.faces]
    corner, a, b = (
        np.array([face[side] for _, face in faces], dtype=np.float64).reshape(-1, 3).T.copy() for side in range(3)
    )
    return _shaded(
        Patches(
            corner,
            a,
            b,
            np.array([face.colour for _, face in faces], dtype=np.uint8).reshape(-1, 3),
            np.array([_OUTLINES[face.outline] for _, face in faces], dtype=np.intp),
            np.array([owner for owner, _ in faces], dtype=np.intp),
            np.array([textures.number(face.texture) for _, face in faces], dtype=np.intp),
            np.empty(0, dtype=np.uint32),
        )
    )


def cylinders_of(things: Sequence[tuple[int, Surfaces]]) -> Cylinders:
    """Return the cylinders of things, each with its owner, as arrays."""
    found: list[tuple[int, Cylinder]] = [(owner, each) for owner, thing in things for each in thing.cylinders]
    numbers = np.array([each[:5] for _, each in found], dtype=np.float64).reshape(-1, 5).T
    colours = np.array([each.colour for _, each in found], dtype=np.uint8).reshape(-1, 3)
    x, y, radius, low, high = numbers.copy()
    return Cylinders(x, y, radius, low, high, colours, np.array([owner for owner, _ in found], dtype=np.intp))


class Places:
    """Places of owners: rows x, y, heading; by these their surfaces get from their own frames into the world."""

    def __init__(self, rows: Array) -> None:
        self._x: Array = rows[:, 0]
        self._y: Array = rows[:, 1]
        angles: Array = rows[:, 2]
        if len(angles) < _MANY:
            self._cos, self._sin = np.array([cos_and_sin_of(each) for each in angles.tolist()]).reshape(-1, 2).T
        else:
            self._cos, self._sin = cos_and_sin(angles)

    def points(self, x: Array, y: Array, owner: Indices) -> tuple[Array, Array]:
        """Return points in the world."""
        along, across = self.directions(x, y, owner)
        return along + self._x.take(owner), across + self._y.take(owner)

    def directions(self, x: Array, y: Array, owner: Indices) -> tuple[Array, Array]:
        """Return directions in the world."""
        cos, sin = self._cos.take(owner), self._sin.take(owner)
        return cos * x - sin * y, sin * x + cos * y

    def patches(self, own: Patches) -> Patches:
        """Return patches of owners in the world."""
        x, y = self.points(own.corner[0], own.corner[1], own.owner)
        a, b = (np.stack((*self.directions(side[0], side[1], own.owner), side[2])) for side in (own.a, own.b))
        return _shaded(own._replace(corner=np.stack((x, y, own.corner[2])), a=a, b=b))

    def cylinders(self, own: Cylinders) -> Cylinders:
        """Return cylinders of owners in the world."""
        x, y = self.points(own.x, own.y, own.owner)
        return own._replace(x=x, y=y)


def _shaded(patches: Patches) -> Patches:
    """Return patches with their colours as they look in the light, which comes from above and aside."""
    normal = cross(patches.a, patches.b)
    length = np.sqrt(dot(normal, normal))
    facing = np.abs(dot(normal, np.broadcast_to(_LIGHT, normal.shape))) / np.maximum(length, 1e-12)
    brightness = _DARKEST + (1.0 - _DARKEST) * facing
    lit = (patches.colours * np.minimum(brightness, 1.0)[:, None] + 0.5).astype(np.uint8)
    return patches._replace(shades=packed(lit))


def joined(fixed: Patches, moving: Patches) -> Patches:
    """Return both as one."""
    return Patches(
        np.concatenate((fixed.corner, moving.corner), axis=1),
        np.concatenate((fixed.a, moving.a), axis=1),
        np.concatenate((fixed.b, moving.b), axis=1),
        np.concatenate((fixed.colours, moving.colours)),
        np.concatenate((fixed.outline, moving.outline)),
        np.concatenate((fixed.owner, moving.owner)),
        np.concatenate((fixed.textured, moving.textured)),
        np.concatenate((fixed.shades, moving.shades)),
    )


def joined_cylinders(fixed: Cylinders, moving: Cylinders) -> Cylinders:
    """Return both as one."""
    x, y, radius, low, high = (np.concatenate(both) for both in zip(fixed[:5], moving[:5], strict=True))
    colours = np.concatenate((fixed.colours, moving.colours))
    return Cylinders(x, y, radius, low, high, colours, np.concatenate((fixed.owner, moving.owner)))
