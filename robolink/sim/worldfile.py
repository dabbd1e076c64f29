"""Reads world files, and finds in them what is wrong and types cannot say.

description = load_world("configs/worlds/corners.yaml")
"""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterator, Sequence
from typing import TypeAlias

import pymunk

from robolink import yamlfile
from robolink.exceptions import nearest
from robolink.sim.bodies import body_at, solid, wall_shapes
from robolink.sim.description import Lidar, Obstacle, Point, RobotDescription, Shape, Wall, WorldDescription

Problem: TypeAlias = "tuple[str, str]"

DRIVES = ("diff",)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_TAKEN = ("cmd_vel", "odom", "tf", "clock", "rosout")
_TOUCHING = 1e-9


def load_world(path: str | os.PathLike[str], *, text: str | None = None) -> WorldDescription:
    """Read a world file (or `text` in its place).

    Raises `DocumentError` with `file:line:column` for everything that is wrong with it: YAML, an unknown key, a
    value of the wrong type or out of range, a shape without extent, a robot that starts inside something.
    """
    document = yamlfile.read(path, WorldDescription, text=text)
    for where, message in problems(document.value):
        raise document.error(where, message)
    return document.value


def problems(description: WorldDescription) -> Iterator[Problem]:
    """Yield (path, message) for all that is wrong, such as ``$.robots[0].pose``; overlaps once all else is right."""
    found = False
    for problem in _local_problems(description):
        found = True
        yield problem
    if not found:
        yield from _overlaps(description)


def steps_between(rate: float, dt: float) -> int:
    """Give the whole number of steps of `dt` seconds from one reading to the next at `rate` Hz; 0 if there is none."""
    steps = 1.0 / (rate * dt)
    whole = round(steps)
    return whole if whole >= 1 and abs(steps - whole) < 1e-6 * steps else 0


def _local_problems(description: WorldDescription) -> Iterator[Problem]:
    for index, wall in enumerate(description.walls):
        yield from _under(f"$.walls[{index}]", _wall_problems(wall))
    for index, obstacle in enumerate(description.obstacles):
        yield from _under(f"$.obstacles[{index}]", _shape_problems(obstacle))
    for index, robot in enumerate(description.robots):
        yield from _under(f"$.robots[{index}]", _robot_problems(robot, description.world.dt))
    names = [robot.name for robot in description.robots]
    yield from _repeated(names, "$.robots[{}].name", "two robots are called")
    yield from _size_problems(description)


def _under(path: str, found: Iterator[Problem]) -> Iterator[Problem]:
    return ((path + where, message) for where, message in found)


def _wall_problems(wall: Wall) -> Iterator[Problem]:
    points = wall.polyline
    if wall.closed and len(points) < 3:
        yield ".polyline", f"a closed wall needs 3 points or more, got {len(points)}"
        return
    for index, (start, end) in enumerate(wall.segments()):
        if math.dist(start, end) < 1e-6:
            last = len(points) - 1
            yield f".polyline[{min(index + 1, last)}]", _no_length(start, closing=index == last)


def _no_length(point: Point, closing: bool) -> str:
    at = f"[{point[0]:g}, {point[1]:g}]"
    if closing:
        return f"'closed: true' already leads back to the first point, {at}: leave this one out"
    return f"a wall from {at} to the same point has no length"


def _shape_problems(shape: Shape) -> Iterator[Problem]:
    if (shape.box is None) == (shape.circle is None):
        found = "neither" if shape.box is None else "both"
        yield "", f"expected one of 'box' and 'circle', got {found}"


def _robot_problems(robot: RobotDescription, dt: float) -> Iterator[Problem]:
    if not _NAME.fullmatch(robot.name):
        yield ".name", _bad_name(robot.name)
    if bad := list(_shape_problems(robot.shape)):
        yield from _under(".shape", iter(bad))
    else:
        yield from _under(".drive", _drive_problems(robot, dt))
    yield from _rate_problems(".odom.rate", robot.odom.rate, dt)
    for index, sensor in enumerate(robot.sensors):
        yield from _under(f".sensors[{index}]", _lidar_problems(sensor, dt))
    topics = [sensor.lidar for sensor in robot.sensors]
    yield from _repeated(topics, ".sensors[{}].lidar", "two sensors publish on")


def _bad_name(name: str) -> str:
    return f"{name!r} is no name: letters, digits and '_', a letter first, 64 at most"


