"""The nodes of the simulation in memory and virtual time: topics, pace, safety, the same life twice."""

from __future__ import annotations

import hashlib
import math
from pathlib import Path
from typing import Any

import pytest

from robolink import Node, RobolinkError
from robolink.exceptions import InvalidParameterValueException
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.testing import System
from tests.support.nodefiles import load_node_file
from tests.support.systems import START, log

simulation, follower, reactive, teleop = map(
    load_node_file, ("world", "wall_follower", "reactive_controller", "teleop")
)


def stamps(messages: list[Any]) -> list[float]:
    return [each.header.stamp.sec + each.header.stamp.nanosec * 1e-9 - START * 1e-9 for each in messages]


def links(message: TFMessage) -> list[tuple[str, str]]:
    return [(each.header.frame_id, each.child_frame_id) for each in message.transforms]


def test_a_world_publishes_scan_odom_and_tf_at_their_rates(system: System) -> None:
    scans, odometry, transforms = (
        system.messages("/scan"),
        system.messages("/odom"),
        system.messages("/tf"),
    )
    system.start(simulation.SimulatedWorld, parameters={"world": "corners"})
    system.run(1.005)
    assert stamps(scans) == pytest.approx([0.1 * (i + 1) for i in range(10)])
    assert stamps(odometry) == pytest.approx([0.02 * (i + 1) for i in range(50)])
    scan, odom = scans[0], odometry[0]
    assert (scan.header.frame_id, len(scan.ranges), scan.scan_time) == ("base_scan", 360, pytest.approx(0.1))
    assert scan.ranges[90] == pytest.approx(0.9)
    assert (odom.header.frame_id, odom.child_frame_id) == ("odom", "base_link")
    assert (odom.pose.pose.position.x, odom.pose.pose.position.y) == (3.0, 0.9)
    assert stamps([each.transforms[0] for each in transforms]) == stamps(odometry)
    assert links(transforms[0]) == [("odom", "base_link")]
    assert transforms[0].transforms[0].transform.translation == Vector3(x=3.0, y=0.9)


def test_a_second_world_is_warned_of_once(system: System) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    system.run(3.0)
    assert "another" not in " ".join(each.message for each in system.logs)
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    system.run(6.0)
    warnings = [each.message for each in system.logs if "another" in each.message]
    assert len(warnings) == 2  # one of each
    assert warnings[0].startswith("another world runs in domain ")
    assert "end one with Ctrl-C" in warnings[0]


