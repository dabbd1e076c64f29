"""Markers of a simulated world for viewers: its floor, walls and obstacles, what moves, signs, and the robots.

They are visualization_msgs/MarkerArray, latched, in the frame `map` unless something else is said. Each message begins
with DELETEALL: it is all of its topic.

| topic | ns | what | type |
|---|---|---|---|
| `~/floor` | `floor` | 0: its rectangle, if it has a colour, a picture or paint; 1: its picture | TRIANGLE_LIST |
| | `paint` | each line or area that is painted; later ones lie higher | TRIANGLE_LIST |
| `~/walls` | `walls` | walls of one colour and height, at their upper edge | LINE_LIST |
| | `wall_faces` | the same ones, upright: nothing of them is seen from above | TRIANGLE_LIST |
| | `obstacles` | each fixed obstacle | CYLINDER, CUBE, TRIANGLE_LIST |
| `~/objects` | `obstacles` | each that moves or can be pushed | CYLINDER, CUBE, TRIANGLE_LIST |
| | `robots` | each robot, in its own frame, frame_locked | CYLINDER, CUBE, TRIANGLE_LIST |

Colours are those of the world file, else those of `robolink.sim.looks`. The floor lies a little below z = 0, where
viewers draw grids and maps: what lies in one plane flickers.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from robolink.clock import Clock
from robolink.geometry.plane import Area, Pose
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.node import Node
from robolink.sim import World
from robolink.sim.colours import Colour, colour_of
from robolink.sim.description import Wall, WorldDescription
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
from robolink.sim.scene import strokes, triangles
from robolink.world_node import markers
from robolink.world_node.simulation import LATCHED, Simulation

PERIOD = 0.1
"""Interval at which moving obstacles are published, in seconds."""

LOWEST, HIGHEST, STEP = -0.02, -0.002, 0.001
"""Heights of the floor and of the last paint on it, and the most between two layers, in metres."""

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
        self._shown: object = None
        node.create_publisher(MarkerArray, "~/floor", LATCHED).publish(self._scenery.floor())
        node.create_publisher(MarkerArray, "~/walls", LATCHED).publish(self._scenery.walls())
        self.publish()
        node.create_timer(PERIOD, self.publish, clock=clock)

    def publish(self) -> None:
        """Publish what moves, is pushed or drives, if anything of it has changed."""
        now = (tuple(_frames(self._simulation).items()), tuple(self._simulation.world.obstacle_poses()))
        if now == self._shown:
            return
        self._shown = now
        self._objects.publish(self._scenery.objects(self._simulation))


class Scenery:
    """All markers of a world.

    Args:
        description: The world.
    """

    def __init__(self, description: WorldDescription) -> None:
        self.description = description

    def floor(self) -> MarkerArray:
        """Return the markers of the floor and of what is painted on it."""
        return _all_of([*_ground(self.description), *_paint(self.description)])

    def walls(self) -> MarkerArray:
        """Return the markers of things that stand."""
        return _all_of([*_walls(self.description.walls), *_standing(self.description)])

    def objects(self, simulation: Simulation) -> MarkerArray:
        """Return the markers of things that move, are pushed or drive, where they are now."""
        world = simulation.world
        return _all_of([*_moving(world), *_robots(world, _frames(simulation))])


def _all_of(found: Sequence[Marker]) -> MarkerArray:
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL), *found])


def _frames(simulation: Simulation) -> dict[str, str]:
    """Return the frames of the robots by their names."""
    return {name: topics.base_frame for name, topics in simulation.robots.items()}


def _ground(description: WorldDescription) -> Iterator[Marker]:
    settings = description.world.floor
    if settings.colour is None and settings.image is None and not description.paint:
        return
    colour = FLOOR if settings.colour is None else colour_of(settings.colour)
    left, low, right, high = ground_area(description)
    corners = [(left, low), (right, low), (right, high), (left, high)]
    yield markers.flat("floor", 0, triangles.of_polygon(corners), LOWEST, colour)


def ground_area(description: WorldDescription) -> Area:
    """Return the area of the floor in metres: the world's size, or all that stands in it, and what is painted."""
    size = description.world.size
    area = extent(description) if size is None else Area(0.0, 0.0, *size)
    for each in description.paint:
        box = strokes.box_of(each)
        area = area.grown(box.x_min, box.y_min).grown(box.x_max, box.y_max)
    return area


def _paint(description: WorldDescription) -> Iterator[Marker]:
    layers = len(description.paint)
    step = min(STEP, (HIGHEST - LOWEST) / (layers + 1))
    for index, each in enumerate(description.paint):
        z = LOWEST + step * (index + 2)
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
        marker.header.frame_id, marker.frame_locked = frame, True
        yield marker
