"""Converter of the wheels of a Webots robot: joints with motors, and assumptions where a world says too little."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from robolink.sim.arrays import Array
from robolink.sim.description import Wheel
from robolink.sim.quantities import Pose
from robolink.sim.webots.footprint import Footprint
from robolink.sim.webots.geometry import LEVEL, Placement, rounded
from robolink.sim.webots.scene_tree import JOINTS, Found
from robolink.sim.webots.vrml_node import Node
from robolink.text.names import unlike

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
