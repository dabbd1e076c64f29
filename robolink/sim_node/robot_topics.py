"""What one simulated robot publishes: what it senses, where it believes to be, and where it truly is."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from robolink import plane
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Header
from robolink.node import Node
from robolink.plane import placed_on
from robolink.publisher import Publisher
from robolink.sim import Pose, Robot
from robolink.sim.checks.robots import tells_joints
from robolink.sim.description import Encoders, OdomNoise, Sensor, steps_between
from robolink.sim_node.messages import (
    joint_state_message,
    odometry_message,
    sensor_message,
    sensor_type,
    transform_message,
)
from robolink.sim_node.robot_commands import RobotCommands
from robolink.sim_node.uncertainty import Uncertainty

MAP = "map"
"""The frame of the world itself."""


class RobotTopics:
    """The topics of one robot; `prefix` goes before their names and those of the robot's frames.

    Wheels that no encoders count are told on joint_states, with the odometry, as they truly turn.
    """

    def __init__(self, node: Node, robot: Robot, prefix: str) -> None:
        description = robot.description
        self.odom_frame, self.base_frame = f"{prefix}odom", f"{prefix}base_link"
        self.commands = RobotCommands(node, robot, prefix)
        self._node, self._prefix = node, prefix
        self._publishers: list[Publisher[Any]] = []
        self._odom = self._publisher(Odometry, "odom")
        self._truth = self._publisher(Odometry, "ground_truth")
        self._sensors = {
            each.topic: (self._publisher(sensor_type(each), each.topic), self._frame_of(each))
            for each in description.sensors
        }
        self._joints = self._publisher(JointState, "joint_states") if tells_joints(description) else None
        self._odom_steps = steps_between(description.odom.rate, robot.dt)
        self._truth_steps = steps_between(description.ground_truth.rate, robot.dt)
        self.follow(robot)

    def follow(self, robot: Robot) -> None:
        """Tell of this robot from now on: the same one in a world that has begun anew."""
        self.robot = robot
        self.commands.follow(robot)
        noise = robot.description.odom.noise
        self._uncertainty = None if noise == OdomNoise() else Uncertainty(noise, robot.dt)
        self._contacts = 0
        self.place_odometry()

    def place_odometry(self) -> None:
        """Lay the odometry's frame on the map so that the robot stands where it is now."""
        truth, believed = self.robot.pose, self.robot.odometry
        turn = truth.theta - believed.theta
        x, y, _ = placed_on(plane.Pose(theta=turn), believed.place)
        self._odom_on_map = Pose(truth.x - x, truth.y - y, turn)

    def publish_reading(self, sensor: Sensor, value: Any, stamp: Time) -> None:
        """Publish what a sensor has measured."""
        publisher, frame = self._sensors[sensor.topic]
        publisher.publish(sensor_message(sensor, value, Header(stamp=stamp, frame_id=frame)))

    @property
    def state_steps(self) -> int:
        """Only at multiples of so many steps is anything due of odometry and ground truth."""
        return math.gcd(self._truth_steps, self._odom_steps)

    def publish_state(self, step: int, stamp: Time) -> TransformStamped | None:
        """Publish what is due at a step of odometry and ground truth; give the transform that the odometry tells."""
        if step % self._truth_steps == 0:
            header = Header(stamp=stamp, frame_id=MAP)
            self._truth.publish(odometry_message(header, self.base_frame, self.robot.pose, self.robot.twist))
        if step % self._odom_steps:
            return None
        if self._joints is not None:
            self._joints.publish(joint_state_message(self.robot.wheels, Header(stamp=stamp)))
        return self._publish_odometry(Header(stamp=stamp, frame_id=self.odom_frame))

    def _publish_odometry(self, header: Header) -> TransformStamped:
        pose, twist, sure = self.robot.odometry, self.robot.odometry_twist, self._uncertainty
        if sure is None:
            message = odometry_message(header, self.base_frame, pose, twist)
        else:
            sure.advance(pose, twist, self._odom_steps)
            message = odometry_message(header, self.base_frame, pose, twist, sure.of_pose(), sure.of_twist(twist))
        self._odom.publish(message)
        return transform_message(header, self.base_frame, pose)

    def static_transforms(self, stamp: Time, *, on_map: bool) -> Iterator[TransformStamped]:
        """Yield where the sensors are on the robot and, if that is asked for, where its odometry is on the map."""
        if on_map:
            yield transform_message(Header(stamp=stamp, frame_id=MAP), self.odom_frame, self._odom_on_map)
        for each in self.robot.description.sensors:
            if each.mount is not None:
                header = Header(stamp=stamp, frame_id=self.base_frame)
                yield transform_message(header, self._frame_of(each), each.mount)

    def touched(self) -> bool:
        """Whether the robot has run into something since this was asked last."""
        before, self._contacts = self._contacts, self.robot.contacts
        return self._contacts > before

    def close(self) -> None:
        """Publish no more, and take no more commands."""
        self.commands.close()
        for each in self._publishers:
            self._node.destroy_publisher(each)

    def _publisher(self, message: type[Any], topic: str) -> Publisher[Any]:
        self._publishers.append(self._node.create_publisher(message, f"{self._prefix}{topic}", 10))
        return self._publishers[-1]

    def _frame_of(self, sensor: Sensor) -> str:
        """Give a sensor's frame: its own if it can be mounted anywhere; encoders are nowhere."""
        if sensor.mount is not None:
            return f"{self._prefix}base_{sensor.topic}"
        return "" if isinstance(sensor, Encoders) else self.base_frame
