"""The topics of simulated robots: every sensor, wheels, frames, diagnostics, and many robots at once."""

from __future__ import annotations

import hashlib
import math
from pathlib import Path

import pytest

from robolink.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from robolink.interfaces.geometry_msgs.msg import Twist, TwistStamped, Vector3
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.sensor_msgs.msg import Imu, JointState, LaserScan, Range
from robolink.interfaces.std_msgs.msg import Bool
from robolink.interfaces.std_srvs.srv import Trigger
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.node import Node
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from robolink.tf2.buffer import Buffer
from robolink.tf2.transform_listener import TransformListener
from robolink.time import Time
from robolink.workspace import list_worlds
from tests.support.nodefiles import ROOT, load_node_file
from tests.support.systems import ask, log, made_with

simulation = load_node_file("world")
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
LAB = {
    "/ada/scan": LaserScan,
    "/ada/bumper": Bool,
    "/ada/imu": Imu,
    "/ada/sonar": Range,
    "/ada/joint_states": JointState,
    "/ada/odom": Odometry,
    "/ada/ground_truth": Odometry,
    "/bob/scan": LaserScan,
    "/bob/left": Range,
    "/bob/odom": Odometry,
    "/tf": TFMessage,
}


def world_of(text: str, folder: Path) -> str:
    path = folder / "world.yaml"
    path.write_text(text)
    return str(path)


def drive(system: System, topic: str, v: float, w: float = 0.0, sideways: float = 0.0) -> None:
    """Keep telling a robot to drive so."""
    publisher = system.node.create_publisher(Twist, topic, 10)
    twist = Twist(linear=Vector3(x=v, y=sideways), angular=Vector3(z=w))
    system.node.create_timer(0.1, lambda: publisher.publish(twist))


def test_every_sensor_of_the_lab_has_its_topic_rate_and_frame(system: System) -> None:
    heard = {topic: system.messages(topic) for topic, kind in LAB.items()}
    system.start(simulation.SimulatedWorld, parameters={"world": "lab"})
    system.run(1.005)
    counts = {topic: len(messages) for topic, messages in heard.items()}
    fast = dict.fromkeys(("/ada/imu", "/ada/joint_states", "/ada/odom", "/bob/odom", "/tf"), 50)
    assert counts == dict.fromkeys(LAB, 10) | fast
    frames = {topic: messages[0].header.frame_id for topic, messages in heard.items() if hasattr(messages[0], "header")}
    assert frames == {
        "/ada/scan": "ada/base_scan",
        "/ada/imu": "ada/base_link",
        "/ada/sonar": "ada/base_sonar",
        "/ada/joint_states": "",
        "/ada/odom": "ada/odom",
        "/ada/ground_truth": "map",
        "/bob/scan": "bob/base_scan",
        "/bob/left": "bob/base_left",
        "/bob/odom": "bob/odom",
    }
    assert len(heard["/ada/scan"][0].intensities) == 360
    assert heard["/ada/odom"][-1].twist.covariance[0] == 0.0  # it stands still
    assert heard["/ada/joint_states"][0].name == ["left_wheel", "right_wheel"]


def test_an_omni_robot_goes_sideways(system: System) -> None:
    world, odometry = system.start(simulation.SimulatedWorld, parameters={"world": "lab"}), system.messages("/bob/odom")
    drive(system, "/bob/cmd_vel", 0.0, sideways=0.3)
    system.run(2.0)
    assert odometry[-1].twist.twist.linear.y == pytest.approx(0.3, abs=0.03)
    assert world.simulation.world.robots["bob"].pose.x < 7.6  # it faces north, so its left is west
    assert 0.0 < odometry[-1].pose.covariance[0] < 0.01


@pytest.mark.slow
def test_odometry_is_less_and_less_sure(system: System) -> None:
    odometry = system.messages("/ada/odom")
    system.start(simulation.SimulatedWorld, parameters={"world": "lab"})
    drive(system, "/ada/cmd_vel", 0.4, 0.4)
    system.run(3.0)
    variances = [each.pose.covariance[0] for each in odometry]
    assert variances == sorted(variances)
    assert 0.0 < variances[60] < variances[-1]
    assert odometry[-1].twist.covariance[0] == pytest.approx((0.02 * odometry[-1].twist.twist.linear.x) ** 2)


WHEELS = """
robots:
  - name: robot
    pose: [0, 0]
    wheels: [{motor: left_motor, at: [0, 0.1], radius: 0.05}, {motor: right_motor, at: [0, -0.1], radius: 0.05}]
"""


def test_wheels_are_turned_by_name_and_told(system: System, tmp_path: Path) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(WHEELS, tmp_path)})
    states, command = system.messages("/joint_states"), JointState(name=["left_motor", "right_motor"])
    command.velocity = [2.0, 4.0]
    publisher = system.node.create_publisher(JointState, "/joint_command", 10)
    system.node.create_timer(0.1, lambda: publisher.publish(command))
    system.run(2.0)
    twist = world.simulation.world.robots["robot"].twist
    assert (twist.v, twist.w) == pytest.approx((0.15, 0.5), abs=0.01)
    assert states[-1].name == ["left_motor", "right_motor"]
    assert states[-1].velocity.tolist() == pytest.approx([2.0, 4.0], abs=0.1)
    assert states[-1].position[1] > states[-1].position[0] > 2.0


