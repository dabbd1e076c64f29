"""Solid geometry in space: placements of nodes, the parts that their shapes stand for, and outlines from above."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.colours import hex_of
from robolink.sim.description import Shape, signed_area
from robolink.sim.quantities import FARTHEST, Point, Pose
from robolink.sim.webots.vrml_node import Node

DEEPEST = 12
"""Most groups, joints and solids inside of each other that are searched for a shape with a colour."""

LEVEL = 0.01
"""Largest lean that counts as upright, in radians: editors save angles with such errors."""

SIDES = 32
"""Number of corners of a circle that is not seen from above."""

HEIGHTS = (0.001, 1000.0)
"""Least and greatest height of a thing in a world file, in metres."""

MOST_POINTS = 500
"""Most corners of a mesh; one with more is made for the eye, not for collisions."""

_TURNS = np.linspace(0.0, math.tau, SIDES, endpoint=False)

RIM = np.column_stack((np.cos(_TURNS), np.sin(_TURNS), np.zeros(SIDES)))

_CUBE = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])

FINE = 1e-4
"""Tolerance of a simplified outline, in metres."""


def colour_of_look(look: Node | None) -> str | None:
    """Return the colour of an appearance: `diffuseColor` or `baseColor`; None for none, and for one with a texture."""
    if look is None:
        return None
    if look.type == "PBRAppearance":
        return None if look.nodes("baseColorMap") else _text(look, "baseColor", 1.0)
    material = look.node("material") if look.type == "Appearance" else None
    return None if material is None or look.nodes("texture") else _text(material, "diffuseColor", 0.8)


def colour_of_shape(shape: Node) -> str | None:
    """Return the colour of a Shape, or None."""
    return colour_of_look(shape.node("appearance")) if "appearance" in shape.fields else None


def first_colour(node: Node) -> str | None:
    """Return the colour of the first shape in a node that has one, or None."""
    return next((found for shape in _shapes(node, DEEPEST) if (found := colour_of_shape(shape))), None)


def _shapes(node: Node, depth: int) -> Iterator[Node]:
    if node.type == "Shape":
        yield node
        return
    for field in ("children", "endPoint") if depth else ():
        for child in node.nodes(field) if field in node.fields else ():
            yield from _shapes(child, depth - 1)


def _text(node: Node, field: str, default: float) -> str:
    red, green, blue = (
        round(255 * min(max(each, 0.0), 1.0)) for each in node.numbers(field, default, default, default)
    )
    return hex_of((red, green, blue))


def rounded(value: float) -> float:
    """Return a length or angle without rounding errors, and without a minus before 0."""
    return round(float(value), 9) + 0.0


class Placement(NamedTuple):
    """An affine transformation to the world: a point p of a node is at `matrix` p + `offset`."""

    matrix: Array
    offset: Array

    def inside(self, node: Node, translation: Sequence[float] = (0.0, 0.0, 0.0)) -> Placement:
        """Return the placement of a node's content; `translation` is the default of that field."""
        matrix = rotation(node) * np.array(node.lengths("scale", 1.0, 1.0, 1.0))
        offset = self.at(np.array(node.numbers("translation", *translation)))
        if not np.all(np.abs(offset) <= FARTHEST):
            raise node.error(f"this is more than {FARTHEST / 1000:g} km away", "translation")
        matrix = _levelled(self.matrix @ matrix)
        if not np.all(np.abs(matrix) <= FARTHEST):
            raise node.error(f"this makes things more than {FARTHEST:g} times as large", "scale")
        return Placement(matrix, offset)

    def at(self, points: Array) -> Array:
        """Return the places of points of the node."""
        there: Array = points @ self.matrix.T + self.offset
        return there

    @property
    def pose(self) -> Pose:
        """The placement seen from above."""
        x, y, _ = self.offset
        return Pose(rounded(x), rounded(y), rounded(math.atan2(self.matrix[1, 0], self.matrix[0, 0])))


ORIGIN = Placement(np.eye(3), np.zeros(3))

