"""Visitor of a Webots scene tree: collects solid things, arenas, robots, and unknown nodes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from robolink.sim.description import MOST_OBSTACLES, MOST_ROBOTS
from robolink.sim.quantities import FARTHEST
from robolink.sim.webots.geometry import Part, Placement, box, colour_of_look, colour_of_shape, part
from robolink.sim.webots.sensors import LIDARS
from robolink.sim.webots.vrml_node import KNOWN_FIELDS, Node

DENSITY = 1000.0
"""Default density of a solid with physics, in kg/m³, as in Webots."""

LIGHTEST, HEAVIEST = 0.001, 100_000.0
"""Least and greatest mass of a thing, in kg."""

CIRCLE_SIDES, FEWEST_SIDES = 48, 8
"""Default number of walls of a round arena, and their least number, as in Webots."""

GROUPS = frozenset({"Billboard", "Group", "Pose", "Slot", "Transform"})
JOINTS = frozenset({"BallJoint", "Hinge2Joint", "HingeJoint", "SliderJoint"})
DEVICES = frozenset(
    {"Accelerometer", "Altimeter", "Camera", "Compass", "Connector", "Display", "DistanceSensor", "Emitter", "GPS"}
    | {"Gyro", "InertialUnit", "LED", "Lidar", "LightSensor", "Pen", "Radar", "RangeFinder", "Receiver", "Speaker"}
    | {"TouchSensor", "VacuumGripper"}
)
SOLIDS = DEVICES | {"Charger", "Robot", "Solid", "Track", "TrackWheel"}
IGNORED = frozenset(
    {"Background", "DirectionalLight", "Floor", "Fluid", "Fog", "Muscle", "PointLight", "Propeller", "Skin"}
    | {"SolidReference", "SpotLight", "TexturedBackground", "TexturedBackgroundLight", "Viewpoint", "WorldInfo"}
)
"""Node types that make no difference to a flat world."""

SOLID_BOX = 2.0
"""Default size of a SolidBox."""

STANDING_BOXES = {"Wall": (0.2, 1.0, 2.4), "Window": (0.2, 0.8, 2.4)}
"""Boxes of Webots' library that stand on their own origin, and their default sizes."""


class Container(NamedTuple):
    """Box of Webots' library: longest side, greatest mass of a cubic metre, and volumes that it may have."""

    longest: float
    heaviest: float
    volumes: tuple[float, float] = (0.0, math.inf)


CONTAINERS = {"CardboardBox": Container(2.5, 100.0, (1e-6, 1.0)), "WoodenBox": Container(3.0, 1000.0)}
"""Boxes about their own middle whose PROTOs bring sizes and masses into range."""

CONTAINER_SIDE, SHORTEST = 0.6, 0.01
"""Default and least length of a side of a container."""

RAISED = {"CardboardBox": (0.0, 0.0, 0.3), "WoodenBox": (0.0, 0.0, 0.3), "SolidBox": (0.0, 0.0, 1.0)}
"""Default translations of boxes that are not at the origin."""


class Thing(NamedTuple):
    """Something solid: its pieces, its mass in kg (None: it never moves), and the node that it comes from."""

    parts: list[Part]
    mass: float | None
    node: Node


class Arena(NamedTuple):
    """Walls around a floor: the corners of their inner faces in the plane, their heights, node and colour."""

    corners: list[tuple[float, float]]
    height: tuple[float, float]
    node: Node
    colour: str | None = None


