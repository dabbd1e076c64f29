"""Messages and calls each of which once ended a shipped program: now it tells, and goes on."""

from __future__ import annotations

import math
from typing import Any

import pytest

from robolink.geometry.plane import is_finite, pose_of
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.example_interfaces.srv import AddTwoInts
from robolink.interfaces.geometry_msgs.msg import (
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    Twist,
    Vector3,
)
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rcl_interfaces.srv import GetParameters
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.sensor_msgs.msg import Image, JointState, Joy, LaserScan
from robolink.interfaces.std_msgs.msg import Header, String
from robolink.interfaces.topic_tools_interfaces.srv import MuxAdd, MuxDelete, MuxSelect
from robolink.interfaces.turtlesim.msg import Pose as TurtlePose
from robolink.testing import System
from tests.support.urdfs import ARM

LARGEST = 2**63 - 1
BEFORE = Header(stamp=Time(sec=-1))


def _odometry(**orientation: float) -> Odometry:
    return Odometry(pose=PoseWithCovariance(pose=Pose(position=Point(x=1.0), orientation=Quaternion(**orientation))))


CASES: list[tuple[str, dict[str, Any], str, Any]] = [
    ("demo_nodes_py talker", {"use_sim_time": True}, "/clock", Clock(clock=Time(sec=-1))),
    (
        "examples_rclpy_minimal_publisher publisher_member_function",
        {"use_sim_time": True},
        "/clock",
        Clock(clock=Time(sec=2**31 - 1, nanosec=2**32 - 1)),
    ),
    (
        "robot_state_publisher robot_state_publisher",
        {"robot_description": ARM},
        "/joint_states",
        JointState(header=Header(stamp=Time(sec=2**31 - 1, nanosec=2**32 - 1)), name=["left"], position=[1.0]),
    ),
    (
        "robot_state_publisher robot_state_publisher",
        {"robot_description": ARM},
        "/joint_states",
        JointState(header=BEFORE, name=["shoulder"], position=[1.0]),
    ),
    (
        "robot_state_publisher robot_state_publisher",
        {"robot_description": ARM},
        "/joint_states",
        JointState(header=Header(stamp=Time(sec=5)), name=["shoulder", "left"], position=[math.inf, math.nan]),
    ),
    ("square", {}, "/odom", _odometry(w=1e308)),
    ("goto", {}, "/odom", _odometry(w=1e308)),
    ("goto", {}, "/goal_pose", PoseStamped(pose=Pose(orientation=Quaternion(w=1e308)))),
    ("sign_reader", {}, "/odom", _odometry(w=1e308)),
    ("sign_reader", {}, "/odom", _odometry(w=math.nan)),
    ("tag_docker", {}, "/odom", _odometry(w=math.inf)),
    ("walker", {}, "/cmd_vel", Twist(angular=Vector3(z=1e308))),
    ("image_tools showimage", {}, "/image", Image(encoding="rgb8", width=5, step=15)),
    ("turtle_tf2_py turtle_tf2_broadcaster", {}, "/turtle/pose", TurtlePose(theta=math.inf)),
    ("turtlesim draw_square", {}, "/turtle1/pose", TurtlePose(theta=math.inf)),
    ("demo_nodes_py listener_serialized", {}, "/chatter", b"\0\1\0\0\xff\0\0\0"),
]
OF_TURTLES = pytest.mark.annex("turtlesim")
TRIED = [pytest.param(*case, marks=OF_TURTLES if case[0].startswith("turtle") else ()) for case in CASES]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("program", "parameters", "topic", "message"), TRIED, ids=[f"{case[0].split()[-1]} {case[2]}" for case in CASES]
)
def test_a_message_does_not_end_a_program(
    system: System, program: str, parameters: dict[str, Any], topic: str, message: Any
) -> None:
    node = system.start(program, parameters=parameters)
    system.run(0.5)
    if isinstance(message, bytes):
        system.node.create_publisher(String, topic, 10).publish(message)
    else:
        system.publish(topic, message)
    system.run(2.0)  # raises if the program has ended
    name = node.get_fully_qualified_name() if hasattr(node, "get_fully_qualified_name") else system.nodes[0]
    assert system.call(GetParameters, f"{name}/get_parameters") is not None


def test_a_clock_before_1970_is_told_once_and_ignored(system: System) -> None:
    system.start("demo_nodes_py talker", parameters={"use_sim_time": True})
    system.run(0.1)
    for seconds in (-1, -2, -3):
        system.publish("/clock", Clock(clock=Time(sec=seconds)))
        system.run(0.1)
    told = [each.message for each in system.logs if "/clock" in each.message]
    assert told == ["a time on /clock is ignored: a Time cannot be negative, got seconds=-1, nanoseconds=0"]
    system.publish("/clock", Clock(clock=Time(sec=100)))
    system.run(0.1)
    system.publish("/clock", Clock(clock=Time(sec=102)))
    system.expect_log("Publishing")


@pytest.mark.parametrize("program", ["demo_nodes_cpp add_two_ints_server", "demo_nodes_py add_two_ints_server"])
def test_sums_wrap_as_in_cpp(system: System, program: str) -> None:
    system.start(program)
    for a, b, wrapped in [(LARGEST, 1, -(2**63)), (-(2**63), -1, LARGEST), (2, 3, 5)]:
        assert system.call(AddTwoInts, "/add_two_ints", AddTwoInts.Request(a=a, b=b)).sum == wrapped


def test_no_text_that_is_sent_to_a_mux_ends_it(system: System) -> None:
    system.start("topic_tools mux", args=["/out", "/one", "/two"])
    for text in ("a b", "", "//", "x" * 300, "{", "/a//b", "out"):  # the last one would be a circle
        assert not system.call(MuxAdd, "/mux/add", MuxAdd.Request(topic=text)).success
        assert not system.call(MuxSelect, "/mux/select", MuxSelect.Request(topic=text)).success
        assert not system.call(MuxDelete, "/mux/delete", MuxDelete.Request(topic=text)).success
    assert system.call(MuxSelect, "/mux/select", MuxSelect.Request(topic="/two")).success


@pytest.mark.annex("turtlesim")
def test_what_is_not_finite_is_never_driven(system: System) -> None:
    system.start("teleop_twist_joy teleop_node", parameters={"require_enable_button": False})
    system.start("turtlesim mimic", remappings={"output/cmd_vel": "cmd_vel"})
    system.start("reactive_controller")
    commands = system.messages("/cmd_vel", Twist)
    odd = [math.inf, math.nan, -math.inf, math.nan] * 90
    system.run(0.1)
    system.publish("/joy", Joy(axes=odd[:8], buttons=[1] * 8))
    system.publish("/input/pose", TurtlePose(linear_velocity=math.inf))
    system.publish("/scan", LaserScan(angle_min=math.nan, angle_increment=math.inf, ranges=odd, range_max=math.inf))
    system.run(0.3)
    assert commands
    assert all(math.isfinite(value) for each in commands for value in (each.linear.x, each.angular.z))


def test_a_quaternion_of_any_length_is_a_heading() -> None:
    quarter = math.sqrt(0.5)
    for scale in (1e-300, 1e-5, 1.0, 1e300):
        turned = Pose(orientation=Quaternion(z=quarter * scale, w=quarter * scale))
        assert pose_of(turned).theta == pytest.approx(math.pi / 2)
    assert pose_of(Pose(orientation=Quaternion(w=0.0))).theta == 0.0
    assert not is_finite(pose_of(Pose(orientation=Quaternion(w=math.nan))))