def test_a_command_drives_and_half_a_second_without_one_stops(system: System) -> None:
    odometry = system.messages("/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    cmd_vel = system.node.create_publisher(Twist, "/cmd_vel", 10)
    system.run(0.1)
    cmd_vel.publish(Twist(linear=Vector3(x=0.3), angular=Vector3(z=0.5)))
    system.run(0.45)
    velocity = odometry[-1].twist.twist
    assert (velocity.linear.x, velocity.angular.z) == pytest.approx((0.3, 0.5))
    assert velocity == Twist(linear=Vector3(x=velocity.linear.x), angular=Vector3(z=velocity.angular.z))
    system.run(0.5)
    assert odometry[-1].twist.twist.linear.x == pytest.approx(0.0)
    assert 3.1 < odometry[-1].pose.pose.position.x < 3.3
    assert odometry[-1].pose.pose.orientation.z > 0.1


def test_nonsense_on_cmd_vel_is_ignored_counted_and_warned_about_once(system: System) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    cmd_vel = system.node.create_publisher(Twist, "/cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.3)))
    for x, z in ((math.nan, 0.0), (0.0, math.inf), (1e9, 0.0), (0.0, -1e9)):
        cmd_vel.publish(Twist(linear=Vector3(x=x), angular=Vector3(z=z)))
    cmd_vel.publish(Twist(linear=Vector3(y=math.nan)))
    system.run(0.3)
    assert world.simulation.refused == 5
    assert world.simulation.world.robots["robot"].twist.v == pytest.approx(0.3)
    assert sum("ignored a cmd_vel" in line for line in log(system)) == 1


def test_the_log_tells_within_two_seconds_where_the_robot_is(system: System) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    system.run(2.001)
    assert "world 'empty_room' with robot" in log(system)
    assert "robot at (3.00, 3.00) heading 0 deg, 0.00 m/s, nearest wall 3.00 m" in log(system)


def test_running_into_a_wall_is_warned_about(system: System) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    cmd_vel = system.node.create_publisher(Twist, "/cmd_vel", 10)
    system.node.create_timer(0.1, lambda: cmd_vel.publish(Twist(linear=Vector3(x=0.5))))
    system.run(8.0)
    assert any(line.startswith("robot ran into something at (5.8") for line in log(system))
    assert any(line.endswith("in contact") for line in log(system))


TWO = """
robots:
  - {name: r1, pose: [0, 0], sensors: [{lidar: scan, beams: 4, offset: [0.1, 0]}]}
  - {name: r2, pose: [2, 0], drive: {timeout: 5}}
"""


def test_each_of_several_robots_has_a_namespace(system: System, tmp_path: Path) -> None:
    path = tmp_path / "two.yaml"
    path.write_text(TWO)
    scans, odometry, transforms = (
        system.messages("/lab/r1/scan"),
        system.messages("/lab/r2/odom"),
        system.messages("/tf"),
    )
    system.start(simulation.SimulatedWorld, parameters={"world": str(path)}, namespace="lab")
    cmd_vel = system.node.create_publisher(Twist, "/lab/r2/cmd_vel", 10)
    cmd_vel.publish(Twist(linear=Vector3(x=0.5)))
    system.run(2.0)
    assert scans[-1].header.frame_id == "r1/base_scan"
    assert scans[0].ranges[2] == pytest.approx(1.73, abs=0.01)
    assert scans[-1].ranges[2] > 2.0
    assert odometry[-1].header.frame_id == "r2/odom"
    frames = {each.child_frame_id for message in transforms for each in message.transforms}
    assert frames == {"r1/base_link", "r2/base_link"}
    assert len(transforms[0].transforms) == 2


def test_with_its_clock_published_time_counts_from_zero(system: System) -> None:
    clocks, scans = system.messages("/clock"), system.messages("/scan")
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room", "publish_clock": True})
    system.run(0.105)
    assert [each.clock.nanosec for each in clocks] == [10_000_000 * (i + 1) for i in range(10)]
    assert scans[0].header.stamp == clocks[-1].clock


def test_a_world_can_run_faster_than_time(system: System) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room", "rtf": 4.0})
    system.run(1.0)
    assert world.simulation.world.time_ns == pytest.approx(4e9, abs=5e7)


def test_as_fast_as_it_goes_is_the_pace_of_virtual_time(system: System) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room", "rtf": 0.0})
    system.run(3.0)
    assert world.simulation.world.time_ns == pytest.approx(3e9, abs=5e7)


@pytest.mark.parametrize("rtf", [-1.0, math.nan, math.inf])
def test_an_impossible_pace_is_refused(system: System, rtf: float) -> None:
    with pytest.raises(InvalidParameterValueException, match="rtf"):
        system.start(simulation.SimulatedWorld, parameters={"rtf": rtf})


def test_an_unknown_world_is_an_error_of_robolink(system: System) -> None:
    with pytest.raises(RobolinkError, match=r"cornrs.*did you mean 'corners'"):
        system.start(simulation.SimulatedWorld, parameters={"world": "cornrs"})


LIFE = 20.0  # s


def life(controller: type[Node], world: str) -> str:
    """The beginning of a robot's life: a hash of all that was published."""
    digest = hashlib.sha256()
    with System() as system:
        for topic, kind in (("/scan", LaserScan), ("/odom", Odometry), ("/tf", TFMessage), ("/cmd_vel", Twist)):
            system.node.create_subscription(kind, topic, digest.update, 1000, raw=True)
        system.start(simulation.SimulatedWorld, parameters={"world": world})
        system.start(controller)
        system.run(LIFE)
        assert system.robot().contacts == 0
    return digest.hexdigest()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("controller", "world"), [(follower.WallFollower, "corners"), (reactive.ReactiveController, "obstacles")]
)
def test_a_life_is_the_same_twice(controller: type[Node], world: str) -> None:
    assert life(controller, world) == life(controller, world)


@pytest.mark.parametrize(
    ("controller", "words"),
    [(follower.WallFollower, "following the wall on the right at"), (reactive.ReactiveController, "driving ahead, ")],
)
def test_a_controller_says_what_it_does(system: System, controller: type[Node], words: str) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "corners"})
    system.start(controller)
    system.run(1.0)
    assert any(line.startswith(words) for line in log(system))


def test_a_follower_knows_two_sides(system: System) -> None:
    with pytest.raises(InvalidParameterValueException, match="expected 'left' or 'right'"):
        system.start(follower.WallFollower, parameters={"side": "top"})
