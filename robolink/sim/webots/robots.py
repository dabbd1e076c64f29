"""Converter of Webots robots: outline, limits, wheels and sensors."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

import msgspec
import numpy as np

from robolink.sim.checks.robots import robot_problems
from robolink.sim.description import Drive, GroundTruth, Odom, RobotDescription, Shape, Wheel
from robolink.sim.quantities import Pose
from robolink.sim.sensors import Encoders
from robolink.sim.webots.footprint import Footprint, footprint, merged
from robolink.sim.webots.geometry import HEIGHTS, ORIGIN, Part, Placement, first_colour, rounded, turned
from robolink.sim.webots.scene_tree import GROUPS, JOINTS, SOLIDS, Found, inside, mass
from robolink.sim.webots.sensors import by_lookup_table, lacking, rate_near, sensors
from robolink.sim.webots.vrml_node import Node
from robolink.sim.webots.wheels import SPEEDS, heading, listed, motors, resolutions, strangers, wheels
from robolink.text.names import spelled, unlike

NO_SHAPE = 0.1
"""Radius of a robot without any shape, in metres."""

NARROWEST = 0.01
"""Least distance of a robot's outline from its origin, in metres."""


class Converted(NamedTuple):
    """A converted robot, its height in metres, and notes about it."""

    description: RobotDescription
    height: float
    notes: list[str]


class Pieces(NamedTuple):
    """Parts and nodes of a robot, in its own frame."""

    parts: list[Part]
    nodes: list[tuple[Node, Placement]]

    @property
    def outline(self) -> Footprint:
        """The outline of all parts from above."""
        whole = merged([each for part in self.parts if (each := footprint(part, -math.inf, math.inf))])
        return whole or Footprint(np.empty((0, 2)), (0.0, 0.0, NO_SHAPE))

    @property
    def height(self) -> float:
        """Height from the lowest to the highest point, in metres."""
        return max((each.top for each in self.parts), default=0.0) - min(
            (each.bottom for each in self.parts), default=0.0
        )

    @property
    def devices(self) -> list[tuple[Node, Placement]]:
        """Nodes of its sensors and other devices."""
        return [each for each in self.nodes if each[0].type not in JOINTS | GROUPS | {"Robot", "Solid", "Shape"}]


def robot(
    found: Found, node: Node, placement: Placement, taken: Sequence[str], dt: float, floor: float = 0.0
) -> Converted | None:
    """Convert a robot; None for one without shape and motors, which only looks on.

    `taken` are the names of other robots, `dt` is the world's step in seconds, `floor` the height of the floor in
    metres. A robot whose wheels roll to its side is turned round: ahead is where they roll to.
    """
    pieces = _pieces(found, node, ORIGIN)
    if not pieces.parts and not motors(found, pieces.nodes):
        return None
    turn = heading([each.wheel for each in motors(found, pieces.nodes) if each.wheel])
    pieces = _pieces(found, node, turned(-turn)) if turn else pieces
    pose = placement.pose
    pose = Pose(pose.x, pose.y, math.remainder(pose.theta + turn, math.tau))
    description, notes = _described(found, node, pieces, pose, dt, float(placement.offset[2]) - floor)
    name, asked = unlike(description.name, taken), node.text("name", "robot")
    if name != asked:
        notes.insert(0, f"this is how the robot '{asked}' is called here")
    return Converted(msgspec.structs.replace(description, name=name), pieces.height, [f"{name}: {n}" for n in notes])


def _pieces(found: Found, node: Node, frame: Placement) -> Pieces:
    return Pieces(list(found.parts(node, frame, nested=True)), list(_descend(node, frame)))


def _descend(node: Node, outer: Placement) -> Iterator[tuple[Node, Placement]]:
    """Yield all solids, devices and joints of a robot, each with the placement of its own axes."""
    for field in ("children", "endPoint"):
        for child in node.nodes(field) if field in node.fields else ():
            inner = inside(child, outer)
            yield child, inner
            if child.type in GROUPS | JOINTS | SOLIDS:
                yield from _descend(child, inner)


