"""Markers of a simulated world for viewers: its floor, walls and obstacles, what moves, signs, and the robots.

They are visualization_msgs/MarkerArray, latched, in the frame `map` unless something else is said. Each message begins
with DELETEALL: it is all of its topic.

| topic | ns | what | type |
|---|---|---|---|
| `~/floor` | `floor` | 0: its area, if it has a colour, a picture or paint; 1: its picture | TRIANGLE_LIST |
| | `paint` | each line or area that is painted; later ones lie higher | TRIANGLE_LIST |
| `~/walls` | `walls` | walls of one colour and height, at their upper edge | LINE_LIST |
| | `wall_faces` | the same ones, upright: nothing of them is seen from above | TRIANGLE_LIST |
| | `obstacles` | each fixed obstacle | CYLINDER, CUBE, TRIANGLE_LIST |
| | `signs` | each sign in its own frame: x out of its face, y to the right of who looks at it, z up | TRIANGLE_LIST |
| | `poles` | poles of signs that hang on nothing | CYLINDER |
| `~/objects` | `obstacles` | each that moves or can be pushed | CYLINDER, CUBE, TRIANGLE_LIST |
| | `robots` | each robot, in its own frame, frame_locked | CYLINDER, CUBE, TRIANGLE_LIST |
| | `signs` | signs on them, in the frame of the robot or in `map` | TRIANGLE_LIST |

A picture is a background and patches of one colour, whose triangles have a colour for each corner. The `text` is the
name of a robot, and the tag or the file's name of a sign.

Colours are those of the world file, else those of `robolink.sim.looks`. The floor lies a little below z = 0, where
viewers draw grids and maps: what lies in one plane flickers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import groupby
from math import isclose

from robolink.clock import Clock
from robolink.geometry.plane import Area, Pose
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.node import Node
from robolink.sim import World
from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import Shape, Wall, WorldDescription, signed_area
from robolink.sim.looks import (
    FLOOR,
    OBSTACLE_HEIGHT,
    ROBOT_HEIGHT,
    WALL_HEIGHT,
    extent,
    moves,
    obstacle_colour,
    robot_colour,
    wall_colour,
)
from robolink.sim.quantities import Point
from robolink.sim.scene import strokes, triangles
from robolink.sim.scene.mosaic import mosaic
from robolink.sim.scene.pictures import cached_picture
from robolink.world_node import markers
from robolink.world_node.signs import Signs
from robolink.world_node.simulation import LATCHED, Simulation

PERIOD = 0.1
"""Interval at which moving obstacles are published, in seconds."""

LOWEST, HIGHEST, STEP = -0.02, -0.002, 0.001
"""Heights of the floor and of the last paint on it, and the most between two layers, in metres."""

MOST_PATCHES, MOST_COLOURS = 10_000, 48
"""Most rectangles and colours of the floor's picture; each rectangle takes 240 bytes."""

MOST_CORNERS = 200
"""Most corners of a room whose floor ends at its walls."""

MOST_FACES = 2_000
"""Most walls that are drawn as faces too: a map may have a hundred thousand."""


class Shapes:
    """Publishes the shapes of a simulation.

    Args:
        node: The node that publishes.
        simulation: The simulation; its robots may come and go.
        clock: Clock of the timer.
    """

    def __init__(self, node: Node, simulation: Simulation, clock: Clock) -> None:
        self._simulation, self._scenery = simulation, Scenery(simulation.description)
        self._objects = node.create_publisher(MarkerArray, "~/objects", LATCHED)
        node.create_publisher(MarkerArray, "~/floor", LATCHED).publish(self._scenery.floor())
        node.create_publisher(MarkerArray, "~/walls", LATCHED).publish(self._scenery.walls())
        self.publish()
        node.create_timer(PERIOD, self.publish, clock=clock)

    def publish(self) -> None:
        """Publish what moves, is pushed or drives, if anything of it has changed."""
        objects = self._scenery.changed(self._simulation)
        if objects is not None:
            self._objects.publish(objects)


class Scenery:
    """All markers of a world.

    Args:
        description: The world.
    """

    def __init__(self, description: WorldDescription) -> None:
        self.description = description
        self._signs = Signs(description)
        self._has_movable = any(map(moves, description.obstacles))
        self._shown: object = None

    def floor(self) -> MarkerArray:
        """Return the markers of the floor and of what is painted on it."""
        return _all_of([*_ground(self.description), *_paint(self.description)])

    def walls(self) -> MarkerArray:
        """Return the markers of things that stand."""
        return _all_of([*_walls(self.description.walls), *_standing(self.description), *self._signs.standing()])

    def changed(self, simulation: Simulation) -> MarkerArray | None:
        """Return `objects` if anything of it has changed since the last call, by more than a tenth of a millimetre."""
        robots = [(frame, simulation.world.robots[name].description) for name, frame in _frames(simulation).items()]
        poses = simulation.world.obstacle_poses() if self._has_movable else []
        now = robots, [(round(x, 4), round(y, 4), round(theta, 4)) for x, y, theta in poses]
        if now == self._shown:
            return None
        self._shown = now
        return self.objects(simulation)

    def objects(self, simulation: Simulation) -> MarkerArray:
        """Return the markers of things that move, are pushed or drive, where they are now."""
        world, frames = simulation.world, _frames(simulation)
        return _all_of([*_moving(world), *_robots(world, frames), *self._moving_signs(world, frames)])

    def _moving_signs(self, world: World, frames: dict[str, str]) -> Iterator[Marker]:
        """Yield the markers of signs on what moves, is pushed or drives."""
        obstacles = zip(world.description.obstacles, world.obstacle_poses(), strict=True)
        placed = [(sign, pose, None) for each, pose in obstacles if moves(each) for sign in each.signs]
        on_robots = [
            (sign, Pose(), frame) for name, frame in frames.items() for sign in world.robots[name].description.signs
        ]
        for index, (sign, origin, frame) in enumerate([*placed, *on_robots]):
            yield self._signs.at(origin, sign, index, frame)


