"""The controllers as nodes: what their parameters say and refuse, what they do without scans, and how they end."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink import Node, Parameter
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.std_msgs.msg import Header
from robolink.logging import LoggingSeverity
from robolink.parameter_client import AsyncParameterClient
from robolink.testing import System
from tests.support.nodefiles import load_node_file

simulation = load_node_file("world")
WallFollower = load_node_file("wall_follower").WallFollower
ReactiveController = load_node_file("reactive_controller").ReactiveController
CONTROLLERS: list[type[Node]] = [WallFollower, ReactiveController]
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
            limits: dict[str, Any] = {
                "range_min": 0.1,
                "range_max": 10.0,
                "angle_min": -math.pi,
                "angle_increment": math.tau / 360,
            }
            self.scan.publish(LaserScan(header=Header(stamp=stamp), scan_time=0.1, ranges=self.ranges, **limits))


@BOTH
def test_every_parameter_says_what_it_is_and_which_values_it_takes(system: System, controller: type[Node]) -> None:
    node = system.start(controller)
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
def test_a_speed_that_cannot_be_is_refused_with_the_reason(
    system: System, controller: type[Node], value: float
) -> None:
    node = system.start(controller)
    (result,) = node.set_parameters([Parameter("speed", value=value)])
    assert not result.successful
    assert "parameter 'speed' out of range" in result.reason
    with pytest.raises(InvalidParameterValueException, match="speed"):
        system.start(controller, parameters={"speed": value})


def test_another_node_changes_the_side_and_the_next_scan_follows_it(system: System) -> None:
    lidar, node = system.start(Lidar), system.start(WallFollower)
    lidar.ranges[90] = lidar.ranges[270] = 0.4  # on both sides
    client = AsyncParameterClient(lidar, "wall_follower")
    system.run(0.35)
    (result,) = system.result(client.set_parameters([Parameter("side", value="top")])).results
    assert (result.successful, result.reason) == (False, "side: expected 'left' or 'right', got 'top'")
    assert node.get_parameter("side").value == "right"
    (result,) = system.result(client.set_parameters([Parameter("side", value="left")])).results
    assert result.successful
    system.run(3.0)
    said = [record.message for record in system.logs if record.name == "wall_follower"]
    assert said[0].startswith("following the wall on the right at 0.4")
    assert said[-1].startswith("following the wall on the left at 0.4")


def test_a_side_that_is_none_is_refused_at_the_start(system: System) -> None:
    with pytest.raises(InvalidParameterValueException, match="expected 'left' or 'right', got 'top'"):
        system.start(WallFollower, parameters={"side": "top"})


@BOTH
def test_a_new_speed_takes_effect_with_the_next_scan(system: System, controller: type[Node]) -> None:
    lidar, node = system.start(Lidar), system.start(controller)
    system.run(1.05)
    usual = node.get_parameter("speed").value
    assert lidar.heard[-1].linear.x == pytest.approx(usual)
    node.set_parameters([Parameter("speed", value=0.1)])
    assert len(lidar.heard) == 10
    system.run(0.1)
    assert [each.linear.x for each in lidar.heard[-2:]] == pytest.approx([usual, 0.1])


@BOTH
def test_without_scans_it_stops_once_and_says_so_and_goes_on_with_the_next(
    system: System, controller: type[Node]
) -> None:
    lidar, _ = system.start(Lidar), system.start(controller, parameters={"timeout": 0.35})
    system.run(1.05)
    lidar.is_on = False
    system.run(0.25)
    assert len(lidar.heard) == 10
    system.run(5.0)
    assert len(lidar.heard) == 11
    assert lidar.heard[-1] == Twist()
    assert [record.message for record in system.logs if "no scan" in record.message] == [
        "no scan on /scan for 0.35 s: the robot stands until one comes"
    ]
    lidar.is_on = True
    system.run(1.05)
    assert len(lidar.heard) == 21
    assert lidar.heard[-1].linear.x > 0.0
    lidar.is_on = False
    system.run(1.0)
    assert lidar.heard[-1] == Twist()


@BOTH
def test_the_timeout_can_be_changed_while_it_runs(system: System, controller: type[Node]) -> None:
    lidar, node = system.start(Lidar), system.start(controller)
    system.run(0.45)
    node.set_parameters([Parameter("timeout", value=2.0)])
    system.run(0.1)
    lidar.is_on = False
    system.run(1.9)
    assert len(lidar.heard) == 5
    system.run(0.2)
    assert lidar.heard[5:] == [Twist()]


@BOTH
def test_a_robot_that_nobody_drives_is_left_alone(system: System, controller: type[Node]) -> None:
    lidar = system.start(Lidar)
    lidar.is_on = False
    node = system.start(controller)
    system.run(4.9)  # a world may take that long to start beside it
    assert [record.message for record in system.logs] == []
    system.run(10.0)
    assert [record.message for record in system.logs] == ["no scan on /scan for 5 s: the robot stands until one comes"]
    node.destroy_node()
    system.run(0.1)
    assert lidar.heard == []


@BOTH
def test_it_stops_the_robot_when_it_is_destroyed(system: System, controller: type[Node]) -> None:
    lidar, node = system.start(Lidar), system.start(controller)
    system.run(0.55)
    assert lidar.heard[-1].linear.x > 0.0
    node.destroy_node()
    node.destroy_node()
    system.run(0.2)
    assert lidar.heard[5:] == [Twist()]


@BOTH
def test_it_stops_the_robot_when_its_context_ends(system: System, controller: type[Node]) -> None:
    lidar, node = system.start(Lidar), system.start(controller)
    system.run(0.15)
    system.stop(node)
    system.run(0.01)
    assert len(lidar.heard) == 2
    assert lidar.heard[0].linear.x > 0.0
    assert lidar.heard[1] == Twist()


@BOTH
def test_it_logs_at_most_once_in_two_seconds(system: System, controller: type[Node]) -> None:
    system.start(Lidar)
    system.start(controller)
    system.run(10.05)
    assert 5 <= len(system.logs) <= 6


@pytest.mark.slow
@pytest.mark.parametrize(("controller", "name"), [(WallFollower, "corners"), (ReactiveController, "obstacles")])
def test_in_the_world_itself_it_drives_and_touches_nothing(system: System, controller: type[Node], name: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": name})
    system.start(controller)
    start = system.robot().pose
    system.run(30.0)
    robot = system.robot()
    assert robot.contacts == 0
    assert math.hypot(robot.pose.x - start.x, robot.pose.y - start.y) > 0.5
    assert not [record for record in system.logs if record.severity >= LoggingSeverity.WARN]
