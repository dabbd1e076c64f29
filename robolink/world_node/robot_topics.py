"""Topics of a robot: the commands that it obeys, and what it publishes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from robolink.exceptions import nearest
from robolink.geometry import plane
from robolink.geometry.plane import placed_on
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.geometry_msgs.msg import TransformStamped, Twist, TwistStamped
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import Header
from robolink.node import Node
from robolink.publisher import Publisher
from robolink.sim import Pose, Robot, Scan
from robolink.sim.checks.robots import tells_joints
from robolink.sim.description import OdomNoise, steps_between
from robolink.sim.sensors import Camera, Lidar, Sensor
from robolink.subscription import Subscription
from robolink.system.terminal import shown
from robolink.world_node.camera_topics import CameraTopics, Compression
from robolink.world_node.messages import (
    Uncertainty,
    joint_state_message,
    sensor_message,
    sensor_type,
    transform_message,
)
from robolink.world_node.prepared import PreparedOdometry, PreparedScan, PreparedTransform, Stamp, packed_pose

ABSURD = 1000.0
"""Largest plausible speed of a command, in m/s or rad/s."""

ABSURD_WHEEL = 100_000.0
"""Largest plausible speed of a wheel, in rad/s."""


class RobotCommands:
    """The subscriptions of one robot: cmd_vel, and joint_command if it has wheels; `refused` counts refused commands.

    A refused command changes nothing: the robot goes on with the last good one until its timeout. The world's motors
    know none, so that wheels are stopped from here: a controller that has died must not drive on. While somebody
    publishes joint_command, cmd_vel is for them to obey: both at once would be two drivers.
    """

    def __init__(self, node: Node, robot: Robot, prefix: str) -> None:
        self.refused = 0
        self.motors = [each.motor for each in robot.description.wheels]
        self._node = node
        self._warned: set[str] = set()
        self._timeout = max(1, round(robot.description.drive.timeout / robot.dt))
        self.follow(robot)
        self._cmd_vel: Subscription[Any]
        if robot.description.drive.stamped:
            self._cmd_vel = node.create_subscription(TwistStamped, f"{prefix}cmd_vel", self._on_stamped, 10)
        else:
            self._cmd_vel = node.create_subscription(Twist, f"{prefix}cmd_vel", self._on_cmd_vel, 10)
        self._joint_command: Subscription[JointState] | None = None
        if self.motors:
            topic = f"{prefix}joint_command"
            self._joint_command = node.create_subscription(JointState, topic, self._on_joint_command, 10)

    def follow(self, robot: Robot) -> None:
        """Command this robot from now on; it has had no command yet."""
        self.robot, self._steps_left = robot, 0

    def step(self) -> None:
        """Stop wheels whose last command is too old; call it before each step of the world."""
        if self._steps_left:
            self._steps_left -= 1
            if not self._steps_left:
                self.robot.turn_wheels(dict.fromkeys(self.motors, 0.0))

    def senders(self) -> set[str]:
        """Return the full names of the nodes that publish commands, but for hidden ones, which are tools."""
        topics = [each.topic_name for each in (self._cmd_vel, self._joint_command) if each is not None]
        ends = (end for topic in topics for end in self._node.get_publishers_info_by_topic(topic))
        shown = (each for each in ends if not each.node_name.startswith("_"))
        return {f"{each.node_namespace.rstrip('/')}/{each.node_name}" for each in shown}

    def close(self) -> None:
        """Destroy the subscriptions."""
        self._node.destroy_subscription(self._cmd_vel)
        if self._joint_command is not None:
            self._node.destroy_subscription(self._joint_command)

    def _on_stamped(self, command: TwistStamped) -> None:
        self._on_cmd_vel(command.twist)

    def _on_cmd_vel(self, twist: Twist) -> None:
        if not sane(twist):
            self._refuse("cmd_vel", f"ignored a cmd_vel that is not finite or absurd: {twist}")
        elif self._joint_command is None or not self._joint_command.get_publisher_count():
            self._steps_left = 0
            self.robot.command(twist.linear.x, twist.angular.z, twist.linear.y)

    def _on_joint_command(self, command: JointState) -> None:
        if reason := joint_refusal(command):
            self._refuse("joint_command", f"ignored a joint_command{reason}")
            return
        speeds = dict(zip(command.name, command.velocity, strict=True))
        if unknown := [name for name in speeds if name not in self.motors]:
            refused = f"'{shown(unknown[0])}', which the robot has not{nearest(unknown[0], self.motors)}"
            known = ", ".join(self.motors)
            self._refuse("motor", f"ignored a joint_command's motor {refused}; there is: {known}")
        if known_ones := {name: speed for name, speed in speeds.items() if name in self.motors}:
            self.robot.turn_wheels(known_ones)
            self._steps_left = self._timeout + 1  # `step` is called once before the command's own first step

    def _refuse(self, what: str, text: str) -> None:
        self.refused += 1
        if what not in self._warned:
            self._warned.add(what)
            self._node.get_logger().warning(f"{self.robot.name}: {text} (the next ones are only counted)")


def sane(twist: Twist) -> bool:
    """True if a command is plausible: every number finite and at most `ABSURD`."""
    linear, angular = twist.linear, twist.angular
    return all(abs(each) <= ABSURD for part in (linear, angular) for each in (part.x, part.y, part.z))


def joint_refusal(command: JointState) -> str:
    """Return the reason to refuse a command to wheels; '' if there is none."""
    names, speeds = len(command.name), len(command.velocity)
    if names != speeds:
        return f" that names {names} motors and {speeds} velocities"
    if not names:
        return " that names no motor"
    bad = [name for name, speed in zip(command.name, command.velocity, strict=True) if not abs(speed) <= ABSURD_WHEEL]
    return f" whose velocity of '{shown(bad[0])}' is not finite or absurd" if bad else ""


MAP = "map"
"""Frame of the world itself."""


class RobotTopics:
    """The topics of one robot; `prefix` goes before their names and those of the robot's frames.

    Wheels without encoders are published on joint_states, with the odometry, as they truly turn.

    With `all_images` cameras render also what nobody listens to; `compression` is that of their images.
    """

    def __init__(
        self, node: Node, robot: Robot, prefix: str, *, compression: Compression, all_images: bool = False
    ) -> None:
        description = robot.description
        self.odom_frame, self.base_frame = f"{prefix}odom", f"{prefix}base_link"
        self.commands = RobotCommands(node, robot, prefix)
        self._node, self._prefix = node, prefix
        self._publishers: list[Publisher[Any]] = []
        self._scans: dict[str, PreparedScan] = {}
        self._on_map = PreparedOdometry(MAP, self.base_frame)
        self._on_odom = PreparedOdometry(self.odom_frame, self.base_frame)
        self._transform = PreparedTransform(self.odom_frame, self.base_frame)
        self._odom = self._publisher(Odometry, "odom")
        self._truth = self._publisher(Odometry, "ground_truth")
        self._sensors = {
            each.topic: (self._publisher(sensor_type(each), each.topic), self._frame_of(each))
            for each in description.sensors
            if not isinstance(each, Camera)
        }
        self._cameras = {
            each.topic: CameraTopics(each, prefix, self._publisher, always=all_images, compression=compression)
            for each in description.sensors
            if isinstance(each, Camera)
        }
        self._joints = self._publisher(JointState, "joint_states") if tells_joints(description) else None
        self._odom_steps = steps_between(description.odom.rate, robot.dt)
        self._truth_steps = steps_between(description.ground_truth.rate, robot.dt)
        self.follow(robot)

    def follow(self, robot: Robot) -> None:
        """Publish this robot from now on: the same one after a reset of the world."""
        self.robot = robot
        self.commands.follow(robot)
        noise = robot.description.odom.noise
        self._uncertainty = None if noise == OdomNoise() else Uncertainty(noise, robot.dt)
        self._contacts = 0
        self.place_odometry()

    def place_odometry(self) -> None:
        """Place the odometry's frame on the map so that the robot stands where it is now."""
        # Its true pose, so that /odom can be compared with the world file.
        truth, believed = self.robot.pose, self.robot.odometry
        turn = truth.theta - believed.theta
        x, y, _ = placed_on(plane.Pose(theta=turn), believed.place)
        self._odom_on_map = Pose(truth.x - x, truth.y - y, turn)

    def publish_reading(self, sensor: Sensor, value: Any, stamp: Stamp) -> None:
        """Publish a sensor's measurement."""
        # Heard or not: who listens should change nothing, and a recorder that comes by a wildcard misses nothing.
        publisher, frame = self._sensors[sensor.topic]
        if isinstance(sensor, Lidar):
            publisher.publish(self._prepared_scan(sensor, value, frame).payload(stamp, value))
        else:
            publisher.publish(sensor_message(sensor, value, Header(stamp=stamp.message, frame_id=frame)))

    def camera(self, sensor: Sensor) -> CameraTopics:
        """Return the topics of a camera."""
        return self._cameras[sensor.topic]

    def _prepared_scan(self, lidar: Lidar, scan: Scan, frame: str) -> PreparedScan:
        found = self._scans.get(lidar.topic)
        if found is None:
            found = self._scans[lidar.topic] = PreparedScan(scan, frame, lidar)
        return found

    @property
    def state_steps(self) -> int:
        """Number of steps at whose multiples odometry or ground truth may be due."""
        return math.gcd(self._truth_steps, self._odom_steps)

    def publish_state(self, step: int, stamp: Stamp) -> tuple[PreparedTransform, bytes] | None:
        """Publish odometry and ground truth if due at a step; return the transform of the odometry, or None."""
        if step % self._truth_steps == 0:
            pose = packed_pose(self.robot.pose)
            self._truth.publish(self._on_map.payload(stamp, pose, self.robot.twist))
        if step % self._odom_steps:
            return None
        if self._joints is not None:
            self._joints.publish(joint_state_message(self.robot.wheels, Header(stamp=stamp.message)))
        return self._transform, self._publish_odometry(stamp)

    def _publish_odometry(self, stamp: Stamp) -> bytes:
        believed, twist, sure = self.robot.odometry, self.robot.odometry_twist, self._uncertainty
        pose = packed_pose(believed)
        if sure is None:
            payload = self._on_odom.payload(stamp, pose, twist)
        else:
            sure.advance(believed, twist, self._odom_steps)
            payload = self._on_odom.payload(stamp, pose, twist, sure.of_pose(), sure.of_twist(twist))
        self._odom.publish(payload)
        return pose

    def static_transforms(self, stamp: Time, *, on_map: bool) -> Iterator[TransformStamped]:
        """Yield the transforms of the sensors on the robot and, with `on_map`, of its odometry on the map."""
        if on_map:
            yield transform_message(Header(stamp=stamp, frame_id=MAP), self.odom_frame, self._odom_on_map)
        for each in self.robot.description.sensors:
            if each.topic in self._cameras:
                yield from self._cameras[each.topic].transforms(stamp, self.base_frame)
            elif each.mount is not None:
                header = Header(stamp=stamp, frame_id=self.base_frame)
                yield transform_message(header, self._frame_of(each), each.mount)

    def touched(self) -> bool:
        """Return True if the robot has run into something since the last call."""
        before, self._contacts = self._contacts, self.robot.contacts
        return self._contacts > before

    def close(self) -> None:
        """Destroy the publishers and subscriptions."""
        self.commands.close()
        for each in self._publishers:
            self._node.destroy_publisher(each)

    def _publisher(self, message: type[Any], topic: str) -> Publisher[Any]:
        self._publishers.append(self._node.create_publisher(message, f"{self._prefix}{topic}", 10))
        return self._publishers[-1]

    def _frame_of(self, sensor: Sensor) -> str:
        """Return a sensor's frame: its own if it has a mount, else base_link; '' for encoders."""
        if sensor.mount is not None:
            return f"{self._prefix}base_{sensor.topic}"
        return self.base_frame if sensor.has_frame else ""
