"""Builder of the scenery of a world from its description.

scene = scenery(load_world("configs/worlds/lab.yaml"))
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cache
from itertools import chain
from typing import TypeAlias

import msgspec

from robolink.geometry import plane
from robolink.sim.colours import Colour
from robolink.sim.description import Obstacle, RobotDescription, Sign, Wall, WorldDescription
from robolink.sim.looks import (
    OBSTACLE_HEIGHT,
    ROBOT_HEIGHT,
    WALL_FACE,
    WALL_HEIGHT,
    moves,
    obstacle_colour,
    robot_colour,
    wall_colour,
)
from robolink.sim.quantities import Pose
from robolink.sim.scene.floor import painted_floor
from robolink.sim.scene.pictures import cached_picture
from robolink.sim.scene.signs import sign_surfaces
from robolink.sim.scene.solids import HERE, Picture, Scenery, Surfaces, solid, upright

SKY: Colour = (190, 205, 225)
"""Colour where nothing is."""

GROUND_CLEARANCE = 0.02
"""Height of a robot's underside above the floor, in metres; of a flatter robot it is half its height."""

_Read: TypeAlias = Callable[[str], Picture]


def scenery(description: WorldDescription) -> Scenery:
    """Return the surfaces of a world that can be seen.

    Args:
        description: The world, as from `load_world`.

    Raises:
        OSError: if a picture cannot be read.
        ImageError: if a picture is none.
        ValueError: for a colour or a tag that is none, which `load_world` refuses.
    """
    read = cache(cached_picture)
    standing = standing_surfaces(description)
    signs = [sign_surfaces(each, read, standing) for each in description.signs]
    fixed = [each for each in description.obstacles if not moves(each)]
    signs += [sign_surfaces(_placed(sign, each.start), read) for each in fixed for sign in each.signs]
    settings = description.world.floor
    return Scenery(
        painted_floor(settings, description.paint, None if settings.image is None else read(settings.image)),
        SKY,
        _joined([standing, *signs]),
        {
            index: _with_signs(_obstacle(each, HERE), each.signs, read)
            for index, each in enumerate(description.obstacles)
            if moves(each)
        },
        {each.name: _robot(each, read) for each in description.robots},
    )


def standing_surfaces(description: WorldDescription) -> Surfaces:
    """Return the surfaces of walls and of obstacles that never move, without signs."""
    fixed = [each for each in description.obstacles if not moves(each)]
    return _joined([_walls(description.walls), *(_obstacle(each, each.start.place) for each in fixed)])


def robot_surfaces(robot: RobotDescription) -> Surfaces:
    """Return the surfaces of a robot in its own frame. Raises as `scenery`."""
    return _robot(robot, cached_picture)


def _walls(walls: Sequence[Wall]) -> Surfaces:
    faces = (
        upright(start, end, 0.0, wall.height or WALL_HEIGHT, wall_colour(wall, WALL_FACE))
        for wall in walls
        for start, end in wall.segments()
    )
    return Surfaces(tuple(faces))


def _obstacle(obstacle: Obstacle, pose: plane.Pose) -> Surfaces:
    return solid(obstacle, pose, 0.0, obstacle.height or OBSTACLE_HEIGHT, obstacle_colour(obstacle))


def _robot(robot: RobotDescription, read: _Read) -> Surfaces:
    height = robot.height or ROBOT_HEIGHT
    body = solid(robot.shape, HERE, min(GROUND_CLEARANCE, height / 2), height, robot_colour(robot))
    return _with_signs(body, robot.signs, read)


def _with_signs(body: Surfaces, signs: Sequence[Sign], read: _Read) -> Surfaces:
    return _joined([body, *(sign_surfaces(each, read) for each in signs)])


def _placed(sign: Sign, origin: Pose) -> Sign:
    """Return a sign of an obstacle as one of the world."""
    return msgspec.structs.replace(sign, pose=Pose(*plane.placed_on(origin.place, sign.pose.place)))


def _joined(parts: Iterable[Surfaces]) -> Surfaces:
    faces, cylinders = zip(*parts, strict=True)
    return Surfaces(tuple(chain.from_iterable(faces)), tuple(chain.from_iterable(cylinders)))
