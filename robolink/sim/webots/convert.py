"""Converter from a Webots scene tree to a flat world; every problem has its place in the file."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import msgspec

from robolink.exceptions import DocumentError
from robolink.sim.checks.overlaps import CROWDED
from robolink.sim.checks.worlds import mass_problems, problems
from robolink.sim.description import FloorSettings, Obstacle, Settings, Wall, WorldDescription
from robolink.sim.webots.geometry import HEIGHTS, ORIGIN, WORLDS, Placement, first_colour, footprint, merged, rounded
from robolink.sim.webots.robots import Converted, robot
from robolink.sim.webots.scene_tree import Arena, Found, Thing
from robolink.sim.webots.vrml_node import Node
from robolink.system.terminal import shown

FLAT = 0.02
"""Height in metres below which things lie on the floor, and robots drive over them."""

HEIGHT = 0.5
"""Default height in metres up to which things are obstacles, if there is no robot."""

LOWEST_ROBOT = 0.05
"""Least height in metres up to which things are obstacles."""

STEPS = (0.001, 0.1)
"""Shortest and longest step, in seconds."""

ATTEMPTS = 3

NAMED = 5
"""Most things that a note names."""

_OBSTACLE = r"\$\.obstacles\[(\d+)\]\.pose"


class Standing(NamedTuple):
    """An obstacle, and the thing that it is made of."""

    obstacle: Obstacle
    thing: Thing


def convert(
    nodes: list[Node], name: str, missing: Mapping[str, str] | None = None
) -> tuple[WorldDescription, tuple[str, ...]]:
    """Return a world made from the nodes of a file called `name`, and notes of what was left out or guessed.

    Args:
        nodes: Content of the file.
        name: Name of the file.
        missing: Why the definitions of PROTOs are not read, by their names.

    Raises:
        DocumentError: with the place in the file.
    """
    found = Found(nodes, _axes(nodes))
    settings = msgspec.structs.replace(_settings(found.information), floor=FloorSettings(colour=found.floor_colour))
    floor = found.floors[0] if found.floors else 0.0
    robots = _robots(found, settings.dt, floor)
    height = max((each.height for each in robots), default=HEIGHT)
    low, high = floor + FLAT, floor + max(height, LOWEST_ROBOT)
    under = [placement for _, placement in found.robots]
    things = [each for thing in found.things if (each := _standing(thing, low, high, under))]
    description = WorldDescription(
        world=settings,
        walls=tuple(_wall(each, floor) for each in found.arenas if each.height[1] > low),
        obstacles=tuple(each.obstacle for each in things),
        robots=tuple(each.description for each in robots),
    )
    description, moved = _settled(description, things, [node for node, _ in found.robots], floor, name)
    notes = [note for each in robots for note in each.notes] + moved
    return description, (*_unknown(found.unknown, missing or {}), *notes)


def _axes(nodes: list[Node]) -> Placement:
    """Return the placement of the world's axes: which of them is up."""
    information = next((node for node in nodes if node.type == "WorldInfo"), None)
    system = "ENU" if information is None else information.text("coordinateSystem", "ENU")
    if information is not None and system not in WORLDS:
        known = ", ".join(WORLDS)
        information.note(f"expected one of {known}, got '{shown(system, 40)}'; ENU is used", "coordinateSystem")
    return WORLDS.get(system, ORIGIN)


def _settings(information: Node | None) -> Settings:
    if information is None:
        return Settings(dt=0.032)
    step = information.length("basicTimeStep", 32.0) / 1000.0
    if step < STEPS[0]:
        raise information.error(f"expected 1 ms or more, got {step * 1000:g}", "basicTimeStep")
    seed = information.number("randomSeed", 0.0)
    title = information.text("title") or information.text("info")
    return Settings(name=title, dt=step / math.ceil(step / STEPS[1] - 1e-9), seed=int(min(max(seed, 0.0), 2.0**62)))


def _robots(found: Found, dt: float, floor: float) -> list[Converted]:
    """Convert the robots, and leave in `found` those that there are; `floor` is the height of the floor."""
    converted: list[Converted] = []
    remaining = []
    for node, placement in found.robots:
        names = [each.description.name for each in converted]
        if made := robot(found, node, placement, names, dt, floor):
            converted.append(made)
            remaining.append((node, placement))
    found.robots = remaining
    return converted


def _standing(thing: Thing, low: float, high: float, robots: Sequence[Placement]) -> Standing | None:
    """Make the obstacle of a thing; None if it is too high or too low, or a robot stands on it."""
    outlines = [(part, each) for part in thing.parts if (each := footprint(part, low, high))]
    outline = merged([each for _, each in outlines])
    if outline is None or (thing.mass is None and any(_bears(thing, each) for each in robots)):
        return None
    shape, pose = outline.placed()
    parts = [part for part, _ in outlines]
    obstacle = Obstacle(
        box=shape.box,
        circle=shape.circle,
        polygon=shape.polygon,
        pose=pose,
        mass=thing.mass,
        height=_height(max(part.top for part in parts) - (low - FLAT)),
        colour=next((part.colour for part in parts if part.colour), None) or first_colour(thing.node),
    )
    return Standing(obstacle, thing)