def _described(
    found: Found, node: Node, pieces: Pieces, pose: Pose, dt: float, raised: float
) -> tuple[RobotDescription, list[str]]:
    for device in strangers(pieces.nodes):
        found.note_unknown(device)
    shape = _shape(pieces.outline)
    turning, notes = wheels(motors(found, pieces.nodes), pieces.outline)
    description = RobotDescription(
        spelled(node.text("name", "robot"), "robot"),
        pose,
        shape=shape,
        mass=_mass(found, node, pieces),
        drive=_drive(turning, shape, dt),
        wheels=turning,
        odom=Odom(rate=rate_near(50.0, dt)),
        ground_truth=GroundTruth(rate=rate_near(10.0, dt)),
        sensors=sensors(pieces.devices, resolutions(pieces.nodes) if turning else [], dt, raised),
        height=min(max(rounded(pieces.height), HEIGHTS[0]), HEIGHTS[1]) if pieces.parts else None,
        colour=first_colour(node),
    )
    description, more = _without_bad_wheels(description, dt)
    return description, [*notes, *more, *_missing(description, [each for each, _ in pieces.devices])]


def _shape(outline: Footprint) -> Shape:
    """Make the robot's shape; a circle about its origin if that lies at its edge or outside."""
    shape = outline.about(Pose(0.0, 0.0))
    return shape if shape.inner_radius() > NARROWEST else Shape(circle=max(shape.outer_radius(), NARROWEST))


def _mass(found: Found, node: Node, pieces: Pieces) -> float:
    """Return the mass in kg of all nodes with physics; the simulator's default if there are none."""
    solids = [(node, ORIGIN), *(each for each in pieces.nodes if each[0].type in SOLIDS)]
    total = sum(mass(each, list(found.parts(each, inner))) for each, inner in solids if each.nodes("physics"))
    return min(total, 100_000.0) or RobotDescription("robot", Pose(0.0, 0.0)).mass


def _drive(wheels: Sequence[Wheel], shape: Shape, dt: float) -> Drive:
    """Return the drive with the limits that the wheels set: the fastest of them, and turning on the spot."""
    reach = shape.inner_radius() / dt
    if not wheels:
        return _slow(Drive(v_max=min(Drive().v_max, reach)), shape, dt)
    v_max = max(each.radius * each.speed_max for each in wheels)
    arm = max(math.hypot(each.at.x, each.at.y) for each in wheels)
    parallel = len({round(abs(math.sin(each.at.theta)), 1) for each in wheels}) == 1 and heading(wheels) == 0.0
    kind: Literal["diff", "omni"] = "diff" if parallel else "omni"
    w_max = min(v_max / max(arm, 0.01), 1.5 / dt)
    return _slow(Drive(kind, v_max=_limited(min(v_max, reach)), w_max=_limited(w_max)), shape, dt)


def _slow(drive: Drive, shape: Shape, dt: float) -> Drive:
    """Lower both speed limits of a robot whose corners could pass through a wall in one step."""
    inner = shape.inner_radius()
    farthest = (drive.v_max + drive.w_max * (shape.outer_radius() - inner)) * dt
    share = min(1.0, (1.0 - 1e-9) * inner / farthest)
    return msgspec.structs.replace(drive, v_max=drive.v_max * share, w_max=drive.w_max * share) if share < 1 else drive


def _limited(value: float) -> float:
    return min(max(value, SPEEDS[0]), SPEEDS[1])


def _without_bad_wheels(description: RobotDescription, dt: float) -> tuple[RobotDescription, list[str]]:
    """Remove the wheels of a robot that they cannot drive; cmd_vel still can."""
    found = [each.message for each in robot_problems(description, dt) if each.path.startswith(".wheels")]
    if not found:
        return description, []
    drive = msgspec.structs.replace(description.drive, type="diff")
    others = tuple(each for each in description.sensors if not isinstance(each, Encoders))
    description = msgspec.structs.replace(description, wheels=(), drive=drive, sensors=others)
    return description, [f"its motors are left out: {found[0]}"]


def _missing(description: RobotDescription, nodes: Sequence[Node]) -> Iterator[str]:
    """Yield notes of what the robot lacks."""
    if not description.wheels:
        yield "no motor turns its wheels, only cmd_vel drives it"
    if left_out := lacking(nodes):
        yield f"left out: {', '.join(left_out)}"
    if others := by_lookup_table(nodes):
        yield f"metres, not what the lookupTable says, come from {listed(others)}"
