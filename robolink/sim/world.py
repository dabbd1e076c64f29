"""The simulated world: integer time, robots that drive by force, exact lidars; the same for the same seed.

world = World(load_world("configs/worlds/obstacles.yaml"))
robot = world.robots["robot"]
robot.command(0.3, 0.0)
world.step()
print(robot.pose, robot.scan().ranges.min())
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import pymunk

from robolink.sim.bodies import body_at, floor_friction, solid, wall_shapes
from robolink.sim.description import Obstacle, WorldDescription
from robolink.sim.geometry import nearest_wall_distance
from robolink.sim.robot import Robot
from robolink.sim.scene import Scene

_ROBOT = 1
_ITERATIONS = 20


class World:
    """A world made from a description; to reset it, make another one.

    Time is `steps` times `dt_ns`: an integer. Everything is a pure function of the description, the seed (by
    default the description's) and the commands with the steps at which they came.
    """

    def __init__(self, description: WorldDescription, *, seed: int | None = None) -> None:
        self.description = description
        self.dt_ns = round(description.world.dt * 1e9)
        self.steps = 0
        self._dt = description.world.dt
        self._space = _space(description)
        self._scene = Scene(description)
        for obstacle in description.obstacles:
            self._add_obstacle(obstacle)
        seed = description.world.seed if seed is None else seed
        robots = [Robot(each, description, self._scene, seed) for each in description.robots]
        self.robots: Mapping[str, Robot] = MappingProxyType({robot.name: robot for robot in robots})
        self._robots, self._by_shape = robots, {robot.shape: robot for robot in robots}
        for robot in robots:
            robot.shape.collision_type = _ROBOT
            self._space.add(robot.body, robot.shape)
        self._space.on_collision(_ROBOT, None, begin=self._begin, pre_solve=self._touch, separate=self._separate)

    @property
    def time_ns(self) -> int:
        """Simulated nanoseconds since the start."""
        return self.steps * self.dt_ns

    def step(self) -> None:
        """Move the world on by one step of `dt`."""
        for robot in self._robots:
            robot.advance()
        self._space.step(self._dt)
        self.steps += 1
        self._scene.step = self.steps

    def nearest_wall_distance(self, x: float, y: float) -> float:
        """Give the distance in metres from a point to the nearest wall or fixed obstacle; inf if there is none."""
        return nearest_wall_distance(self._scene.fixed_segments, self._scene.fixed_circles, x, y)

    def _add_obstacle(self, obstacle: Obstacle) -> None:
        body = body_at(obstacle.pose, obstacle.mass, obstacle)
        self._space.add(body, solid(obstacle, body))
        if obstacle.mass is not None:
            self._space.add(*floor_friction(body, self._space.static_body, obstacle))
            self._scene.add(body, obstacle)

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        """Count a contact; when two robots meet, each is the first shape of a call of its own."""
        robot = self._by_shape[arbiter.shapes[0]]
        robot.contacts += 1
        robot.touching += 1

    def _touch(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        robot = self._by_shape[arbiter.shapes[0]]
        deepest = max((-point.distance for point in arbiter.contact_point_set.points), default=0.0)
        robot.penetration = max(robot.penetration, deepest)

    def _separate(self, arbiter: pymunk.Arbiter, space: pymunk.Space, data: object) -> None:
        robot = self._by_shape.get(arbiter.shapes[0])
        if robot is not None:  # a space that goes away names the shapes in any order
            robot.touching -= 1


def _space(description: WorldDescription) -> pymunk.Space:
    """Make a space with its walls; contacts are solved to a tenth of a millimetre."""
    space = pymunk.Space()
    space.iterations = _ITERATIONS
    space.collision_slop = 1e-4
    for wall in description.walls:
        space.add(*wall_shapes(wall, space.static_body))
    return space
