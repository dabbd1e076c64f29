"""Footprints of solid geometry: the outline from above of all that is between two heights."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.description import Shape, signed_area
from robolink.sim.quantities import FARTHEST, Point, Pose
from robolink.sim.webots.geometry import RIM, Part, rounded

FINE = 1e-4
"""Tolerance of a simplified outline, in metres."""


class Footprint(NamedTuple):
    """An outline in the plane: a convex polygon's corners, counter-clockwise, or a circle's centre and radius."""

    corners: Array
    circle: tuple[float, float, float] | None = None

    def placed(self) -> tuple[Shape, Pose]:
        """Return it as a shape about its own middle, and the pose of that."""
        if self.circle is not None:
            x, y, radius = map(rounded, self.circle)
            return Shape(circle=max(radius, 0.001)), Pose(x, y)
        x, y = map(rounded, self.corners.mean(axis=0))
        if rectangle := self._rectangle():
            length, width, theta = rectangle
            return Shape(box=(length, width)), Pose(x, y, theta)
        return self.about(Pose(x, y)), Pose(x, y)

    def about(self, origin: Pose) -> Shape:
        """Return it as a shape about another point."""
        if self.circle is not None and math.hypot(self.circle[0] - origin.x, self.circle[1] - origin.y) < FINE:
            return Shape(circle=max(rounded(self.circle[2]), 0.001))
        corners = self.outline() - (origin.x, origin.y)
        if rectangle := self._rectangle():
            length, width, theta = rectangle
            if np.abs(corners.mean(axis=0)).max() < FINE and abs(math.sin(2 * theta)) < FINE:
                return Shape(box=(length, width) if abs(math.cos(theta)) > 0.5 else (width, length))
        return Shape(polygon=tuple((rounded(x), rounded(y)) for x, y in corners))

    def outline(self) -> Array:
        """Return its corners; those of a circle are many."""
        if self.circle is None:
            return self.corners
        x, y, radius = self.circle
        return RIM[:, :2] * radius + (x, y)

    def _rectangle(self) -> tuple[float, float, float] | None:
        """Return length, width and heading of a rectangle; the heading is the one nearest to 0."""
        if len(self.corners) != 4:
            return None
        first, second = self.corners[1] - self.corners[0], self.corners[2] - self.corners[1]
        a, b = float(np.linalg.norm(first)), float(np.linalg.norm(second))
        apart = float(np.abs(self.corners[0] + self.corners[2] - self.corners[1] - self.corners[3]).max())
        if abs(float(first @ second)) > 1e-3 * a * b or apart > FINE:
            return None
        theta = math.atan2(first[1], first[0])
        quarters = round(theta / (math.pi / 2))
        length, width = (b, a) if quarters % 2 else (a, b)
        return rounded(length), rounded(width), rounded(theta - quarters * math.pi / 2)


def footprint(piece: Part, low: float, high: float) -> Footprint | None:
    """Return the outline, seen from above, of a part between two heights; None for nothing."""
    if piece.top <= low or piece.bottom >= high:
        return None
    if piece.radius:
        x, y, z = map(float, piece.points.mean(axis=0))
        above = max(low - z, z - high, 0.0) if piece.ball else 0.0
        radius = math.sqrt(max(piece.radius**2 - above**2, 0.0))
        return Footprint(np.empty((0, 2)), (x, y, min(radius, FARTHEST))) if radius >= 0.001 else None
    return _hulled(_cut(piece.points, low, high))


def merged(footprints: Sequence[Footprint]) -> Footprint | None:
    """Return one convex outline around several: the circle among them that holds all others, or their hull."""
    if len(footprints) < 2:
        return footprints[0] if footprints else None
    corners = np.concatenate([each.outline() for each in footprints])
    for x, y, radius in (each.circle for each in footprints if each.circle):
        if np.hypot(corners[:, 0] - x, corners[:, 1] - y).max() <= radius + 0.001:
            return Footprint(np.empty((0, 2)), (x, y, radius))
    return _hulled(corners)


def _cut(points: Array, low: float, high: float) -> Array:
    """Return the corners, from above, of a convex body between two heights."""
    z = points[:, 2]
    found = [points[(z >= low) & (z <= high)]]
    for height in (low, high):
        below, above = points[z < height], points[z > height]
        if len(below) and len(above):
            share = (height - below[:, None, 2]) / (above[None, :, 2] - below[:, None, 2])
            crossing = below[:, None] + share[..., None] * (above[None] - below[:, None])
            found.append(crossing.reshape(-1, 3))
    return np.concatenate(found)[:, :2]


def _hulled(points: Array) -> Footprint | None:
    """Return the convex hull of points in the plane; None if it is thinner than a millimetre."""
    near = np.clip(points, -FARTHEST / 2, FARTHEST / 2).tolist()
    ordered = sorted({(x, y) for x, y in near})
    corners = _simplified(_half(ordered) + _half(ordered[::-1]))
    if len(corners) < 3:
        return None
    longest = max(map(math.dist, corners, [*corners[1:], corners[0]]))
    area = signed_area(corners)
    return Footprint(np.array(corners)) if area >= 0.001 * longest and longest >= 0.001 else None


def _half(points: Sequence[Point]) -> list[Point]:
    """Return one half of a hull, without its last point (Andrew's monotone chain)."""
    found: list[Point] = []
    for point in points:
        while len(found) > 1 and _cross(found[-2], found[-1], point) <= 0.0:
            found.pop()
        found.append(point)
    return found[:-1]


def _simplified(corners: list[Point]) -> list[Point]:
    """Leave out corners that are nearly on the line between their neighbours."""
    found = list(corners)
    index = 0
    while index < len(found) and len(found) > 3:
        before, here, after = found[index - 1], found[index], found[(index + 1) % len(found)]
        if _cross(before, here, after) < FINE * max(math.dist(before, after), FINE):
            found.pop(index)
        else:
            index += 1
    return found


def _cross(first: Sequence[float], second: Sequence[float], third: Sequence[float]) -> float:
    return (second[0] - first[0]) * (third[1] - first[1]) - (second[1] - first[1]) * (third[0] - first[0])