def _wall(arena: Arena, floor: float) -> Wall:
    return Wall(tuple(arena.corners), closed=True, height=_height(arena.height[1] - floor), colour=arena.colour)


def _height(height: float) -> float:
    """Return a height that a world file may have, without rounding errors."""
    return min(max(rounded(height), HEIGHTS[0]), HEIGHTS[1])


def _bears(thing: Thing, robot: Placement) -> bool:
    """True if a robot's origin is above a thing's top, within the box around it."""
    x, y, z = map(float, robot.offset)
    for part in thing.parts:
        (west, south), (east, north) = part.points[:, :2].min(axis=0), part.points[:, :2].max(axis=0)
        if part.radius:
            west, south, east, north = west - part.radius, south - part.radius, east + part.radius, north + part.radius
        if west <= x <= east and south <= y <= north and part.top <= z + FLAT:
            return True
    return False


def _settled(
    description: WorldDescription, things: list[Standing], robots: Sequence[Node], floor: float, name: str
) -> tuple[WorldDescription, list[str]]:
    """Leave out things that stand on others, and fix those that could be pushed but start inside of something."""
    notes: list[str] = []
    for _ in range(ATTEMPTS):
        found = [each for each in problems(description, fixed_too=False) if not _is_fixed(each.path, things)]
        inside = {int(match[1]) for each in found if (match := re.fullmatch(_OBSTACLE, each.path))}
        if not inside or any(each.path == CROWDED for each in found):
            break
        things, more = _moved(things, inside, floor)
        notes += more
        description = msgspec.structs.replace(description, obstacles=tuple(each.obstacle for each in things))
    for problem in found:
        raise _placed(problem.path, problem.message, things, robots, name)
    return description, [*notes, *_light(description, things, robots)]


def _light(description: WorldDescription, things: list[Standing], robots: Sequence[Node]) -> Iterator[str]:
    """Yield a note about things so light that robots may push them through walls; here that is not an error."""
    found = [_origin(each.path, things, robots) for each in mass_problems(description.robots, description.obstacles)]
    names = [node.called for node in found if node is not None]
    if names:
        others = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
        yield f"so light that a robot may push it through a wall: {', '.join(names[:NAMED])}{others}"


def _is_fixed(path: str, things: list[Standing]) -> bool:
    """True if a problem is the place of something fixed: walls may run into each other."""
    match = re.fullmatch(_OBSTACLE, path)
    return match is not None and things[int(match[1])].obstacle.mass is None


def _moved(things: list[Standing], inside: set[int], floor: float) -> tuple[list[Standing], list[str]]:
    remaining, notes = [], []
    for index, each in enumerate(things):
        if index not in inside:
            remaining.append(each)
        elif min(part.bottom for part in each.thing.parts) > floor + FLAT:
            notes.append(f"{each.thing.node.called} stands on something else: left out")
        else:
            remaining.append(Standing(msgspec.structs.replace(each.obstacle, mass=None), each.thing))
            notes.append(f"{each.thing.node.called} starts inside of something else: nothing can push it")
    return remaining, notes


def _placed(path: str, message: str, things: list[Standing], robots: Sequence[Node], name: str) -> DocumentError:
    """Make an error from a problem of the description, at the node that it comes from."""
    message = re.sub(r"obstacles\[(\d+)\]", lambda match: things[int(match[1])].thing.node.called, message)
    message = re.sub(r"robots\[(\d+)\]", lambda match: robots[int(match[1])].called, message)
    message = re.sub(r"walls\[\d+\]", "the walls of the arena", message)
    node = _origin(path, things, robots)
    if node is None:
        return DocumentError(f"{path.removeprefix('$.')}: {message}", name, 1, 1)
    return node.error(f"{node.called}: {message}")


def _origin(path: str, things: list[Standing], robots: Sequence[Node]) -> Node | None:
    """Return the node that a part of the description comes from."""
    match = re.match(r"\$\.(robots|obstacles)\[(\d+)\]", path)
    if match is None:
        return None
    return robots[int(match[2])] if match[1] == "robots" else things[int(match[2])].thing.node


def _unknown(unknown: dict[str, int], missing: Mapping[str, str]) -> Iterator[str]:
    """Yield the nodes that are left out, by the reason why; first those that are not known."""
    reasons: dict[str, list[str]] = {}
    for name, count in sorted(unknown.items(), key=lambda each: (missing.get(each[0], ""), each[0])):
        reasons.setdefault(missing.get(name, ""), []).append(f"{name} ({count} times)" if count > 1 else name)
    for reason, names in reasons.items():
        yield f"{reason or 'not known here'}, so this is not there: {', '.join(names)}"