class Found:
    """The content of a world; `unknown` counts, by type, the nodes that are not supported."""

    def __init__(self, nodes: list[Node], world: Placement) -> None:
        self.things: list[Thing] = []
        self.arenas: list[Arena] = []
        self.robots: list[tuple[Node, Placement]] = []
        self.floors: list[float] = []
        self.floor_colour: str | None = None
        self.unknown: dict[str, int] = {}
        self.information = next((node for node in nodes if node.type == "WorldInfo"), None)
        for node in nodes:
            self._visit(node, world)

    def _visit(self, node: Node, outer: Placement) -> None:
        if len(self.things) > MOST_OBSTACLES or len(self.robots) > MOST_ROBOTS:
            most = f"{MOST_OBSTACLES:,} solids" if len(self.things) > MOST_OBSTACLES else f"{MOST_ROBOTS:,} robots"
            raise node.error(f"more than {most}: the world is too large")
        if node.type == "Robot":
            self.robots.append((node, outer.inside(node)))
        elif node.type in _LIBRARY:
            _LIBRARY[node.type](self, node, outer.inside(node, RAISED.get(node.type, (0.0, 0.0, 0.0))))
        elif node.type in SOLIDS:
            self._solid(node, outer.inside(node))
        elif node.type == "Shape":
            self.things += [Thing([each], None, node) for each in self.parts(node, outer)]
        elif node.type in GROUPS | JOINTS:
            for child, placement in contents(node, inside(node, outer)):
                self._visit(child, placement)
        else:
            self.note_unknown(node)

    def _solid(self, node: Node, inner: Placement) -> None:
        """Add a solid; what is fixed to one that moves belongs to it."""
        if node.node("physics"):
            parts = list(self.parts(node, inner, nested=True))
            self.things.append(Thing(parts, mass(node, parts), node))
            return
        self.things += [Thing([each], None, node) for each in self.parts(node, inner)]
        for child, placement in contents(node, inner):
            if child.type != "Shape":
                self._visit(child, placement)

    def parts(self, node: Node, inner: Placement, *, nested: bool = False) -> Iterator[Part]:
        """Yield the pieces of a node whose own axes are at `inner`; with `nested` those of the solids in it too.

        What a solid collides with, its `boundingObject`, counts; where there is none what one sees of it.
        """
        bounds = node.nodes("boundingObject") if node.type in SOLIDS else []
        for each in bounds or ([node] if node.type == "Shape" else []):
            yield from self._pieces(each, inner)
        for child, placement in contents(node, inner):
            if child.type == "Shape":
                yield from () if bounds else self._pieces(child, placement)
            elif nested and child.type in SOLIDS:
                yield from self.parts(child, placement.inside(child), nested=True)
            elif nested:
                self.note_unknown(child)

    def _pieces(self, node: Node, outer: Placement) -> Iterator[Part]:
        """Yield the pieces of shapes, of bare geometries, and of groups of them."""
        if node.type in GROUPS:
            for child, placement in contents(node, inside(node, outer)):
                yield from self._pieces(child, placement)
        elif node.type == "Shape":
            for geometry in node.nodes("geometry"):
                yield from (each._replace(colour=colour_of_shape(node)) for each in self._pieces(geometry, outer))
        elif node.type not in IGNORED:
            try:
                piece = part(node, outer)
            except KeyError as error:
                self.note_unknown(node, str(error.args[0]))
            else:
                yield from () if piece is None else (piece,)

    def note_unknown(self, node: Node, name: str = "") -> None:
        """Count a node that is not supported."""
        if node.type not in IGNORED and node.type not in LIDARS:
            name = name or node.type
            self.unknown[name] = self.unknown.get(name, 0) + 1


def inside(node: Node, outer: Placement) -> Placement:
    """Return the placement of a node's own axes; a joint or slot has none of its own."""
    return outer if node.type in JOINTS or node.type == "Slot" else outer.inside(node)


def contents(node: Node, inner: Placement) -> Iterator[tuple[Node, Placement]]:
    """Yield the content of a node whose own axes are at `inner`, through groups and joints, each with its placement."""
    for field in ("children", "endPoint"):
        for child in node.nodes(field) if field in node.fields else ():
            if child.type in GROUPS | JOINTS:
                yield from contents(child, inside(child, inner))
            else:
                yield child, inner


def mass(node: Node, parts: list[Part]) -> float:
    """Return the mass in kg that a solid's physics states, or that follows from its volume."""
    physics = node.node("physics")
    stated = physics.number("mass", -1.0) if physics else -1.0
    density = physics.number("density", DENSITY) if physics else DENSITY
    volume = sum(each.volume for each in parts)
    found = stated if stated > 0.0 else volume * (density if density > 0.0 else DENSITY)
    return min(max(found, LIGHTEST), HEAVIEST)