WORLDS = {
    "ENU": ORIGIN,
    "NUE": Placement(np.array([(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]), np.zeros(3)),
    "EUN": Placement(np.array([(1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)]), np.zeros(3)),
}
"""Placements of Webots' worlds by their `coordinateSystem`, which says which way x, y and z point; here z is up."""


def turned(angle: float) -> Placement:
    """Return the placement of something at the origin that is turned about z by `angle` radians."""
    cos, sin = math.cos(angle), math.sin(angle)
    return Placement(np.array([(cos, -sin, 0.0), (sin, cos, 0.0), (0.0, 0.0, 1.0)]), np.zeros(3))


def rotation(node: Node) -> Array:
    """Return the matrix of a node's rotation, an axis and an angle; an axis without length turns nothing."""
    x, y, z, angle = node.numbers("rotation", 0.0, 0.0, 1.0, 0.0)
    length = math.hypot(x, y, z)
    if length < 1e-12:
        return np.eye(3)
    axis = np.array((x, y, z)) / length
    cross = np.cross(np.eye(3), axis)
    turned: Array = np.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * (cross @ cross)
    return turned


def _levelled(matrix: Array) -> Array:
    """Make axes that are nearly upright or nearly level exactly so."""
    limit = LEVEL * np.linalg.norm(matrix, axis=0)
    found: Array = matrix.copy()
    found[2, np.abs(matrix[2]) < limit] = 0.0
    found[:2, np.hypot(matrix[0], matrix[1]) < limit] = 0.0
    return found


class Part(NamedTuple):
    """A piece of something solid, in space.

    `points` are the corners of its convex hull; with a `radius` they are the ends of an upright cylinder's axis, or
    the centre of a ball. `volume` is in m³, `colour` that of the shape that it belongs to.
    """

    points: Array
    volume: float
    radius: float = 0.0
    ball: bool = False
    colour: str | None = None

    @property
    def bottom(self) -> float:
        """Its least height."""
        return float(self.points[:, 2].min()) - (self.radius if self.ball else 0.0)

    @property
    def top(self) -> float:
        """Its greatest height."""
        return float(self.points[:, 2].max()) + (self.radius if self.ball else 0.0)

    def farthest(self, centre: Array, axis: Array) -> float:
        """Return the distance of its farthest point from a line."""
        if self.ball:
            return self.radius + _from_line(self.points, centre, axis)
        if self.radius:
            ends = [point + self.radius * RIM for point in self.points]
            return max(_from_line(end, centre, axis) for end in ends)
        return _from_line(self.points, centre, axis)


def _from_line(points: Array, centre: Array, axis: Array) -> float:
    return float(np.linalg.norm(np.cross(points - centre, axis), axis=1).max())


def part(geometry: Node, placement: Placement) -> Part | None:
    """Make the part that a geometry node stands for, or None where it has no extent.

    Raises `KeyError` for a node that is not a geometry known here, and `DocumentError` for impossible sizes.
    """
    return _GEOMETRIES[geometry.type](geometry, placement)


def _scaled(volume: float, placement: Placement) -> float:
    return volume * abs(float(np.linalg.det(placement.matrix)))


def box(sides: Sequence[float], placement: Placement, *, raised: bool = False) -> Part:
    """Make a box about the placement's origin, or one that stands on it."""
    corners = (_CUBE + np.array((0.0, 0.0, 0.5 if raised else 0.0))) * np.array(sides)
    return Part(placement.at(corners), _scaled(math.prod(sides), placement))


def _upright(placement: Placement) -> float:
    """Return the scale of a shape that is round about z and stays so, seen from above; 0 if it does not."""
    matrix = placement.matrix
    across, along = matrix[:2, :2], matrix[2, :2]
    scale = math.hypot(matrix[0, 0], matrix[1, 0])
    if np.abs(along).max() > 0.0 or np.abs(matrix[:2, 2]).max() > 0.0:
        return 0.0
    return scale if np.abs(across.T @ across - scale**2 * np.eye(2)).max() < 1e-3 * scale**2 else 0.0


def cylinder(radius: float, height: float, placement: Placement, volume: float) -> Part:
    """Make a part that is round about the placement's z axis, `height` high."""
    if scale := _upright(placement):
        ends = placement.at(np.array([(0.0, 0.0, -height / 2), (0.0, 0.0, height / 2)]))
        return Part(ends, _scaled(volume, placement), radius * scale)
    rims = [RIM * radius + (0.0, 0.0, z) for z in (-height / 2, height / 2)]
    return Part(placement.at(np.concatenate(rims)), _scaled(volume, placement))


def _box(node: Node, placement: Placement) -> Part:
    return box(node.lengths("size", 2.0, 2.0, 2.0), placement)


def _cylinder(node: Node, placement: Placement) -> Part:
    radius, height = node.length("radius", 1.0), node.length("height", 2.0)
    return cylinder(radius, height, placement, math.pi * radius**2 * height)


def _capsule(node: Node, placement: Placement) -> Part:
    radius, height = node.length("radius", 1.0), node.length("height", 2.0)
    volume = math.pi * radius**2 * (height + 4 / 3 * radius)
    return cylinder(radius, height + 2 * radius, placement, volume)


def _cone(node: Node, placement: Placement) -> Part:
    radius, height = node.length("bottomRadius", 1.0), node.length("height", 2.0)
    corners = np.vstack((RIM * radius - (0.0, 0.0, height / 2), [(0.0, 0.0, height / 2)]))
    return Part(placement.at(corners), _scaled(math.pi * radius**2 * height / 3, placement))


def _sphere(node: Node, placement: Placement) -> Part:
    """A ball; one that is stretched is seen as large as its greatest radius."""
    scale = float(np.linalg.norm(placement.matrix, axis=0).max())
    radius = node.length("radius", 1.0)
    return Part(placement.at(np.zeros((1, 3))), _scaled(4 / 3 * math.pi * radius**3, placement), radius * scale, True)


def _mesh(node: Node, placement: Placement) -> Part | None:
    """The convex hull of a mesh; its volume is that of the box around it."""
    coordinates = node.node("coord")
    numbers = coordinates.all_numbers("point") if coordinates else []
    points = np.array(numbers[: len(numbers) // 3 * 3]).reshape(-1, 3)
    if coordinates is not None and len(points) > MOST_POINTS:
        raise KeyError(f"{node.type} of {len(points)} points")
    if len(points) < 3:
        return None
    return Part(placement.at(points), _scaled(float(np.prod(np.ptp(points, axis=0))), placement))


def _nothing(node: Node, placement: Placement) -> None:
    """A plane is a floor, lines and points are thin air."""


_GEOMETRIES: dict[str, Callable[[Node, Placement], Part | None]] = {
    "Box": _box,
    "Cylinder": _cylinder,
    "Capsule": _capsule,
    "Cone": _cone,
    "Sphere": _sphere,
    "IndexedFaceSet": _mesh,
    "Plane": _nothing,
    "IndexedLineSet": _nothing,
    "PointSet": _nothing,
}


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