def _repeated(names: Sequence[str], path: str, words: str) -> Iterator[Problem]:
    for index, name in enumerate(names):
        if names.index(name) < index:
            yield path.format(index), f"{words} '{name}'"


def _drive_problems(robot: RobotDescription, dt: float) -> Iterator[Problem]:
    drive, reach = robot.drive, robot.shape.inner_radius()
    if drive.type not in DRIVES:
        known = ", ".join(DRIVES)
        yield ".type", f"no drive is called '{drive.type}'{nearest(drive.type, DRIVES)}; there is: {known}"
    if drive.v_max * dt > reach:
        way = f"{drive.v_max:g} m/s is {drive.v_max * dt:.3g} m in a step of {dt:g} s"
        yield ".v_max", f"{way}, and a robot of {reach:g} m could pass through walls: at most {reach / dt:.4g}"
    if drive.w_max * dt > math.pi / 2:
        yield ".w_max", f"more than a quarter turn in a step of {dt:g} s: at most {math.pi / 2 / dt:.4g}"


def _lidar_problems(lidar: Lidar, dt: float) -> Iterator[Problem]:
    if not _NAME.fullmatch(lidar.lidar):
        yield ".lidar", _bad_name(lidar.lidar)
    elif lidar.lidar in _TAKEN:
        yield ".lidar", f"the topic '{lidar.lidar}' is taken: choose another, such as 'scan'"
    yield from _rate_problems(".rate", lidar.rate, dt)
    if lidar.range[0] >= lidar.range[1]:
        yield ".range", f"the nearest, {lidar.range[0]:g} m, must be less than the farthest, {lidar.range[1]:g} m"


def _rate_problems(path: str, rate: float, dt: float) -> Iterator[Problem]:
    if steps_between(rate, dt):
        return
    steps = math.floor(1.0 / (rate * dt))
    fitting = " or ".join(f"{1.0 / (dt * whole):.6g}" for whole in (steps + 1, steps) if whole)
    yield path, f"{rate:g} Hz is no whole number of steps of {dt:g} s: take {fitting}"


def _size_problems(description: WorldDescription) -> Iterator[Problem]:
    if description.world.size is None:
        return
    width, height = description.world.size
    poses = {f"$.robots[{index}].pose": each.pose for index, each in enumerate(description.robots)}
    poses |= {f"$.obstacles[{index}].pose": each.pose for index, each in enumerate(description.obstacles)}
    for path, pose in poses.items():
        if not (0.0 <= pose.x <= width and 0.0 <= pose.y <= height):
            yield path, f"[{pose.x:g}, {pose.y:g}] lies outside of the world's size, [{width:g}, {height:g}]"


def _overlaps(description: WorldDescription) -> Iterator[Problem]:
    """Find robots and pushable obstacles that start inside something else."""
    space, places = pymunk.Space(), dict[pymunk.Shape, str]()
    for index, wall in enumerate(description.walls):
        segments = wall_shapes(wall, space.static_body)
        places |= dict.fromkeys(segments, f"walls[{index}]")
        space.add(*segments)
    free = [_placed(space, robot, robot.shape, robot.mass) for robot in description.robots]
    things = [_placed(space, obstacle, obstacle, obstacle.mass) for obstacle in description.obstacles]
    places |= {shape: f"robots[{index}]" for index, shape in enumerate(free)}
    places |= {shape: f"obstacles[{index}]" for index, shape in enumerate(things)}
    free += [shape for shape, each in zip(things, description.obstacles, strict=True) if each.mass is not None]
    for shape in free:
        if other := _inside(space, shape):
            yield f"$.{places[shape]}.pose", f"this starts inside of {places[other]}"


def _placed(
    space: pymunk.Space, thing: RobotDescription | Obstacle, outline: Shape, mass: float | None
) -> pymunk.Shape:
    body = body_at(thing.pose, mass, outline)
    shape = solid(outline, body)
    space.add(body, shape)
    return shape


def _inside(space: pymunk.Space, shape: pymunk.Shape) -> pymunk.Shape | None:
    """Find what a shape overlaps with by more than a touch; of things with one centre Chipmunk knows no normal."""
    for info in space.shape_query(shape):
        contact = info.contact_point_set
        if contact.normal.length < 0.5 or any(point.distance < -_TOUCHING for point in contact.points):
            return info.shape
    return None
