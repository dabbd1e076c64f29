"""Simulate a world: its robots obey cmd_vel and publish scan, odom and tf."""

import math
from typing import Any

from robolink import Node, Time
from robolink.clock import Clock
from robolink.clock_type import ClockType
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMessage
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rosgraph_msgs.msg import Clock as ClockMessage
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.sim import Pose as PlanePose
from robolink.sim import Robot, Scan, World, load_world
from robolink.sim.worldfile import steps_between
from robolink.workspace import find_world

TICK = 0.01
"""Seconds between two looks at the clock; shorter steps are made in bunches."""

BACKLOG = 0.5
"""Seconds that the simulation may be late and still catches up; what is more is given up."""

ABSURD = 1000.0
"""m/s or rad/s: a command beyond this is a mistake, not a wish."""

FASTEST = 1000.0

REPORTED = 5
"""Of so many robots the log tells where they are."""


class SimulatedWorld(Node):
    """Runs a world at `rtf` times real time; 0 is as fast as it goes.

    The topics of the only robot are in this node's namespace; of several each has its own. Stamps are the time
    of the start plus simulated time, or with `publish_clock` simulated time alone.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__("world", **options)
        wanted = self.declare_parameter("world", "obstacles").value
        description = load_world(find_world(wanted))
        rtf = self.declare_parameter("rtf", description.world.rtf).value
        if not 0.0 <= rtf <= FASTEST:
            raise InvalidParameterValueException("rtf", rtf, f"expected 0 (as fast as it goes) to {FASTEST:g}")
        publish_clock = self.declare_parameter("publish_clock", False).value
        self.world = World(description)
        prefixed = len(self.world.robots) > 1
        self.ports = [Port(self, robot, f"{name}/" if prefixed else "") for name, robot in self.world.robots.items()]
        self.tf = self.create_publisher(TFMessage, "/tf", 100)
        self.clock = self.create_publisher(ClockMessage, "/clock", 10) if publish_clock else None
        self.epoch = 0 if publish_clock else self.get_clock().now().nanoseconds
        self.steady = Clock(clock_type=ClockType.STEADY_TIME, time_base=self.context.time)
        self.pace = Pace(self.steady.now().nanoseconds, self.world.dt_ns, rtf)
        self.create_timer(self.pace.period, self.on_tick, clock=self.steady)
        self.create_timer(2.0, self.report, clock=self.steady)
        robots = ", ".join(self.world.robots) or "no robot"
        self.get_logger().info(f"world '{description.world.name or wanted}' with {robots}")

    def on_tick(self) -> None:
        """Make the steps that are due."""
        steps, lost = self.pace.due(self.steady.now().nanoseconds)
        for _ in range(steps):
            self.step()
        if lost > 0.0:
            self.get_logger().warning(f"gave up {lost:.1f} s of simulated time: too late", throttle_duration_sec=5.0)

    def step(self) -> None:
        """Make one step, and publish what is new after it."""
        self.world.step()
        stamp = Time(nanoseconds=self.epoch + self.world.time_ns).to_msg()
        if self.clock is not None:
            self.clock.publish(ClockMessage(clock=stamp))
        if transforms := [each for port in self.ports for each in port.publish(self.world.steps, stamp)]:
            self.tf.publish(TFMessage(transforms=transforms))

    def report(self) -> None:
        """Say where the robots are and what they do."""
        for port in self.ports[:REPORTED]:
            pose = port.robot.pose
            self.get_logger().info(said(port.robot, self.world.nearest_wall_distance(pose.x, pose.y)))


class Pace:
    """How many steps of a world are due by the clock, without drift; `period` is the seconds between two looks."""

    def __init__(self, start: int, dt: int, rtf: float) -> None:
        self.start, self.dt, self.rtf = start, dt, rtf
        self.bunch = max(1, round(TICK * 1e9 * (rtf or 1.0) / dt))
        self.period = self.bunch * dt / rtf / 1e9 if rtf else 1e-6
        self.done = 0

    def due(self, now: int) -> tuple[int, float]:
        """Give the steps to make at `now`, and the simulated seconds that are given up, for it is too late."""
        if not self.rtf:
            return self.bunch, 0.0
        behind = int((now - self.start) * self.rtf) // self.dt - self.done
        steps = min(behind, max(self.bunch, int(BACKLOG * 1e9 * self.rtf) // self.dt))
        lost = (behind - steps) * self.dt
        self.start += int(lost / self.rtf)
        self.done += steps
        return steps, lost / 1e9


class Port:
    """The topics of one robot; `prefix` goes before their names and those of the robot's frames."""

    def __init__(self, node: Node, robot: Robot, prefix: str) -> None:
        self.node, self.robot, self.prefix = node, robot, prefix
        self.refused = self.contacts = 0
        self.odom = node.create_publisher(Odometry, f"{prefix}odom", 10)
        self.odom_steps = steps_between(robot.description.odom.rate, robot.dt)
        self.scans = {
            each.lidar: (steps_between(each.rate, robot.dt), node.create_publisher(LaserScan, prefix + each.lidar, 10))
            for each in robot.description.sensors
        }
        node.create_subscription(Twist, f"{prefix}cmd_vel", self.on_cmd_vel, 10)

    def on_cmd_vel(self, twist: Twist) -> None:
        """Drive so, unless that is nonsense."""
        if not sane(twist):
            self.refused += 1
            if self.refused == 1:
                self.node.get_logger().warning(f"ignored a cmd_vel that is not finite or absurd: {twist}")
            return
        self.robot.command(twist.linear.x, twist.angular.z)

    def publish(self, step: int, stamp: TimeMessage) -> list[TransformStamped]:
        """Publish what is due after a step; give the transforms that belong to it."""
        self.warn_of_contact()
        for name, (steps, publisher) in self.scans.items():
            if step % steps == 0:
                frame = f"{self.prefix}base_{name}"
                seconds = steps * self.robot.dt
                publisher.publish(scan_message(self.robot.scan(name), Header(stamp=stamp, frame_id=frame), seconds))
        if step % self.odom_steps:
            return []
        odom, base = f"{self.prefix}odom", f"{self.prefix}base_link"
        self.odom.publish(odometry_message(self.robot, Header(stamp=stamp, frame_id=odom), base))
        return [
            transform(Header(stamp=stamp, frame_id=odom), base, self.robot.odometry),
            *(
                transform(Header(stamp=stamp, frame_id=base), f"{self.prefix}base_{each.lidar}", each.offset)
                for each in self.robot.description.sensors
            ),
        ]

    def warn_of_contact(self) -> None:
        """Say that the robot has run into something."""
        if self.robot.contacts > self.contacts:
            pose = self.robot.pose
            self.node.get_logger().warning(
                f"{self.robot.name} ran into something at ({pose.x:.2f}, {pose.y:.2f})", throttle_duration_sec=1.0
            )
        self.contacts = self.robot.contacts


