"""Markers of a simulated world for viewers: walls and obstacles, what moves, and the outlines of the robots.

They are visualization_msgs/MarkerArray, latched: `~/walls` is what stands, `~/objects` what moves, is pushed or drives.
"""

from __future__ import annotations

from collections.abc import Iterator

from robolink.clock import Clock
from robolink.geometry.plane import Pose
from robolink.interfaces.geometry_msgs.msg import Point, Vector3
from robolink.interfaces.geometry_msgs.msg import Pose as PoseMessage
from robolink.interfaces.std_msgs.msg import ColorRGBA, Header
from robolink.interfaces.visualization_msgs.msg import Marker, MarkerArray
from robolink.node import Node
from robolink.sim import World
from robolink.sim.description import Obstacle, Shape
from robolink.world_node.messages import facing
from robolink.world_node.robot_topics import MAP
from robolink.world_node.simulation import LATCHED, Simulation

PERIOD = 0.1
"""Interval at which moving obstacles are published, in seconds."""

HEIGHT, LINE = 0.5, 0.03
"""Height of solids and width of walls, in metres."""

WALL = ColorRGBA(r=0.5, g=0.53, b=0.58, a=1.0)
FIXED = ColorRGBA(r=0.6, g=0.62, b=0.66, a=0.8)
PUSHED = ColorRGBA(r=0.9, g=0.62, b=0.0, a=0.8)
MOVING = ColorRGBA(r=0.34, g=0.71, b=0.91, a=0.8)
ROBOT = ColorRGBA(r=0.0, g=0.62, b=0.45, a=0.7)


class Shapes:
    """Publishes the shapes of a simulation.

    Args:
        node: The node that publishes.
        simulation: The simulation; its robots may come and go.
        clock: Clock of the timer.
    """

    def __init__(self, node: Node, simulation: Simulation, clock: Clock) -> None:
        self._simulation = simulation
        self._objects = node.create_publisher(MarkerArray, "~/objects", LATCHED)
        self._shown: object = None
        walls = node.create_publisher(MarkerArray, "~/walls", LATCHED)
        walls.publish(walls_of(simulation))
        self.publish()
        node.create_timer(PERIOD, self.publish, clock=clock)

    def publish(self) -> None:
        """Publish what moves, is pushed or drives, if anything of it has changed."""
        now = (tuple(_frames(self._simulation).items()), tuple(self._simulation.world.obstacle_poses()))
        if now == self._shown:
            return
        self._shown = now
        self._objects.publish(objects_of(self._simulation))


def walls_of(simulation: Simulation) -> MarkerArray:
    """Return the markers of things that stand in a simulated world."""
    return MarkerArray(markers=list(standing(simulation.world)))


def objects_of(simulation: Simulation) -> MarkerArray:
    """Return the markers of things that move, are pushed or drive in a world, which replace those of before."""
    world = simulation.world
    return MarkerArray(markers=[Marker(action=Marker.DELETEALL), *moving(world), *outlines(world, _frames(simulation))])


def _frames(simulation: Simulation) -> dict[str, str]:
    """Return the frames of the robots by their names."""
    return {name: topics.base_frame for name, topics in simulation.robots.items()}


def standing(world: World) -> Iterator[Marker]:
    """Yield the markers of walls and fixed obstacles."""
    ends = [end for wall in world.description.walls for segment in wall.segments() for end in segment]
    if ends:
        yield Marker(
            header=Header(frame_id=MAP),
            ns="walls",
            type=Marker.LINE_LIST,
            scale=Vector3(x=LINE),
            color=WALL,
            points=[Point(x=x, y=y) for x, y in ends],
        )
    for index, obstacle in enumerate(world.description.obstacles):
        if not _moves(obstacle):
            yield _solid(obstacle, "obstacles", index, FIXED, obstacle.start.place)


def moving(world: World) -> Iterator[Marker]:
    """Yield the markers of obstacles that move by themselves or are pushed, where they are now."""
    for index, (obstacle, pose) in enumerate(zip(world.description.obstacles, world.obstacle_poses(), strict=True)):
        if _moves(obstacle):
            yield _solid(obstacle, "obstacles", index, PUSHED if obstacle.path is None else MOVING, pose)


def outlines(world: World, frames: dict[str, str]) -> Iterator[Marker]:
    """Yield the markers of the robots, each in its own frame, with which it moves."""
    for index, (name, frame) in enumerate(frames.items()):
        marker = _solid(world.robots[name].description.shape, "robots", index, ROBOT, Pose())
        marker.header.frame_id, marker.frame_locked = frame, True
        yield marker


def _moves(obstacle: Obstacle) -> bool:
    return obstacle.path is not None or obstacle.mass is not None


def _solid(shape: Shape, group: str, index: int, color: ColorRGBA, pose: Pose) -> Marker:
    """Return the marker of a shape: a cylinder, a box, or a polygon's outline."""
    there = PoseMessage(position=Point(x=pose.x, y=pose.y), orientation=facing(pose.theta))
    marker = Marker(header=Header(frame_id=MAP), ns=group, id=index, color=color, pose=there)
    if shape.circle is not None:
        marker.type, marker.scale = Marker.CYLINDER, Vector3(x=2 * shape.circle, y=2 * shape.circle, z=HEIGHT)
    elif shape.box is not None:
        marker.type, marker.scale = Marker.CUBE, Vector3(x=shape.box[0], y=shape.box[1], z=HEIGHT)
    else:
        corners = shape.corners()
        marker.type, marker.scale = Marker.LINE_STRIP, Vector3(x=LINE)
        marker.points = [Point(x=x, y=y) for x, y in [*corners, corners[0]]]
    return marker
