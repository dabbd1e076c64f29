"""Simulation node core: a world and the topics of its robots; it can be changed while it runs."""

from __future__ import annotations

import math
from collections.abc import Sequence

from robolink.control.stop_lock import TOPIC, StopLock
from robolink.exceptions import NotFoundError
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.sim import Pose, Reading, Robot, Shot, World, WorldDescription
from robolink.sim.description import RobotDescription
from robolink.system.terminal import shown
from robolink.world_node.camera_topics import CameraTopics, Compression, Darkroom
from robolink.world_node.messages import time_message
from robolink.world_node.prepared import Stamp, transforms_payload
from robolink.world_node.robot_topics import RobotCommands, RobotTopics

SHOWN = 5
"""Most nodes whose commands are ignored that are named."""

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Simulation:
    """A world whose steps are published by a node.

    The topics of the world file's only robot are in the node's namespace; of several each has its own, and so has
    each spawned one.

    Args:
        node: The node that publishes.
        description: The world.
        epoch: First stamp, in nanoseconds.
        publish_clock: True: publish the simulated time on /clock.
        publish_map: True: publish the transforms from the frame `map` to those of odometry.
        seed: Seed of all noise; None: the description's.
        all_images: True: cameras render and publish also what nobody listens to.
        in_background: True: images are rendered on a thread of their own, and left out if that falls behind.
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
        all_images: bool = False,
        in_background: bool = False,
    ) -> None:
        self.description, self.world = description, World(description, seed=seed)
        self.robots: dict[str, RobotTopics] = {}
        self._wheeled: list[RobotCommands] = []
        self._contacts, self._state_steps = 0, 1
        self._node, self._epoch, self._publish_map, self._seed = node, epoch, publish_map, seed
        self._all_images = all_images
        warn = node.get_logger().warning
        self._compression, self._darkroom = Compression(warn), Darkroom(warn) if in_background else None
        self._clock = node.create_publisher(Clock, "/clock", 10) if publish_clock else None
        self._tf = node.create_publisher(TFMessage, "/tf", 100)
        self._tf_static = node.create_publisher(TFMessage, "/tf_static", LATCHED)
        # Also when others are spawned: topics must not change their names while somebody listens.
        self._only = description.robots[0].name if len(description.robots) == 1 else None
        self.stopped = False
        """True while STOP holds all robots."""
        self._open_topics()
        self._stop = StopLock(node, self._on_stop)

    @property
    def now(self) -> int:
        """The time of stamps, in nanoseconds: it only grows."""
        return self._epoch + self.world.time_ns

    def step(self) -> None:
        """Make one step, and publish all that is due after it."""
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
        stamp = Stamp.of(self.now)
        if self._clock is not None:
            self._clock.publish(stamp.beginning)  # a Clock is nothing but a stamp
        shots = [each for each in readings if isinstance(each.value, Shot)]
        for robot, sensor, value in readings:
            if not isinstance(value, Shot):
                self.robots[robot.name].publish_reading(sensor, value, stamp)
        if step % self._state_steps == 0:
            moved = [each.publish_state(step, stamp) for each in self.robots.values()]
            if transforms := [found for found in moved if found is not None]:
                self._tf.publish(transforms_payload(stamp, transforms))
        for robot, sensor, shot in shots:  # last, since rendering takes time
            self._publish_shot(self.robots[robot.name].camera(sensor), shot, stamp)

    def _publish_shot(self, camera: CameraTopics, shot: Shot, stamp: Stamp) -> None:
        camera.publish_infos(stamp)
        if not camera.is_needed:
            return
        if self._darkroom is None:
            camera.publish(shot, stamp)
        elif not self._darkroom.submit(camera, lambda: camera.publish(shot, stamp)):
            self._node.get_logger().warning(
                f"rendering for {camera.frame} takes too long for its rate: images are left out",
                throttle_duration_sec=5.0,
            )

    def close(self) -> None:
        """Publish the images that are still to be rendered. Safe to call twice."""
        if self._darkroom is not None:
            self._darkroom.close()

    def reset(self) -> None:
        """Reset the world: every robot of the world file is where it started, others are gone; time goes on."""
        # Stamps go on, since a jump back of /clock breaks listeners.
        self._epoch, self.world, self._contacts = self.now, World(self.description, seed=self._seed), 0
        self._open_topics()

    def spawn(self, robot: RobotDescription) -> None:
        """Add a robot to the world. Raises WorldError if it would be inside something."""
        self.world.spawn(robot)
        self._open_topics()

    def delete(self, name: str) -> None:
        """Remove a robot from the world. Raises NotFoundError."""
        self.robot(name)
        self.world.delete(name)
        self._open_topics()

    def teleport(self, name: str, pose: Pose) -> None:
        """Put a robot elsewhere. Raises NotFoundError, and WorldError if it would be inside something."""
        self.robot(name).robot.teleport(pose)
        self.robots[name].place_odometry()
        self._publish_static()

    def robot(self, name: str) -> RobotTopics:
        """Return the topics of a robot. Raises NotFoundError with the nearest name."""
        if name not in self.robots:
            raise NotFoundError("robot", shown(name), self.robots)
        return self.robots[name]

    @property
    def refused(self) -> int:
        """Number of commands that were refused."""
        return sum(topics.commands.refused for topics in self.robots.values())

    def _open_topics(self) -> None:
        """Create the topics of each robot of the world, and destroy all others."""
        robots = self.world.robots
        unchanged = {
            name: topics
            for name, topics in self.robots.items()
            if name in robots and robots[name].description == topics.robot.description
        }
        for name, topics in self.robots.items():
            if name not in unchanged:
                topics.close()
            elif topics.robot is not robots[name]:
                topics.follow(robots[name])
        self.robots = {name: unchanged.get(name) or self._topics(robot) for name, robot in robots.items()}
        self._state_steps = math.gcd(*(topics.state_steps for topics in self.robots.values())) or 1
        self._wheeled = [topics.commands for topics in self.robots.values() if topics.commands.motors]
        self._hold_robots()
        self._publish_static()

    def _on_stop(self, held: bool) -> None:
        self.stopped = held
        self._hold_robots()
        logger = self._node.get_logger()
        if held:
            logger.warning(f"STOP holds ({TOPIC}): {self._ignored()} until it is released")
        else:
            logger.info(f"STOP is released ({TOPIC}): commands are obeyed again")

    def _hold_robots(self) -> None:
        for robot in self.world.robots.values():
            if self.stopped and not robot.held:
                robot.hold()
            elif robot.held and not self.stopped:
                robot.release()

    def _ignored(self) -> str:
        """Return in words which robots stand, and whose commands are ignored."""
        who = sorted({name for topics in self.robots.values() for name in topics.commands.senders()})
        stand = "every robot stands" if len(self.robots) != 1 else f"{next(iter(self.robots))} stands"
        more = f" and {len(who) - SHOWN} more" if len(who) > SHOWN else ""
        return f"{stand}, and commands{' of ' * bool(who)}{', '.join(who[:SHOWN])}{more} are ignored"

    def _topics(self, robot: Robot) -> RobotTopics:
        prefix = "" if robot.name == self._only else f"{robot.name}/"
        return RobotTopics(self._node, robot, prefix, compression=self._compression, all_images=self._all_images)

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
