"""Converter of Webots robots: outline, limits, wheels and sensors."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, NamedTuple

import msgspec
import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.checks.robots import robot_problems
from robolink.sim.description import Drive, GroundTruth, Odom, RobotDescription, Shape, Wheel
from robolink.sim.quantities import Pose
from robolink.sim.sensors import Encoders
from robolink.sim.webots.geometry import (
    HEIGHTS,
    LEVEL,
    ORIGIN,
    Footprint,
    Part,
    Placement,
    first_colour,
    footprint,
    merged,
    rounded,
    turned,
)
from robolink.sim.webots.scene_tree import GROUPS, JOINTS, SOLIDS, Found, inside, mass
from robolink.sim.webots.sensors import by_lookup_table, lacking, rate_near, sensors
from robolink.sim.webots.vrml_node import Node
from robolink.text.names import spelled, unlike

LEFT = ("left", "esq", "izq", "gauche", "links", "sinis")

RIGHT = ("right", "dir", "der", "droit", "rechts", "dest")
"""Beginnings of motor names for a side: English, Portuguese, Spanish, French, German, Italian."""

MOTOR_SPEED = 10.0
"""Webots' default `maxVelocity` of a motor, in rad/s."""

HELD = frozenset({"Brake", "LinearMotor", "PositionSensor", "RotationalMotor"})
"""Node types that may be the device of a joint."""

RADII = (0.01, 0.25)
"""Least and greatest radius of a wheel that a world says nothing about, in metres."""

SPEEDS = (0.001, 1000.0)

SAME = 0.02
"""Angle up to which directions count as equal, in radians."""

NO_SHAPE = 0.1
"""Radius of a robot without any shape, in metres."""

NARROWEST = 0.01
"""Least distance of a robot's outline from its origin, in metres."""


class Motor(NamedTuple):
    """A motor of a joint, and the wheel that it turns: None where the world does not say, or where it is none."""

    name: str
    speed_max: float
    wheel: Wheel | None
    is_vague: bool


def motors(found: Found, pieces: Iterable[tuple[Node, Placement]]) -> list[Motor]:
    """Return the motors of hinges among the pieces of a robot."""
    return [
        _motor(found, device, joint, placement)
        for joint, placement in pieces
        if joint.type in ("HingeJoint", "Hinge2Joint")
        for device in devices(joint)
        if device.type == "RotationalMotor"
    ]


def devices(joint: Node) -> list[Node]:
    """Return the motors and sensors of a joint."""
    return [each for field in ("device", "device2") if field in joint.fields for each in joint.nodes(field)]


def strangers(pieces: Iterable[tuple[Node, Placement]]) -> list[Node]:
    """Return the devices of joints that no joint can have: most are misspelt."""
    held = [device for node, _ in pieces if node.type in JOINTS for device in devices(node)]
    return [each for each in held if each.type not in HELD]


def resolutions(pieces: Iterable[tuple[Node, Placement]]) -> list[float]:
    """Return the resolution in radians of each position sensor, -1 for exact ones."""
    sensed = [device for node, _ in pieces if node.type in JOINTS for device in devices(node)]
    return [each.number("resolution", -1.0) for each in sensed if each.type == "PositionSensor"]


def wheels(found: Sequence[Motor], outline: Footprint) -> tuple[tuple[Wheel, ...], list[str]]:
    """Return the wheels, with those of joints without any geometry, and notes about them."""
    vague, notes = [each for each in found if each.is_vague], []
    if other := [each.name for each in found if each.wheel is None and not each.is_vague]:
        notes.append(f"left out, since it turns no wheel: {listed(other)}")
    assumed = _assumed(vague, outline)
    if assumed:
        where = f"radius {assumed[0].radius:g} m, at the sides of the body"
        notes.append(f"nothing says what {listed(each.name for each in vague)} turn: taken as wheels, {where}")
    rest = iter(assumed)
    made = [each.wheel or next(rest) for each in found if each.wheel or each.is_vague]
    return tuple(_renamed(made)), notes


def heading(wheels: Sequence[Wheel]) -> float:
    """Return the direction in which parallel wheels roll, seen from the robot; 0 if they are not parallel."""
    if not wheels or all(abs(math.sin(each.at.theta)) < SAME for each in wheels):
        return 0.0
    first = wheels[0].at.theta
    return first if all(abs(math.sin(each.at.theta - first)) < SAME for each in wheels) else 0.0


def listed(names: Iterable[str]) -> str:
    """Return names in quotes."""
    return ", ".join(f"'{each}'" for each in names)


def _motor(found: Found, device: Node, joint: Node, placement: Placement) -> Motor:
    name = device.text("name", "rotational motor")
    speed = min(max(device.number("maxVelocity", MOTOR_SPEED), SPEEDS[0]), SPEEDS[1])
    vague = joint.type == "HingeJoint" and joint.node("endPoint") is None
    return Motor(name, speed, _wheel(found, name, speed, joint, placement), vague)


def _wheel(found: Found, name: str, speed: float, joint: Node, placement: Placement) -> Wheel | None:
    """Make the wheel that a joint turns: a shape with a level axis; it rolls to the right of its axis."""
    end, parameters = joint.node("endPoint"), joint.node("jointParameters")
    along = np.array(parameters.numbers("axis", 1.0, 0.0, 0.0) if parameters else (1.0, 0.0, 0.0))
    axis = placement.matrix @ along
    length = float(np.linalg.norm(axis))
    if end is None or joint.type != "HingeJoint" or length < 1e-9 or abs(float(axis[2])) > 10 * LEVEL * length:
        return None
    inner = placement.inside(end)
    radius = _radius(found, end, inner, axis / length)
    if radius < 0.001:
        return None
    theta = math.atan2(-float(axis[0]), float(axis[1]))
    at = Pose(rounded(inner.offset[0]), rounded(inner.offset[1]), rounded(theta))
    return Wheel(name, at, rounded(radius), speed)


def _radius(found: Found, end: Node, inner: Placement, axis: Array) -> float:
    parts = found.parts(end, inner, nested=True)
    return max((each.farthest(inner.offset, axis) for each in parts), default=0.0)


def _renamed(wheels: Sequence[Wheel]) -> Iterator[Wheel]:
    """Yield the wheels, each motor with a unique name."""
    taken: list[str] = []
    for wheel in wheels:
        taken.append(unlike(wheel.motor, taken))
        yield Wheel(taken[-1], wheel.at, wheel.radius, wheel.speed_max)


def _assumed(motors: Sequence[Motor], outline: Footprint) -> list[Wheel]:
    """Make wheels for motors of which only the name is known: at the sides of the body, as large as it is long."""
    corners = outline.outline()
    (back, right), (front, left) = corners.min(axis=0), corners.max(axis=0)
    radius = round(min(max(float(front - back) / 2, RADII[0]), RADII[1]), 3)
    sides = [float(left if _side(each.name, index) > 0 else right) for index, each in enumerate(motors)]
    return [Wheel(each.name, Pose(0.0, y), radius, each.speed_max) for each, y in zip(motors, sides, strict=True)]


def _side(name: str, index: int) -> int:
    """Return the side of a motor, 1 left or -1 right: by its name, else in turn."""
    words = "".join(each if each.isalnum() else " " for each in name.lower()).split()
    for side, beginnings in ((1, LEFT), (-1, RIGHT)):
        if any(word.startswith(beginnings) or word == beginnings[0][0] for word in words):
            return side
    return -1 if index % 2 else 1


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
    name, given = unlike(description.name, taken), node.text("name", "robot")
    if name != given:
        notes.insert(0, f"this is how the robot '{given}' is called here")
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
