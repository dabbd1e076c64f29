"""Builder of the scenery of a world from its description.

scene = scenery(load_world("configs/worlds/lab.yaml"))
"""

from __future__ import annotations

from collections.abc import Iterable

from robolink.geometry.plane import Pose
from robolink.sim.description import Obstacle, RobotDescription, WorldDescription
from robolink.sim.scene.solids import HERE, solid, upright
from robolink.sim.scene.surfaces import Colour, Floor, Scenery, Surfaces

SKY: Colour = (190, 205, 225)
FLOOR: Colour = (150, 145, 140)
WALL: Colour = (200, 195, 185)
OBSTACLE: Colour = (140, 110, 80)
ROBOT: Colour = (70, 70, 80)

WALL_HEIGHT, OBSTACLE_HEIGHT, ROBOT_HEIGHT = 1.0, 0.5, 0.2
"""Heights in metres where a world file has none."""

GROUND_CLEARANCE = 0.02
"""Height of a robot's underside above the floor, in metres."""


def scenery(description: WorldDescription) -> Scenery:
    """Return what can be seen of a world.

    Args:
        description: The world, as from `load_world`.
    """
    obstacles = list(enumerate(description.obstacles))
    walls = [
        upright(start, end, 0.0, WALL_HEIGHT, WALL) for wall in description.walls for start, end in wall.segments()
    ]
    fixed = [_obstacle(each, each.start.place) for _, each in obstacles if not _movable(each)]
    return Scenery(
        Floor(FLOOR),
        SKY,
        _joined([Surfaces(tuple(walls)), *fixed]),
        {index: _obstacle(each, HERE) for index, each in obstacles if _movable(each)},
        {each.name: robot_surfaces(each) for each in description.robots},
    )


def robot_surfaces(robot: RobotDescription) -> Surfaces:
    """Return the surfaces of a robot in its own frame."""
    return solid(robot.shape, HERE, GROUND_CLEARANCE, ROBOT_HEIGHT, ROBOT)


def _movable(obstacle: Obstacle) -> bool:
    return obstacle.path is not None or obstacle.mass is not None


def _obstacle(obstacle: Obstacle, pose: Pose) -> Surfaces:
    return solid(obstacle, pose, 0.0, OBSTACLE_HEIGHT, OBSTACLE)


def _joined(parts: Iterable[Surfaces]) -> Surfaces:
    faces, cylinders = zip(*parts, strict=True)
    return Surfaces(tuple(each for part in faces for each in part), tuple(each for part in cylinders for each in part))