def _all_of(found: Sequence[Marker]) -> MarkerArray:
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL), *found])


def _frames(simulation: Simulation) -> dict[str, str]:
    """Return the frames of the robots by their names."""
    return {name: topics.base_frame for name, topics in simulation.robots.items()}


def _ground(description: WorldDescription) -> Iterator[Marker]:
    """Yield the markers of the floor: its area in its colour, and its picture."""
    settings, picture = description.world.floor, None
    if settings.image is not None:
        with suppress(OSError, ValueError):  # its file has gone since the world was read
            picture = cached_picture(settings.image)
    if settings.colour is None and picture is None and not description.paint:
        return
    area = ground_area(description, (0, 0) if picture is None else (picture.shape[1], picture.shape[0]))
    colour = FLOOR if settings.colour is None else colour_of(settings.colour)
    yield markers.flat("floor", 0, _floor_triangles(area, description.walls), LOWEST, colour)
    if picture is not None:
        there = strokes.extent(settings, (), (picture.shape[1], picture.shape[0]))
        side = strokes.resolution_of(settings)
        corner, size = (there.x, there.y, LOWEST + STEP / 4), (there.columns * side, there.rows * side)
        yield markers.floor_picture(mosaic(picture, MOST_PATCHES, MOST_COLOURS), corner, size)


def _floor_triangles(area: Area, walls: Sequence[Wall]) -> list[triangles.Triangle]:
    """Return the triangles of the floor: within the walls of a room that fills its area, else all of the area."""
    for wall in walls:
        if wall.closed and len(wall.polyline) <= MOST_CORNERS and _box(wall.polyline) == area:
            corners = Shape(polygon=wall.polyline).corners()
            found = list(triangles.of_polygon(corners))
            if isclose(sum(map(signed_area, found)), signed_area(corners)):  # else it crosses itself
                return found
    rectangle = [(area.x_min, area.y_min), (area.x_max, area.y_min), (area.x_max, area.y_max), (area.x_min, area.y_max)]
    return list(triangles.of_polygon(rectangle))


def _box(points: Sequence[Point]) -> Area:
    xs, ys = zip(*points, strict=True)
    return Area(min(xs), min(ys), max(xs), max(ys))


def ground_area(description: WorldDescription, picture: tuple[int, int] = (0, 0)) -> Area:
    """Return the area of the floor in metres: the world's size, or all that stands in it, and all that is painted.

    Args:
        description: The world.
        picture: Columns and rows of the floor's picture.
    """
    size, settings = description.world.size, description.world.floor
    area = extent(description) if size is None else Area(0.0, 0.0, *size)
    painted, side = strokes.extent(settings, description.paint, picture), strokes.resolution_of(settings)
    if painted.pixels:
        area = area.grown(painted.x, painted.y)
        area = area.grown(painted.x + painted.columns * side, painted.y + painted.rows * side)
    return area


def _paint(description: WorldDescription) -> Iterator[Marker]:
    lowest = LOWEST + STEP
    step = min(STEP, (HIGHEST - lowest) / max(1, len(description.paint)))
    for index, each in enumerate(description.paint):
        z = lowest + step * index
        yield markers.flat("paint", index, triangles.of_paint(each), z, colour_of(each.colour))


def _walls(walls: Sequence[Wall]) -> Iterator[Marker]:
    def look(wall: Wall) -> tuple[Colour, float]:
        return wall_colour(wall), wall.height or WALL_HEIGHT

    for index, ((colour, height), alike) in enumerate(groupby(sorted(walls, key=look), look)):
        segments = [segment for wall in alike for segment in wall.segments()]
        yield markers.lines("walls", index, segments, height, colour)
        if len(segments) <= MOST_FACES:
            yield markers.upright("wall_faces", index, segments, height, colour)


def _standing(description: WorldDescription) -> Iterator[Marker]:
    for index, each in enumerate(description.obstacles):
        if not moves(each):
            height = each.height or OBSTACLE_HEIGHT
            yield markers.solid("obstacles", index, each, height, each.start.place, obstacle_colour(each))


def _moving(world: World) -> Iterator[Marker]:
    for index, (each, pose) in enumerate(zip(world.description.obstacles, world.obstacle_poses(), strict=True)):
        if moves(each):
            height = each.height or OBSTACLE_HEIGHT
            yield markers.solid("obstacles", index, each, height, pose, obstacle_colour(each))


def _robots(world: World, frames: dict[str, str]) -> Iterator[Marker]:
    for index, (name, frame) in enumerate(frames.items()):
        robot = world.robots[name].description
        height = robot.height or ROBOT_HEIGHT
        marker = markers.solid("robots", index, robot.shape, height, Pose(), robot_colour(robot))
        marker.text = name
        markers.fix_to(marker, frame)
        yield marker