def test_nonsense_on_joint_command_is_ignored_counted_and_warned_about_once(system: System, tmp_path: Path) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(WHEELS, tmp_path)})
    publisher = system.node.create_publisher(JointState, "/joint_command", 10)
    publisher.publish(JointState(name=["left_motor", "right_motor"], velocity=[2.0, 2.0]))
    system.run(0.1)
    for names, speeds in (
        (["left_motor"], [math.nan]),
        (["left_motor"], [1.0, 2.0]),
        ([], []),
        (["left_motor"], [1e9]),
    ):
        publisher.publish(JointState(name=names, velocity=speeds))
    for _ in range(2):
        publisher.publish(JointState(name=["left_moter"], velocity=[1.0]))
    system.run(0.2)
    assert world.simulation.refused == 6
    assert world.simulation.world.robots["robot"].twist.v == pytest.approx(0.1, abs=0.01)
    warnings = [each for each in log(system) if "ignored a joint_command" in each]
    assert len(warnings) == 2
    assert "did you mean 'left_motor'" in warnings[1]
    system.run(1.0)
    assert world.simulation.world.robots["robot"].twist.v == pytest.approx(0.0, abs=1e-6)


def test_wheels_stop_half_a_second_after_their_last_command(system: System, tmp_path: Path) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": world_of(WHEELS, tmp_path)})
    states = system.messages("/joint_states")
    publisher = system.node.create_publisher(JointState, "/joint_command", 10)
    publisher.publish(JointState(name=["left_motor", "right_motor"], velocity=[2.0, 2.0]))
    system.run(1.5)
    turning = [each.header.stamp.nanosec for each in states if each.velocity[0] > 1.9]
    assert turning[-1] == pytest.approx(500_000_000, abs=20_000_000)
    assert states[-1].velocity[0] == pytest.approx(0.0, abs=1e-6)


def test_a_robot_that_takes_stamped_commands_obeys_no_others(system: System, tmp_path: Path) -> None:
    text = "robots: [{name: r, pose: [0, 0], drive: {stamped: true}}]"
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(text, tmp_path)})
    drive(system, "/cmd_vel", 0.0, 1.0)
    stamped = system.node.create_publisher(TwistStamped, "/cmd_vel", 10)
    system.node.create_timer(0.1, lambda: stamped.publish(TwistStamped(twist=Twist(linear=Vector3(x=0.2)))))
    system.run(2.0)
    pose = world.simulation.world.robots["r"].pose
    assert pose.x > 0.2
    assert pose.theta == 0.0
    stamped.publish(TwistStamped(twist=Twist(linear=Vector3(x=math.inf))))
    system.run(0.1)
    assert any("ignored a cmd_vel that is not finite" in line for line in log(system))


def test_cmd_vel_is_left_to_whoever_turns_the_wheels(system: System, tmp_path: Path) -> None:
    world = system.start(simulation.SimulatedWorld, parameters={"world": world_of(WHEELS, tmp_path)})
    publisher = system.node.create_publisher(JointState, "/joint_command", 10)
    drive(system, "/cmd_vel", 0.2)
    system.run(0.5)
    assert world.simulation.world.robots["robot"].twist.v == 0.0
    system.node.destroy_publisher(publisher)
    system.run(0.5)
    assert world.simulation.world.robots["robot"].twist.v == pytest.approx(0.2, abs=0.01)


def test_a_bumper_tells_of_a_touch(system: System, tmp_path: Path) -> None:
    text = "walls: [{polyline: [[1, -1], [1, 1]]}]\nrobots: [{name: r, pose: [0, 0], sensors: [{bumper: bumper}]}]\n"
    bumps = system.messages("/bumper")
    system.start(simulation.SimulatedWorld, parameters={"world": world_of(text, tmp_path)})
    drive(system, "/cmd_vel", 0.5)
    system.run(4.0)
    told = [each.data for each in bumps]
    assert not any(told[:15])
    assert told[-1]


# Frames


@pytest.mark.slow
def test_who_comes_late_knows_where_the_sensors_are_on_the_map(system: System) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "lab"})
    system.run(1.0)
    late = system.start(made_with(Node, node_name="late"))
    buffer = Buffer()
    listener = TransformListener(buffer, late)
    system.run(0.5)
    found = buffer.lookup_transform("map", "ada/base_scan", Time()).transform
    cos, sin = 0.05 * math.cos(0.5), 0.05 * math.sin(0.5)
    assert (found.translation.x, found.translation.y) == pytest.approx((1.0 + cos, 1.0 + sin))
    assert buffer.lookup_transform("map", "bob/base_left", Time()).transform.translation.x == pytest.approx(
        7.8, abs=1e-3
    )
    listener.unregister()


