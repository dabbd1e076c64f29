"""joint_state_publisher: states of all joints, zero or what other topics say."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.counterparts.joint_state_publisher import FreeJoint, Joints, JointStatePublisher, Settings, dependent_of
from robolink.counterparts.robot_state_publisher import RobotStatePublisher
from robolink.counterparts.urdf import Mimic, parse_urdf
from robolink.exceptions import RobolinkError
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import String
from robolink.parameter import Parameter
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from tests.support.urdfs import ARM, joint, robot

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NAMES = ["shoulder", "extend", "left", "right"]


def positions(state: JointState) -> dict[str, float]:
    return {name: round(each, 6) for name, each in zip(state.name, state.position, strict=True)}


def started(system: System, **parameters: Any) -> None:
    system.start(JointStatePublisher, parameters=parameters)
    system.publish("/robot_description", String(data=ARM), LATCHED)


def test_it_takes_the_robot_of_the_robot_state_publisher(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.start(JointStatePublisher)
    system.expect_log("Waiting for robot_description to be published on the robot_description topic...")
    state = system.expect("/joint_states")
    assert positions(state) == {"shoulder": 0, "extend": 0.3, "left": 0, "right": 0.5}
    assert not state.velocity
    assert not state.effort
    found = system.expect("/tf")
    assert {each.child_frame_id for each in found.transforms} == {"upper", "slide", "left_finger", "right_finger"}


def test_the_list_of_sources_is_one_of_texts(system: System) -> None:
    node = system.start(JointStatePublisher)
    sources = node.get_parameter("source_list")
    assert (sources.type_, sources.value) == (Parameter.Type.STRING_ARRAY, [])


def test_ten_messages_a_second_or_as_many_as_asked(system: System) -> None:
    started(system, rate=50)
    heard = system.messages("/joint_states", JointState)
    system.run(1.01)
    assert 49 <= len(heard) <= 51


def test_sources_say_where_joints_are(system: System) -> None:
    started(system, source_list=["arm_states"], publish_default_velocities=True)
    system.publish("/arm_states", JointState(name=["shoulder", "nobody"], position=[0.7, 1.0], effort=[3.0, 1.0]))
    system.run(0.2)
    state = system.expect("/joint_states")
    assert positions(state)["shoulder"] == 0.7
    assert list(state.velocity) == [0, 0, 0, 0]
    assert list(state.effort) == [3, 0, 0, 0]


def test_zeros_and_dependent_joints_are_parameters(system: System) -> None:
    parameters = {
        "zeros.shoulder": 0.4,
        "dependent_joints.extend.parent": "shoulder",
        "dependent_joints.extend.factor": 2.0,
    }
    started(system, use_mimic_tags=False, **parameters)
    assert positions(system.expect("/joint_states")) == {"shoulder": 0.4, "extend": 0.8, "left": 0, "right": 0}
    system.set_parameter("joint_state_publisher", "zeros.shoulder", -0.1)
    assert positions(system.expect("/joint_states"))["extend"] == -0.2


def test_joints_move_by_delta(system: System) -> None:
    started(system, delta=0.0625)
    heard = system.messages("/joint_states", JointState)
    system.run(0.75)
    assert [positions(each)["extend"] for each in heard][:6] == [0.3625, 0.4, 0.3375, 0.275, 0.2125, 0.2]
    joint = FreeJoint(-1.0, 1.0, {"position": 0.75}, turns=True)
    joint.move(0.5)
    assert joint.values["position"] == -1


def test_a_broken_description_is_ignored(system: System) -> None:
    started(system)
    system.run(0.2)
    system.publish("/robot_description", String(data="<robot"), LATCHED)
    system.expect_log("Invalid robot_description given, ignoring: robot_description:1:")
    assert system.expect("/joint_states").name == NAMES


def test_limits_without_those_of_the_safety_controller() -> None:
    joints = Joints(parse_urdf(ARM), Settings(use_smallest=False))
    assert joints.state()["position"] == [0, 0.4, 0, 0.5]


def test_joints_may_depend_on_dependent_ones_but_not_in_a_circle() -> None:
    rules = {"extend": Mimic("right", 2.0, 1.0)}
    joints = Joints(parse_urdf(ARM), Settings(zeros={"left": 0.1}, dependent=rules))
    assert joints.state()["position"] == pytest.approx([0, (0.1 * -2 + 0.5) * 2 + 1, 0.1, 0.3])
    circle = Joints(parse_urdf(ARM), Settings(dependent={"left": Mimic("extend"), "extend": Mimic("left")}))
    with pytest.raises(RobolinkError, match="depend on each other in a circle: extend and left"):
        circle.state()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"left.parnt": "a"}, "dependent_joints.left.parnt: expected JOINT.parent.* .did you mean 'parent'"),
        ({"left": "a"}, "dependent_joints.left: expected JOINT.parent"),
        ({"left.factor": 1.0}, "dependent_joints.left.parent: the name of a joint is needed"),
        ({"left.parent": "a", "left.offset": "x"}, "dependent_joints.left: factor and offset are numbers"),
    ],
)
def test_rules_that_are_none_are_one_line(given: dict[str, Any], said: str) -> None:
    with pytest.raises(RobolinkError, match=said):
        dependent_of(given)


def test_the_one_with_a_window_says_what_serves_as_sliders(system: System) -> None:
    system.start("joint_state_publisher_gui joint_state_publisher_gui", name="sliders")
    system.publish("/robot_description", String(data=ARM), LATCHED)
    system.expect_log("robolink param set sliders zeros.JOINT 0.5'")
    system.expect("/joint_states")
    system.set_parameter("sliders", "zeros.left", 1.0)
    assert positions(system.expect("/joint_states"))["right"] == -1.5


def test_each_free_joint_has_a_parameter_with_its_range(system: System) -> None:
    node = system.start(JointStatePublisher, parameters={"zeros.shoulder": 0.4})
    system.publish("/robot_description", String(data=ARM), LATCHED)
    system.run(0.5)
    names = node.list_parameters(["zeros"], 0).names
    assert sorted(names) == ["zeros.extend", "zeros.left", "zeros.shoulder"]
    (found,) = node.describe_parameter("zeros.extend").floating_point_range
    assert (found.from_value, found.to_value) == (0.2, 0.4)
    with pytest.raises(RobolinkError, match=r"zeros.extend"):
        system.set_parameter("joint_state_publisher", "zeros.extend", 0.9)
    system.set_parameter("joint_state_publisher", "zeros.extend", 0.2)
    assert positions(system.expect("/joint_states")) == {"shoulder": 0.4, "extend": 0.2, "left": 0, "right": 0.5}


def test_joints_may_have_any_name(system: System) -> None:
    system.start(JointStatePublisher)
    names = ["a b", "1", "a..b", "a.", "é/" * 50]
    links = " ".join(f"l{each}" for each in range(len(names) + 1))
    joints = [joint(name, f"l{each}", f"l{each + 1}", kind="continuous") for each, name in enumerate(names)]
    system.publish("/robot_description", String(data=robot(*joints, links=links)), LATCHED)
    assert system.expect("/joint_states").name == names


@pytest.mark.parametrize("rate", [0, -1, 1_000_000, "fast"])
def test_a_rate_that_cannot_be_is_one_line(system: System, rate: Any) -> None:
    with pytest.raises(RobolinkError, match=r"rate: expected a number of Hz from above 0 to 1000, got "):
        system.start(JointStatePublisher, parameters={"rate": rate})


def test_a_lone_source_needs_no_list(system: System) -> None:
    started(system, source_list="arm_states")
    system.publish("/arm_states", JointState(name=["shoulder"], position=[0.7]))
    system.run(0.2)
    assert positions(system.expect("/joint_states"))["shoulder"] == 0.7
