"""Programs that robolink brings, on DDS beside a real ROS 2."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import pytest

from tests.dds.conftest import Lab, real
from tests.dds.peers import Peer, until

pytestmark = pytest.mark.processes

STRING = "std_msgs/msg/String"


@pytest.fixture
def robot(lab: Lab) -> Iterator[Peer]:
    real("kilted")
    with lab.real("kilted", "robot") as peer:
        yield peer.ready()


def test_the_talker_and_the_listener_of_the_demos_speak_with_a_real_node(lab: Lab, robot: Peer) -> None:
    robot.ask("subscription", topic="/chatter", type_name=STRING, field="data")
    robot.ask("publisher", topic="/chatter", type_name=STRING)
    with (
        lab.command("direct", "run", "demo_nodes_py", "listener", merged=True) as listener,
        lab.command("direct", "run", "demo_nodes_cpp", "talker"),
    ):
        robot.wait("/chatter")
        assert any("Hello World" in each["value"] for each in robot.events("/chatter"))
        numbers = itertools.count(1)

        def heard() -> bool:
            robot.ask("publish", topic="/chatter", first=next(numbers))
            return any("hello" in line.text for line in listener.lines)

        until(heard, "the listener hears the real node")


def test_a_real_node_drives_the_simulated_robot_and_sees_by_its_laser(lab: Lab, robot: Peer) -> None:
    robot.ask("publisher", topic="/cmd_vel", type_name="geometry_msgs/msg/Twist")
    robot.ask("subscription", topic="/scan", type_name="sensor_msgs/msg/LaserScan", field="ranges", reliable=False)
    robot.ask("subscription", topic="/odom", type_name="nav_msgs/msg/Odometry", field="pose.pose.position.x")
    with lab.command("direct", "run", "world"):
        [scan, *_] = robot.wait("/scan")
        assert len(scan["value"]) > 100
        begin = robot.wait("/odom")[0]["value"]

        def moved() -> bool:
            robot.ask("publish", topic="/cmd_vel", first=1)  # 1 m/s
            return bool(abs(robot.events("/odom")[-1]["value"] - begin) > 0.05)

        until(moved, "the robot drives")