def test_the_map_is_left_to_who_localizes(system: System) -> None:
    static = system.messages("/tf_static")
    system.start(simulation.SimulatedWorld, parameters={"world": "lab", "publish_map": False})
    system.run(0.1)
    assert "map" not in [each.header.frame_id for each in static[0].transforms]
    assert len(static[0].transforms) == 5


# Diagnostics and the log


def values(message: DiagnosticArray) -> dict[str, str]:
    return {each.key: each.value for each in message.status[0].values}


def test_diagnostics_tell_of_pace_commands_and_contacts(system: System) -> None:
    heard = system.messages("/diagnostics")
    node = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room", "rtf": 2.0})
    drive(system, "/cmd_vel", 0.5)
    system.node.create_publisher(Twist, "/cmd_vel", 10).publish(Twist(linear=Vector3(x=math.nan)))
    system.run(5.005)
    assert len(heard) == 5  # the fifth may come just before the thousandth step
    status = heard[-1].status[0]
    assert (status.name, status.level, status.hardware_id) == (
        "world: real-time factor",
        DiagnosticStatus.OK,
        "empty_room",
    )
    told = values(heard[-1])
    assert (told["asked"], told["measured"]) == ("2", "2")
    assert int(told["steps"]) in (999, 1000)
    assert (told["refused commands"], told["robots"]) == ("1", "1")
    assert int(told["contacts"]) > 0
    assert float(told["simulation time"]) == int(told["steps"]) / 100
    ask(system, Trigger, "/world/pause")
    system.run(1.0)
    assert heard[-1].status[0].message == "paused"
    node.simulation.delete("robot")
    system.run(1.0)
    assert (values(heard[-1])["robots"], values(heard[-1])["contacts"]) == ("0", told["contacts"])


def test_falling_behind_is_a_warning_and_seen_in_diagnostics(system: System, monkeypatch: pytest.MonkeyPatch) -> None:
    heard = system.messages("/diagnostics")
    world = system.start(simulation.SimulatedWorld, parameters={"world": "empty_room"})
    step = world.simulation.step

    def slow_step() -> None:
        step()
        world.context.time.sleep(20_000_000)  # twice what it simulates

    monkeypatch.setattr(world.simulation, "step", slow_step)
    system.run(10.0)
    status = heard[-1].status[0]
    assert status.level == DiagnosticStatus.WARN
    assert "falls behind: 0.5 times" in status.message
    assert any("too slow for this pace" in line for line in log(system))


@pytest.mark.slow
def test_of_a_hundred_robots_the_log_stays_short(system: System) -> None:
    system.start(simulation.SimulatedWorld, parameters={"world": "fleet"})
    system.run(2.005)
    assert log(system)[0] == "world 'fleet' with 100 robots: r0, r1, r2, r3, r4 ... r99"
    assert len(log(system)) == 7
    assert log(system)[-1] == "95 more robots, 0 of them in contact"


# Worlds


def life(world: str) -> str:
    """Five seconds of a world whose robots all drive: a hash of all that was published."""
    digest = hashlib.sha256()
    with System() as system:
        node = system.start(simulation.SimulatedWorld, parameters={"world": world})
        for publisher in list(node.publishers):
            if publisher.topic_name != "/parameter_events":
                system.node.create_subscription(publisher.msg_type, publisher.topic_name, digest.update, 1000, raw=True)
        for robot in node.simulation.world.robots:
            prefix = f"/{robot}" if len(node.simulation.world.robots) > 1 else ""
            drive(system, f"{prefix}/cmd_vel", 0.4, 0.3)
        system.run(5.0)
    return digest.hexdigest()


@pytest.mark.slow
def test_a_life_in_the_lab_is_the_same_twice() -> None:
    assert life("lab") == life("lab")


@pytest.mark.slow
@pytest.mark.parametrize("world", [each.stem for each in list_worlds() if ROOT in each.parents])
def test_every_world_that_comes_with_robolink_runs(system: System, world: str) -> None:
    node = system.start(simulation.SimulatedWorld, parameters={"world": world})
    system.run(0.5)
    robots = node.simulation.world.robots.values()
    assert robots
    assert not any(each.contacts for each in robots)


@pytest.mark.annex("webots")
def test_a_world_of_webots_tells_once_what_is_left_out(system: System, tmp_path: Path) -> None:
    path = tmp_path / "arena.wbt"
    path.write_text("#VRML_SIM R2023b utf8\nRectangleArena { floorSize 4 4 }\nTinyUnicorn { }\n")
    system.start(simulation.SimulatedWorld, parameters={"world": str(path)})
    system.run(0.5)
    assert sum("TinyUnicorn" in line for line in log(system)) == 1


def test_time_goes_on_after_a_reset_with_a_clock_too(system: System) -> None:
    clocks = system.messages("/clock")
    system.start(simulation.SimulatedWorld, parameters={"world": "empty_room", "publish_clock": True})
    system.run(0.5)
    ask(system, Trigger, "/world/reset")
    system.run(0.5)
    times = [each.clock.sec * 10**9 + each.clock.nanosec for each in clocks]
    assert times == [10_000_000 * (i + 1) for i in range(len(times))]
    assert len(times) > 90
