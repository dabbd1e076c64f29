"""The controllers as nodes: what their parameters say and refuse, what they do without scans, and how they end."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from robolink import Context, Node, Parameter, VirtualTime
from robolink.exceptions import InvalidParameterValueException
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.logging import LoggingSeverity
from robolink.parameter_client import AsyncParameterClient
from robolink.transport.memory import Bus, MemoryTransport
from tests.nodefiles import load_node_file
from tests.spins import done, spin_for

simulation = load_node_file("world")
WallFollower = load_node_file("wall_follower").WallFollower
ReactiveController = load_node_file("reactive_controller").ReactiveController
Making = Callable[..., Any]
CONTROLLERS: list[Making] = [WallFollower, ReactiveController]
BOTH = pytest.mark.parametrize("controller", CONTROLLERS)


class Lidar(Node):
    """Publishes what it is told to, ten times a second, and hears what comes of it."""

    def __init__(self, **options: Any) -> None:
        super().__init__("lidar", **options)
        self.ranges = [math.inf] * 360
        self.is_on = True
        self.heard = list[Twist]()
        self.scan = self.create_publisher(LaserScan, "scan", 10)
        self.create_subscription(Twist, "cmd_vel", self.heard.append, 100)
        self.create_timer(0.1, self.on_timer)

    def on_timer(self) -> None:
        if self.is_on:
            stamp = self.get_clock().now().to_msg()
            limits = {"range_min": 0.1, "range_max": 10.0, "angle_min": -math.pi, "angle_increment": math.tau / 360}
            self.scan.publish(LaserScan(header=Header(stamp=stamp), scan_time=0.1, ranges=self.ranges, **limits))


@pytest.fixture
def make(virtual: Context, executor: SingleThreadedExecutor) -> Making:
    def made(node_class: Callable[..., Any], **values: Any) -> Any:
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        node = node_class(context=virtual, parameter_overrides=overrides)
        executor.add_node(node)
        return node

    return made


@BOTH
def test_every_parameter_says_what_it_is_and_which_values_it_takes(make: Making, controller: Making) -> None:
    node = make(controller)
    every_nodes = {"use_sim_time", "start_type_description_service"}
    own = set(node.list_parameters([], 0).names) - every_nodes
    assert own > {"speed", "turn_speed", "timeout"}
    for name in own:
        descriptor = node.describe_parameter(name)
        assert descriptor.description
        assert not descriptor.read_only
        if name == "side":
            assert descriptor.additional_constraints == "left or right"
        else:
            (limits,) = descriptor.floating_point_range
            assert limits.from_value < node.get_parameter(name).value < limits.to_value


@BOTH
@pytest.mark.parametrize("value", [0.0, -1.0, 100.0, math.nan, math.inf])
def test_a_speed_that_cannot_be_is_refused_with_the_reason(make: Making, controller: Making, value: float) -> None:
    node = make(controller)
    (result,) = node.set_parameters([Parameter("speed", value=value)])
    assert not result.successful
    assert "parameter 'speed' out of range" in result.reason
    with pytest.raises(InvalidParameterValueException, match="speed"):
        make(controller, speed=value)


def test_another_node_changes_the_side_and_the_next_scan_follows_it(
    make: Making, executor: SingleThreadedExecutor, log_lines: list[Record]
) -> None:
    lidar, node = make(Lidar), make(WallFollower)
    lidar.ranges[90] = lidar.ranges[270] = 0.4  # on both sides
    client = AsyncParameterClient(lidar, "wall_follower")
    spin_for(executor, 0.35)
    (result,) = done(executor, client.set_parameters([Parameter("side", value="top")])).results
    assert (result.successful, result.reason) == (False, "side: expected 'left' or 'right', got 'top'")
    assert node.get_parameter("side").value == "right"
    (result,) = done(executor, client.set_parameters([Parameter("side", value="left")])).results
    assert result.successful
    spin_for(executor, 3.0)
    said = [record.message for record in log_lines if record.name == "wall_follower"]
    assert said[0].startswith("following the wall on the right at 0.4")
    assert said[-1].startswith("following the wall on the left at 0.4")


def test_a_side_that_is_none_is_refused_at_the_start(make: Making) -> None:
    with pytest.raises(InvalidParameterValueException, match="expected 'left' or 'right', got 'top'"):
        make(WallFollower, side="top")


@BOTH
def test_a_new_speed_takes_effect_with_the_next_scan(
    make: Making, executor: SingleThreadedExecutor, controller: Making
) -> None:
    lidar, node = make(Lidar), make(controller)
    spin_for(executor, 1.05)
    usual = node.get_parameter("speed").value
    assert lidar.heard[-1].linear.x == pytest.approx(usual)
    node.set_parameters([Parameter("speed", value=0.1)])
    assert len(lidar.heard) == 10
    spin_for(executor, 0.1)
    assert [each.linear.x for each in lidar.heard[-2:]] == pytest.approx([usual, 0.1])


@BOTH
def test_without_scans_it_stops_once_and_says_so_and_goes_on_with_the_next(
    make: Making, executor: SingleThreadedExecutor, log_lines: list[Record], controller: Making
) -> None:
    lidar, _ = make(Lidar), make(controller, timeout=0.35)
    spin_for(executor, 1.05)
    lidar.is_on = False
    spin_for(executor, 0.25)
    assert len(lidar.heard) == 10
    spin_for(executor, 5.0)
    assert len(lidar.heard) == 11
    assert lidar.heard[-1] == Twist()
    assert [record.message for record in log_lines if "no scan" in record.message] == [
        "no scan on /scan for 0.35 s: the robot stands until one comes"
    ]
    lidar.is_on = True
    spin_for(executor, 1.05)
    assert len(lidar.heard) == 21
    assert lidar.heard[-1].linear.x > 0.0
    lidar.is_on = False
    spin_for(executor, 1.0)
    assert lidar.heard[-1] == Twist()


@BOTH
def test_the_timeout_can_be_changed_while_it_runs(
    make: Making, executor: SingleThreadedExecutor, controller: Making
) -> None:
    lidar, node = make(Lidar), make(controller)
    spin_for(executor, 0.45)
    node.set_parameters([Parameter("timeout", value=2.0)])
    spin_for(executor, 0.1)
    lidar.is_on = False
    spin_for(executor, 1.9)
    assert len(lidar.heard) == 5
    spin_for(executor, 0.2)
    assert lidar.heard[5:] == [Twist()]


@BOTH
def test_a_robot_that_nobody_drives_is_left_alone(
    make: Making, executor: SingleThreadedExecutor, log_lines: list[Record], controller: Making
) -> None:
    lidar = make(Lidar)
    lidar.is_on = False
    node = make(controller)
    spin_for(executor, 3.0)
    assert sum("no scan on /scan" in record.message for record in log_lines) == 1
    node.destroy_node()
    spin_for(executor, 0.1)
    assert lidar.heard == []


@BOTH
def test_it_stops_the_robot_when_it_is_destroyed(
    make: Making, executor: SingleThreadedExecutor, controller: Making
) -> None:
    lidar, node = make(Lidar), make(controller)
    spin_for(executor, 0.55)
    assert lidar.heard[-1].linear.x > 0.0
    node.destroy_node()
    node.destroy_node()
    spin_for(executor, 0.2)
    assert lidar.heard[5:] == [Twist()]


@BOTH
def test_it_stops_the_robot_when_its_context_ends(
    make: Making, executor: SingleThreadedExecutor, bus: Bus, controller: Making
) -> None:
    lidar = make(Lidar)
    other = Context(transport=MemoryTransport(bus=bus), time=VirtualTime())
    other.init([])
    with other, SingleThreadedExecutor(context=other) as theirs:
        theirs.add_node(controller(context=other))
        spin_for(executor, 0.15)
        theirs.spin_once(timeout_sec=0.0)
    spin_for(executor, 0.01)
    assert len(lidar.heard) == 2
    assert lidar.heard[0].linear.x > 0.0
    assert lidar.heard[1] == Twist()


@BOTH
def test_it_logs_at_most_once_in_two_seconds(
    make: Making, executor: SingleThreadedExecutor, log_lines: list[Record], controller: Making
) -> None:
    make(Lidar)
    make(controller)
    spin_for(executor, 10.05)
    assert 5 <= len(log_lines) <= 6


@pytest.mark.parametrize(("controller", "name"), [(WallFollower, "corners"), (ReactiveController, "obstacles")])
def test_in_the_world_itself_it_drives_and_touches_nothing(
    make: Making, executor: SingleThreadedExecutor, log_lines: list[Record], controller: Making, name: str
) -> None:
    world = make(simulation.SimulatedWorld, world=name)
    make(controller)
    spin_for(executor, 30.0)
    (robot,) = world.simulation.world.robots.values()
    assert robot.contacts == 0
    assert math.hypot(robot.pose.x - robot.description.pose.x, robot.pose.y - robot.description.pose.y) > 0.5
    assert not [record for record in log_lines if record.severity >= LoggingSeverity.WARN]
