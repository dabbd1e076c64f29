"""A world and the topics of its robots: each step is published, and the world can be changed while it runs."""

from __future__ import annotations

import math

from robolink.exceptions import NotFoundError
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.sim import Pose, Robot, World, WorldDescription
from robolink.sim.description import RobotDescription
from robolink.sim_node.commands import Commands
from robolink.sim_node.messages import time_message
from robolink.sim_node.port import Port

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Simulation:
    """A world whose steps are published by a node, with stamps from `epoch` (nanoseconds) on.

    The topics of the world file's only robot are in the node's namespace; of several each has its own, and so has
    whatever is spawned. With `publish_map` the frame `map` holds the odometry's frames.
    """

    def __init__(
        self,
        node: Node,
        description: WorldDescription,
        epoch: int,
        *,
        publish_clock: bool = False,
        publish_map: bool = True,
    ) -> None:
        self.description, self.world = description, World(description)
        self.ports: dict[str, Port] = {}
        self._wheeled: list[Commands] = []
        self._contacts, self._state_steps = 0, 1
        self._node, self._epoch, self._publish_map = node, epoch, publish_map
        self._clock = node.create_publisher(Clock, "/clock", 10) if publish_clock else None
        self._tf = node.create_publisher(TFMessage, "/tf", 100)
        self._tf_static = node.create_publisher(TFMessage, "/tf_static", LATCHED)
        self._only = description.robots[0].name if len(description.robots) == 1 else None
        self._open_ports()

    @property
    def now(self) -> int:
        """The time that stamps carry, in nanoseconds: it only grows."""
        return self._epoch + self.world.time_ns

    def step(self) -> None:
        """Make one step, and publish what is new after it."""
        world, ports = self.world, self.ports
        for each in self._wheeled:
            each.step()
        world.step()
        stamp, step = time_message(self.now), world.steps
        if self._clock is not None:
            self._clock.publish(Clock(clock=stamp))
        for robot, sensor, value in world.readings():
            ports[robot.name].publish_reading(sensor, value, stamp)
        if step % self._state_steps == 0:
            moved = [port.publish_state(step, stamp) for port in ports.values()]
            if transforms := [each for each in moved if each is not None]:
                self._tf.publish(TFMessage(transforms=transforms))
        if world.contacts != self._contacts:
            self._contacts = world.contacts
            self._warn_of_contacts()

    def reset(self) -> None:
        """Begin anew: every robot of the world file is where it started, others are gone, and time goes on."""
        self._epoch, self.world, self._contacts = self.now, World(self.description), 0
        self._open_ports()

    def spawn(self, robot: RobotDescription) -> None:
        """Put one more robot into the world. Raises WorldError when it would be inside something."""
        self.world.spawn(robot)
        self._open_ports()

    def delete(self, name: str) -> None:
        """Take a robot out of the world. Raises NotFoundError."""
        self.robot(name)
        self.world.delete(name)
        self._open_ports()

    def teleport(self, name: str, pose: Pose) -> None:
        """Put a robot elsewhere. Raises NotFoundError, and WorldError when it would be inside something."""
        self.robot(name).robot.teleport(pose)
        self.ports[name].place_odometry()
        self._publish_static()

    def robot(self, name: str) -> Port:
        """Give the port of a robot. Raises NotFoundError with the nearest name."""
        if name not in self.ports:
            raise NotFoundError("robot", name, self.ports)
        return self.ports[name]

    @property
    def refused(self) -> int:
        """How many commands made no sense."""
        return sum(port.commands.refused for port in self.ports.values())

    @property
    def contacts(self) -> int:
        """How often robots have run into something since the world began."""
        return sum(port.robot.contacts for port in self.ports.values())

    def _open_ports(self) -> None:
        """Have a port for each robot of the world, and for no other."""
        robots = self.world.robots
        kept = {
            name: port
            for name, port in self.ports.items()
            if name in robots and robots[name].description == port.robot.description
        }
        for name, port in self.ports.items():
            if name not in kept:
                port.close()
            elif port.robot is not robots[name]:
                port.follow(robots[name])
        self.ports = {name: kept.get(name) or self._port(robot) for name, robot in robots.items()}
        self._state_steps = math.gcd(*(port.state_steps for port in self.ports.values())) or 1
        self._wheeled = [port.commands for port in self.ports.values() if port.commands.motors]
        self._publish_static()

    def _port(self, robot: Robot) -> Port:
        return Port(self._node, robot, "" if robot.name == self._only else f"{robot.name}/")

    def _warn_of_contacts(self) -> None:
        for port in self.ports.values():
            if port.touched():
                name, pose = port.robot.name, port.robot.pose
                self._node.get_logger().warning(
                    f"{name} ran into something at ({pose.x:.2f}, {pose.y:.2f})", throttle_duration_sec=1.0
                )

    def _publish_static(self) -> None:
        stamp = time_message(self.now)
        found = [
            each for port in self.ports.values() for each in port.static_transforms(stamp, on_map=self._publish_map)
        ]
        self._tf_static.publish(TFMessage(transforms=found))
