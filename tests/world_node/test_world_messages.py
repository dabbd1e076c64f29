"""Messages of simulated robots, with the covariances of their odometry."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.sensor_msgs.msg import Imu as ImuMessage
from robolink.interfaces.sensor_msgs.msg import JointState, LaserScan, Range
from robolink.interfaces.std_msgs.msg import Bool, Header
from robolink.message import decode, encode
from robolink.sim import Inertia, Pose, Scan, Velocity, WheelState, World, WorldDescription
from robolink.sim.description import Odom, OdomNoise, RobotDescription, Settings
from robolink.sim.sensors import Bumper, Encoders, Imu, ImuNoise, Lidar, RangeFinder
from robolink.world_node.messages import Uncertainty, facing, odometry_message, sensor_message, time_message
from robolink.world_node.robot_topics import ABSURD, ABSURD_WHEEL, joint_refusal, sane

HEADER = Header(stamp=time_message(3_000_000_004), frame_id="base_scan")


def sent(message: object) -> object:
    """What a subscription gets of a message."""
    return decode(type(message), encode(message))  # type: ignore[arg-type]


def test_a_time() -> None:
    assert (HEADER.stamp.sec, HEADER.stamp.nanosec) == (3, 4)


def test_a_scan_as_float32_with_its_infinities() -> None:
    ranges = np.array([1.0, math.inf, -math.inf, 0.1])
    scan = Scan(-1.0, 1.0, 0.5, 0.12, 12.0, ranges)
    message = sent(sensor_message(Lidar("scan", rate=8.0), scan, HEADER))
    assert isinstance(message, LaserScan)
    assert list(message.ranges) == [1.0, math.inf, -math.inf, np.float32(0.1)]
    assert (message.scan_time, message.angle_min, message.angle_increment) == (0.125, -1.0, 0.5)
    assert message.range_max == 12.0
    assert message.header == HEADER
    assert len(message.intensities) == 0


def test_a_scan_with_intensities() -> None:
    scan = Scan(-1.0, 1.0, 2.0, 0.12, 12.0, np.array([1.0, 2.0]), np.array([0.5, 0.0]))
    message = sent(sensor_message(Lidar("scan", intensities=True), scan, HEADER))
    assert isinstance(message, LaserScan)
    assert list(message.intensities) == [0.5, 0.0]


def test_an_imu_feels_the_floor_and_knows_its_noise() -> None:
    sensor = Imu("imu", noise=ImuNoise(gyro=0.1, accel=0.5))
    message = sent(sensor_message(sensor, Inertia(math.pi, 0.3, 1.0, 2.0), HEADER))
    assert isinstance(message, ImuMessage)
    assert (message.orientation.z, message.orientation.w) == pytest.approx((1.0, 0.0))
    assert message.angular_velocity == Vector3(z=0.3)
    assert message.linear_acceleration == Vector3(x=1.0, y=2.0, z=9.81)
    assert message.angular_velocity_covariance[8] == pytest.approx(0.01)
    assert list(message.linear_acceleration_covariance) == pytest.approx([0.25, 0, 0, 0, 0.25, 0, 0, 0, 0])


@pytest.mark.parametrize(("radiation", "number"), [("ultrasound", 0), ("infrared", 1)])
def test_a_range(radiation: str, number: int) -> None:
    sensor = RangeFinder("sonar", fov=30.0, range=(0.5, 4.0), noise=0.5, radiation=radiation)  # type: ignore[arg-type]
    message = sent(sensor_message(sensor, math.inf, HEADER))
    assert isinstance(message, Range)
    assert (message.radiation_type, message.min_range, message.max_range) == (number, 0.5, 4.0)
    assert (message.range, message.variance) == (math.inf, 0.25)
    assert message.field_of_view == pytest.approx(math.pi / 6)


def test_wheels_and_a_bumper() -> None:
    wheels = (WheelState("left", 1.5, 0.5), WheelState("right", -1.5, -0.5))
    message = sent(sensor_message(Encoders("wheels"), wheels, HEADER))
    assert isinstance(message, JointState)
    assert message.name == ["left", "right"]
    assert (list(message.position), list(message.velocity)) == ([1.5, -1.5], [0.5, -0.5])
    assert sensor_message(Bumper("bumper"), True, HEADER) == Bool(data=True)


def test_odometry_says_how_sure_it_is() -> None:
    message = odometry_message(HEADER, "base_link", Pose(1.0, 2.0, 0.0), Velocity(0.5, 0.1, 0.2))
    assert not any(message.pose.covariance)
    assert message.twist.twist == Twist(linear=Vector3(x=0.5, y=0.2), angular=Vector3(z=0.1))
    sure = odometry_message(HEADER, "base_link", Pose(1.0, 2.0), Velocity(0.5, 0.1), np.full(36, 2.0), np.full(36, 3.0))
    assert (sure.pose.covariance[35], sure.twist.covariance[0]) == (2.0, 3.0)


@given(st.floats(-10.0, 10.0))
def test_a_rotation_about_z(theta: float) -> None:
    turned = facing(theta)
    assert math.remainder(2 * math.atan2(turned.z, turned.w) - theta, math.tau) == pytest.approx(0.0, abs=1e-12)
    assert math.hypot(turned.z, turned.w) == pytest.approx(1.0)


@pytest.mark.slow
def test_odometry_is_as_sure_as_it_may_be() -> None:
    """Of many robots that drive the same arc, the errors are as great as each says, and go the same way."""
    noise, many = OdomNoise(v=0.3, w=0.3), 150
    robots = tuple(
        RobotDescription(name=f"r{i}", pose=Pose(10.0 * i, 0.0, 0.5), odom=Odom(noise=noise)) for i in range(many)
    )
    world = World(WorldDescription(world=Settings(seed=1), robots=robots))
    said = Uncertainty(noise, world.description.world.dt)
    for step in range(300):
        for robot in world.robots.values():
            robot.command(0.5, 0.6)
        world.step()
        if step % 2:
            first = world.robots["r0"]
            said.advance(first.pose, first.twist, 2)
    errors = np.array(
        [
            (odometry.x - truth.x, odometry.y - truth.y, math.remainder(odometry.theta - truth.theta, math.tau))
            for odometry, truth in ((each.odometry, each.pose) for each in world.robots.values())
        ]
    )
    found = np.cov(errors.T)
    expected = said.of_pose().reshape(6, 6)[np.ix_((0, 1, 5), (0, 1, 5))]
    assert np.sqrt(np.diag(found)) == pytest.approx(np.sqrt(np.diag(expected)), rel=0.25)
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert found / scale == pytest.approx(expected / scale, abs=0.3)
    twist = said.of_twist(Velocity(0.5, 0.6))
    assert (twist[0], twist[35]) == pytest.approx((0.0225, 0.0324))


# Commands


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, 1.01 * ABSURD, -1.01 * ABSURD])
@pytest.mark.parametrize("part", ["linear", "angular"])
@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_a_twist_that_cannot_be_meant(bad: float, part: str, axis: str) -> None:
    assert not sane(Twist(**{part: Vector3(**{axis: bad})}))


def test_a_twist_that_can_be_meant() -> None:
    assert sane(Twist(linear=Vector3(x=ABSURD), angular=Vector3(z=-ABSURD)))


@pytest.mark.parametrize(
    ("names", "speeds", "reason"),
    [
        (["left"], [1.0], ""),
        (["left", "right"], [1.0], "2 motors and 1 velocities"),
        ([], [], "no motor"),
        ([], [1.0], "0 motors and 1 velocities"),
        (["left"], [math.nan], "'left'"),
        (["left", "right"], [0.0, math.inf], "'right'"),
        (["left"], [2 * ABSURD_WHEEL], "'left'"),
    ],
)
def test_a_command_to_wheels_that_cannot_be_meant(names: list[str], speeds: list[float], reason: str) -> None:
    found = joint_refusal(JointState(name=names, velocity=speeds))
    assert reason in found
    assert bool(found) == bool(reason)
