"""The simulated world: integer time, robots that drive by force, exact lidars; the same for the same seed.

world = World(load_world("configs/worlds/obstacles.yaml"))
robot = world.robots["robot"]
robot.command(0.3, 0.0)
world.step()
print(robot.pose, robot.scan().ranges.min())
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType

import pymunk

from robolink.exceptions import NotFoundError
from robolink.geometry import plane
from robolink.sim.checks.appearance import robot_picture_problems
from robolink.sim.checks.robots import robot_problems
from robolink.sim.checks.shapes import Problem
from robolink.sim.checks.worlds import mass_problems
from robolink.sim.description import Obstacle, RobotDescription, WorldDescription
from robolink.sim.driving.fleet import Fleet
from robolink.sim.physics.bodies import body_at, floor_friction, pushable_body, solids, wall_shapes
from robolink.sim.physics.contacts import Contacts
from robolink.sim.physics.mover import Mover
from robolink.sim.physics.placing import WorldError, check_pose
from robolink.sim.robot import Robot, WorldParts
from robolink.sim.schedule import Reading, Schedule
from robolink.sim.sensing.scene import Scene, nearest_wall_distance
from robolink.system.terminal import shown

_ITERATIONS = 20

_LOOK = 0.1
"""Period in seconds at which the robots' positions count into their areas: more often would cost and show no more."""


class World:
    """A simulated world with its robots; to reset it, make another one.

    Time is `steps` times `dt_ns`: an integer. Everything is a pure function of the description, the seed and the
    commands with the steps at which they came. `robots` are those that are in the world now, by their names.

    Args:
        description: The world, as from `load_world`.
        seed: Seed of all noise; None: that of the description.
    """

    def __init__(self, description: WorldDescription, *, seed: int | None = None) -> None:
        self.description = description
        self.dt_ns = round(description.world.dt * 1e9)
        self.steps = 0
        self._dt = dt = description.world.dt
        self._steps_between_looks = max(1, round(_LOOK / dt))
        self._space = space = _space(description)
        self._scene, self._fleet, self._contacts = Scene(description, space), Fleet(space), Contacts(space, dt)
        self._movers: list[Mover] = []
        self._obstacles: list[pymunk.Body] = []
        for obstacle in description.obstacles:
            self._add_obstacle(obstacle)
        seed = description.world.seed if seed is None else seed
        self._parts = WorldParts(self._space, self._scene, self._fleet, self._contacts, dt, seed, description.walls)
        self._robots: dict[str, Robot] = {}
        self.robots: Mapping[str, Robot] = MappingProxyType(self._robots)
        for robot in description.robots:
            self._add_robot(robot)
        self._plan()

    @property
    def time_ns(self) -> int:
        """Simulated time since the start, in nanoseconds."""
        return self.steps * self.dt_ns

    @property
    def contacts(self) -> int:
        """Number of contacts of robots that have begun since the start, with those of robots that have left."""
        return self._contacts.begun

    def step(self) -> None:
        """Advance the world by one step."""
        self._fleet.advance(self.steps)
        for mover in self._movers:
            mover.aim(self.steps + 1)
        self._space.step(self._dt)
        self.steps += 1
        self._scene.step = self.steps
        self._contacts.measure()
        self._fleet.moved()
        if self.steps % self._steps_between_looks == 0:
            for robot in self._robots.values():
                robot.note_place()

    def readings(self) -> list[Reading]:
        """Measure with all sensors that are due at the present step; each call is a new measurement."""
        return self._schedule.readings(self.steps)

    def spawn(self, description: RobotDescription) -> Robot:
        """Add a robot to the world and return it.

        Args:
            description: The robot, as in a world file.

        Raises:
            WorldError: if its name is taken, if it would start inside of something, or if `load_world` would refuse
                it in a world file.
        """
        for problem in self._problems(description):
            raise WorldError(f"robot '{shown(description.name)}': {problem.path}: {problem.message}")
        check_pose(description.name, description.pose)
        robot = self._add_robot(description)
        try:
            robot._check_place(description.pose)
        except WorldError:
            self.delete(robot.name)
            raise
        self._plan()
        return robot

    def _problems(self, robot: RobotDescription) -> Iterator[Problem]:
        """Yield the problems of a robot to spawn in this world."""
        for each in itertools.chain(robot_problems(robot, self._dt), robot_picture_problems(robot, Path())):
            yield each._replace(path=each.path.removeprefix("."))
        if all(robot.mass > each.mass for each in self.description.robots):  # else it makes nothing worse
            for each in mass_problems([robot], self.description.obstacles):
                yield each._replace(path=each.path.removeprefix("$."))
        for other in self._robots.values():
            yield from (each._replace(path="mass") for each in mass_problems([robot, other.description], ()))

    def delete(self, name: str) -> None:
        """Remove the robot called `name`. Raises `NotFoundError` if there is none."""
        if name not in self._robots:
            raise NotFoundError("robot", shown(name), self._robots)
        self._robots.pop(name)._leave()
        self._plan()

    def nearest_wall_distance(self, x: float, y: float) -> float:
        """Return the metres from the point `x`, `y` to the nearest wall or fixed obstacle; inf if there is none."""
        return nearest_wall_distance(self._scene.fixed_segments, self._scene.fixed_circles, x, y)

    def obstacle_poses(self) -> list[plane.Pose]:
        """Return where the description's obstacles are now, in their order."""
        return [plane.Pose(*each.position, each.angle) for each in self._obstacles]

    def _plan(self) -> None:
        """Make the schedule of all present sensors."""
        sensors = [(robot, each) for robot in self._robots.values() for each in robot._devices.values()]
        self._schedule = Schedule(sensors, self._dt)

    def _add_robot(self, description: RobotDescription) -> Robot:
        if description.name in self._robots:
            raise WorldError(f"there is a robot named '{description.name}' already")
        robot = self._robots[description.name] = Robot(description, self._parts)
        robot._enter()
        return robot

    def _add_obstacle(self, obstacle: Obstacle) -> None:
        if obstacle.path is not None:
            mover = Mover(obstacle, self._dt)
            self._movers.append(mover)
            body = mover.body
        elif obstacle.mass is not None:
            body = pushable_body(obstacle, obstacle.mass)
        else:
            body = body_at(obstacle.start, None, obstacle)
        self._obstacles.append(body)
        shapes = solids(obstacle, body)
        self._space.add(body, *shapes)
        if obstacle.path is not None:
            self._contacts.add_mover(shapes)
        elif obstacle.mass is not None:
            self._contacts.add_pushable(body)
            self._space.add(*floor_friction(body, self._space.static_body, obstacle))
        if body.body_type != pymunk.Body.STATIC:
            self._scene.add(body, obstacle, obstacle.reflectance, len(self._obstacles) - 1)


def _space(description: WorldDescription) -> pymunk.Space:
    """Make a Chipmunk space with its walls; contacts are solved to a tenth of a millimetre."""
    space = pymunk.Space()
    space.iterations = _ITERATIONS
    space.collision_slop = 1e-4
    for wall in description.walls:
        space.add(*wall_shapes(wall, space.static_body))
    return space
