"""Look of a world where its file says nothing: colours by kind, heights, and the area that a picture of it shows.

`robolink world draw`, the cameras and the markers for viewers all take them from here.
"""

from __future__ import annotations

from collections.abc import Sequence

from robolink.geometry.plane import Area
from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import Obstacle, RobotDescription, Wall, WorldDescription

# Those of obstacles and robots are Okabe and Ito's, which people who see few colours can tell apart.
FIXED: Colour = (168, 168, 168)
PUSHABLE: Colour = (230, 159, 0)
MOVING: Colour = (86, 180, 233)
ROBOT: Colour = (0, 158, 115)
WALL: Colour = (100, 112, 132)
"""Colour of a wall that is seen from above, a line: one that is seen on white and on black."""

WALL_FACE: Colour = (200, 195, 185)
"""Colour of a wall as a camera sees it, a face that fills half of its picture."""

FLOOR: Colour = (150, 145, 140)
"""Colour of the floor to cameras, and around what is painted."""

WALL_HEIGHT, OBSTACLE_HEIGHT, ROBOT_HEIGHT = 1.0, 0.5, 0.2
"""Heights in metres."""

KINDS = {"fixed": FIXED, "can be pushed": PUSHABLE, "moves by itself": MOVING}
"""Colours of obstacles by kind."""

_LEAST_RADII = 10.0
"""Least size of the shown area in both directions, in radii of the largest robot."""

_NOWHERE = ((0.0,), (0.0,))
"""Place of an empty world: x and y."""


def kind_of(obstacle: Obstacle) -> str:
    """Return the kind of an obstacle, a key of `KINDS`."""
    if obstacle.path is not None:
        return "moves by itself"
    return "fixed" if obstacle.mass is None else "can be pushed"


def moves(obstacle: Obstacle) -> bool:
    """True if an obstacle moves by itself or can be pushed."""
    return obstacle.path is not None or obstacle.mass is not None


def wall_colour(wall: Wall, default: Colour = WALL) -> Colour:
    """Return the colour of a wall."""
    return default if wall.colour is None else colour_of(wall.colour)


def obstacle_colour(obstacle: Obstacle) -> Colour:
    """Return the colour of an obstacle; one that has none is coloured by its kind."""
    return KINDS[kind_of(obstacle)] if obstacle.colour is None else colour_of(obstacle.colour)


def robot_colour(robot: RobotDescription) -> Colour:
    """Return the colour of a robot."""
    return ROBOT if robot.colour is None else colour_of(robot.colour)


def extent(description: WorldDescription) -> Area:
    """Return the bounding box of a world in metres, so large that no robot fills it."""
    points = [point for wall in description.walls for segment in wall.segments() for point in segment]
    points += [(each.start.x, each.start.y) for each in description.obstacles]
    points += [point for each in description.obstacles for point in each.path or ()]
    points += [(each.pose.x, each.pose.y) for each in description.robots]
    points += [(each.pose.x, each.pose.y) for each in description.signs]
    least = _LEAST_RADII * max((each.shape.outer_radius() for each in description.robots), default=0.1)
    (x_min, x_max), (y_min, y_max) = (
        _widened(each, least) for each in (zip(*points, strict=True) if points else _NOWHERE)
    )
    return Area(x_min, y_min, x_max, y_max)


def _widened(values: Sequence[float], least: float) -> tuple[float, float]:
    """Return the least and the greatest of some values, moved apart until they are `least` from each other."""
    low, high = min(values), max(values)
    more = max(0.0, least - (high - low)) / 2
    return low - more, high + more