def _solid_box(found: Found, node: Node, inner: Placement) -> None:
    if not node.truth("enableBoundingObject", True):
        return  # one sees it, and nothing collides with it
    piece = box(node.lengths("size", SOLID_BOX, SOLID_BOX, SOLID_BOX), inner)._replace(colour=_library_colour(node))
    weight = mass(node, [piece]) if node.nodes("physics") else None
    found.things.append(Thing([piece], weight, node))


def _container(found: Found, node: Node, inner: Placement) -> None:
    """A wooden or cardboard box: its PROTO clamps the size, and the mass by the volume."""
    kind, default = CONTAINERS[node.type], 3 * (CONTAINER_SIDE,)
    stated = sides = node.lengths("size", *default)
    volume = math.prod(stated)
    if not kind.volumes[0] <= volume <= kind.volumes[1]:
        sides = default
    sides = tuple(min(max(each, SHORTEST), kind.longest) for each in sides)
    if sides != stated:
        node.note(f"the PROTO does not take this; {' '.join(f'{each:g}' for each in sides)} is used", "size")
    weight = node.number("mass", 0.0)
    lightest = volume ** (2 / 3)
    if weight > 0.0 and not lightest <= weight <= kind.heaviest * lightest:
        weight = min(max(weight, lightest), kind.heaviest * lightest)
        node.note(f"the PROTO does not take this; {weight:.3g} is used", "mass")
    found.things.append(
        Thing([box(sides, inner)], min(max(weight, LIGHTEST), HEAVIEST) if weight > 0.0 else None, node)
    )


def _standing_box(found: Found, node: Node, inner: Placement) -> None:
    sides = node.lengths("size", *STANDING_BOXES[node.type])
    found.things.append(Thing([box(sides, inner, raised=True)._replace(colour=_library_colour(node))], None, node))


def _library_colour(node: Node) -> str | None:
    """Return the colour of a thing of Webots' library, if its appearance has one."""
    return colour_of_look(node.node("wallAppearance" if node.type == "Window" else "appearance"))


def _floor(found: Found, node: Node, inner: Placement) -> None:
    found.floors.append(float(inner.offset[2]))
    found.floor_colour = found.floor_colour or colour_of_look(node.node("appearance"))


def _rectangle_arena(found: Found, node: Node, inner: Placement) -> None:
    x, y = (side / 2 for side in node.lengths("floorSize", 1.0, 1.0))
    _arena(found, node, inner, [(x, y), (-x, y), (-x, -y), (x, -y)])


def _circle_arena(found: Found, node: Node, inner: Placement) -> None:
    radius, sides = node.length("radius", 1.0), int(node.number("subdivision", CIRCLE_SIDES))
    if sides <= FEWEST_SIDES:
        sides = FEWEST_SIDES
    sides = min(sides, 360)
    turns = [math.tau * each / sides for each in range(sides)]
    _arena(found, node, inner, [(radius * math.cos(turn), radius * math.sin(turn)) for turn in turns])


def _arena(found: Found, node: Node, inner: Placement, corners: list[tuple[float, float]]) -> None:
    placed = [inner.matrix @ (x, y, 0.0) + inner.offset for x, y in corners]
    if max(abs(float(each)) for corner in placed for each in corner) > FARTHEST:
        raise node.error(f"this reaches beyond {FARTHEST / 1000:g} km")
    floor = float(inner.offset[2])
    found.floors.append(floor)
    found.floor_colour = found.floor_colour or colour_of_look(node.node("floorAppearance"))
    height = (floor, floor + node.length("wallHeight", 0.1))
    colour = colour_of_look(node.node("wallAppearance"))
    found.arenas.append(Arena([(float(x), float(y)) for x, y, _ in placed], height, node, colour))


_LIBRARY: dict[str, Callable[[Found, Node, Placement], None]] = {
    **dict.fromkeys(CONTAINERS, _container),
    **dict.fromkeys(STANDING_BOXES, _standing_box),
    "CircleArena": _circle_arena,
    "Floor": _floor,
    "RectangleArena": _rectangle_arena,
    "SolidBox": _solid_box,
}
"""The PROTOs of Webots' library whose geometry is plain."""

KNOWN_TYPES = frozenset(_LIBRARY) | frozenset(KNOWN_FIELDS) | SOLIDS | GROUPS | JOINTS | IGNORED | frozenset(LIDARS)
"""Types of nodes that are read without their definition, or that make no difference."""