def sane(twist: Twist) -> bool:
    """Say whether a command can be meant: every number finite and below `ABSURD`."""
    linear, angular = twist.linear, twist.angular
    return all(abs(each) <= ABSURD for part in (linear, angular) for each in (part.x, part.y, part.z))


def scan_message(scan: Scan, header: Header, seconds: float) -> LaserScan:
    """Make the message of a scan; all its beams are of one instant, and the next comes in `seconds`."""
    return LaserScan(
        header=header,
        angle_min=scan.angle_min,
        angle_max=scan.angle_max,
        angle_increment=scan.angle_increment,
        scan_time=seconds,
        range_min=scan.range_min,
        range_max=scan.range_max,
        ranges=scan.ranges,
    )


def odometry_message(robot: Robot, header: Header, base: str) -> Odometry:
    """Make the message of a robot's odometry; nothing is said about how sure it is."""
    pose, twist = robot.odometry, robot.twist
    return Odometry(
        header=header,
        child_frame_id=base,
        pose=PoseWithCovariance(pose=Pose(position=Point(x=pose.x, y=pose.y), orientation=facing(pose.theta))),
        twist=TwistWithCovariance(twist=Twist(linear=Vector3(x=twist.v), angular=Vector3(z=twist.w))),
    )


def transform(header: Header, child: str, pose: PlanePose) -> TransformStamped:
    """Make the transform of a frame that stands at a pose in the header's frame."""
    there = Transform(translation=Vector3(x=pose.x, y=pose.y), rotation=facing(pose.theta))
    return TransformStamped(header=header, child_frame_id=child, transform=there)


def facing(theta: float) -> Quaternion:
    """Give the rotation by `theta` radians about z."""
    return Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))


def said(robot: Robot, wall: float) -> str:
    """Say where a robot is and what it does; `wall` is the distance to the nearest wall in metres."""
    pose, (v, w) = robot.pose, robot.twist
    turning = round(math.degrees(w))
    parts = [
        f"{robot.name} at ({pose.x:.2f}, {pose.y:.2f}) heading {round(math.degrees(pose.theta))} deg",
        f"{v:.2f} m/s",
        f"turning {'left' if turning > 0 else 'right'} at {abs(turning)} deg/s" if turning else "",
        f"nearest wall {wall:.2f} m",
        "in contact" if robot.touching else "",
    ]
    return ", ".join(filter(None, parts))
