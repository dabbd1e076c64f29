"""A world and the topics of its robots: each step is published, and the world can be changed while it runs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from robolink.exceptions import NotFoundError, shown
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.sim import Pose, Reading, Robot, World, WorldDescription
from robolink.sim.description import RobotDescription
from robolink.sim_node.messages import time_message
from robolink.sim_node.robot_commands import RobotCommands
from robolink.sim_node.robot_topics import RobotTopics

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Simulation:
    """A world whose steps are published by a node, with stamps from `epoch` (nanoseconds) on.

    The topics of the world file's only robot are in the node's namespace; of several each has its own, and so has
    whatever is spawned. With `publish_map` the frame `map` holds the odometry's frames. `seed` is for all noise, the
    description's by default.
    """

    def __init__(
        self,
        node: Node,
        description: WorldDescription,
        epoch: int,
        *,
        publish_clock: bool = False,
        publish_map: bool = True,
        seed: int | None = None,
    ) -> None:
        self.description, self.world = description, World(description, seed=seed)
        self.robots: dict[str, RobotTopics] = {}
        self._wheeled: list[RobotCommands] = []
        self._contacts, self._state_steps = 0, 1
        self._node, self._epoch, self._publish_map, self._seed = node, epoch, publish_map, seed
        self._clock = node.create_publisher(Clock, "/clock", 10) if publish_clock else None
        self._tf = node.create_publisher(TFMessage, "/tf", 100)
        self._tf_static = node.create_publisher(TFMessage, "/tf_static", LATCHED)
        self._only = description.robots[0].name if len(description.robots) == 1 else None
        self._open_topics()

    @property
    def now(self) -> int:
        """The time that stamps carry, in nanoseconds: it only grows."""
        return self._epoch + self.world.time_ns

    def step(self) -> None:
        """Make one step, and publish what is new after it."""
        world = self.world
        for each in self._wheeled:
            each.step()
        world.step()
        step, readings = world.steps, world.readings()
        if self._clock is not None or readings or step % self._state_steps == 0:
            self._publish(step, readings)
        if world.contacts != self._contacts:
            self._contacts = world.contacts
            self._warn_of_contacts()

    def _publish(self, step: int, readings: Sequence[Reading]) -> None:
        stamp = time_message(self.now)
        if self._clock is not None:
            self._clock.publish(Clock(clock=stamp))
        for robot, sensor, value in readings:
            self.robots[robot.name].publish_reading(sensor, value, stamp)
        if step % self._state_steps == 0:
            moved = [each.publish_state(step, stamp) for each in self.robots.values()]
            if transforms := [found for found in moved if found is not None]:
                self._tf.publish(TFMessage(transforms=transforms))

    def reset(self) -> None:
        """Begin anew: every robot of the world file is where it started, others are gone, and time goes on."""
        self._epoch, self.world, self._contacts = self.now, World(self.description, seed=self._seed), 0
        self._open_topics()

    def spawn(self, robot: RobotDescription) -> None:
        """Put one more robot into the world. Raises WorldError when it would be inside something."""
        self.world.spawn(robot)
        self._open_topics()

    def delete(self, name: str) -> None:
        """Take a robot out of the world. Raises NotFoundError."""
        self.robot(name)
        self.world.delete(name)
        self._open_topics()

    def teleport(self, name: str, pose: Pose) -> None:
        """Put a robot elsewhere. Raises NotFoundError, and WorldError when it would be inside something."""
        self.robot(name).robot.teleport(pose)
        self.robots[name].place_odometry()
        self._publish_static()

    def robot(self, name: str) -> RobotTopics:
        """Give the topics of a robot. Raises NotFoundError with the nearest name."""
        if name not in self.robots:
            raise NotFoundError("robot", shown(name), self.robots)
        return self.robots[name]

    @property
    def refused(self) -> int:
        """How many commands made no sense."""
        return sum(topics.commands.refused for topics in self.robots.values())

    def _open_topics(self) -> None:
        """Have the topics of each robot of the world, and of no other."""
        robots = self.world.robots
        kept = {
            name: topics
            for name, topics in self.robots.items()
            if name in robots and robots[name].description == topics.robot.description
        }
        for name, topics in self.robots.items():
            if name not in kept:
                topics.close()
            elif topics.robot is not robots[name]:
                topics.follow(robots[name])
        self.robots = {name: kept.get(name) or self._topics(robot) for name, robot in robots.items()}
        self._state_steps = math.gcd(*(topics.state_steps for topics in self.robots.values())) or 1
        self._wheeled = [topics.commands for topics in self.robots.values() if topics.commands.motors]
        self._publish_static()

    def _topics(self, robot: Robot) -> RobotTopics:
        return RobotTopics(self._node, robot, "" if robot.name == self._only else f"{robot.name}/")

    def _warn_of_contacts(self) -> None:
        for topics in self.robots.values():
            if topics.touched():
                name, pose = topics.robot.name, topics.robot.pose
                self._node.get_logger().warning(
                    f"{name} ran into something at ({pose.x:.2f}, {pose.y:.2f})", throttle_duration_sec=1.0
                )

    def _publish_static(self) -> None:
        stamp = time_message(self.now)
        found = [
            each
            for topics in self.robots.values()
            for each in topics.static_transforms(stamp, on_map=self._publish_map)
        ]
        self._tf_static.publish(TFMessage(transforms=found))
