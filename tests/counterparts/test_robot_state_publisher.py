"""robot_state_publisher: a robot's description and transforms, as launch files start it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robolink.counterparts.robot_state_publisher import RobotStatePublisher, positions
from robolink.counterparts.urdf import parse_urdf
from robolink.exceptions import DocumentError, InvalidParameterValueException, RobolinkError
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.std_msgs.msg import String
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from tests.support.transforms import place, rotation
from tests.support.urdfs import ARM, joint, robot

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def frames(message: TFMessage) -> list[tuple[str, str]]:
    return [(each.header.frame_id, each.child_frame_id) for each in message.transforms]


def moved(system: System, seconds: float = 1.0, **positions: float) -> JointState:
    state = JointState(name=list(positions), position=list(positions.values()))
    state.header.stamp = system.node.get_clock().now().to_msg()
    system.publish("/joint_states", state)
    return state


def test_the_description_and_the_fixed_joints_are_there_for_late_listeners(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.run(3.0)
    assert system.expect("/robot_description").data == ARM
    found = system.expect("/tf_static")
    assert frames(found) == [("base_link", "camera")]
    assert place(found.transforms[0]).tolist() == [0.1, 0, 0.5]
    system.expect_log("Robot initialized")


def test_moving_joints_are_where_joint_states_say(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.run(1.0)
    sent = moved(system, shoulder=math.pi / 2, extend=0.3)
    found = system.expect("/tf")
    assert frames(found) == [("base_link", "upper"), ("upper", "slide")]
    assert place(found.transforms[1]).tolist() == pytest.approx([0, 0.3, 0])
    assert rotation(found.transforms[0]).as_rotvec().tolist() == pytest.approx([0, 0, math.pi / 2])
    assert all(each.header.stamp == sent.header.stamp for each in found.transforms)


def test_a_joint_that_mimics_follows(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.run(1.0)
    moved(system, left=0.2)
    found = {each.child_frame_id: each for each in system.expect("/tf").transforms}
    assert rotation(found["right_finger"]).as_rotvec().tolist() == pytest.approx([0.2 * -2 + 0.5, 0, 0])


def test_it_publishes_no_more_often_than_asked(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM, "publish_frequency": 5.0})
    system.run(1.0)
    heard = system.messages("/tf", TFMessage)
    for _ in range(20):
        moved(system, shoulder=0.1)
        system.run(0.05)
    assert len(heard) == 5
    system.set_parameter("robot_state_publisher", "ignore_timestamp", True)
    for _ in range(20):
        moved(system, shoulder=0.1)
        system.run(0.05)
    assert len(heard) == 25


def test_frames_have_a_prefix(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM, "frame_prefix": "one/"})
    assert frames(system.expect("/tf_static")) == [("one/base_link", "one/camera")]
    moved(system, shoulder=0.0)
    assert frames(system.expect("/tf")) == [("one/base_link", "one/upper")]


def test_fixed_joints_on_tf_where_old_launch_files_want_it(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM, "use_tf_static": False})
    heard = system.messages("/tf", TFMessage)
    system.run(1.01)
    assert len(heard) == 20
    assert frames(heard[-1]) == [("base_link", "camera")]


def test_a_new_description_replaces_the_old_one(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.run(1.0)
    other = ARM.replace("camera", "lidar")
    system.set_parameter("robot_state_publisher", "robot_description", other)
    assert system.expect("/robot_description").data == other
    assert ("base_link", "lidar") in frames(system.expect("/tf_static"))
    with pytest.raises(InvalidParameterValueException, match="robot_description:2: two roots, 'a' and 'b'"):
        system.set_parameter("robot_state_publisher", "robot_description", robot(links="a b"))
    with pytest.raises(InvalidParameterValueException, match="Empty URDF is not allowed"):
        system.set_parameter("robot_state_publisher", "robot_description", "")
    with pytest.raises(InvalidParameterValueException, match=r"publish_frequency must be between 0.0 \(exclusive\)"):
        system.set_parameter("robot_state_publisher", "publish_frequency", 0.0)
    assert system.parameter("robot_state_publisher", "robot_description") == other


def test_the_description_may_come_from_the_topic(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"use_robot_description_topic": True})
    system.publish("/robot_description", String(data="<no"), LATCHED)
    system.expect_log("Failed to parse robot description from topic: robot_description:1:")
    system.publish("/robot_description", String(data=ARM), LATCHED)
    assert frames(system.expect("/tf_static")) == [("base_link", "camera")]


def test_states_that_are_none_are_told(system: System) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": ARM})
    system.publish("/joint_states", JointState(name=["shoulder"]))
    system.expect_log('JointState message about joint(s) "shoulder"(,...) whose position member was empty.')
    system.publish("/joint_states", JointState(name=["shoulder"], position=[1.0, 2.0]))
    system.expect_log("ignored an invalid JointState message")
    moved(system, unknown=1.0)
    assert system.expect("/tf").transforms == list[TransformStamped]()


def test_without_a_description_it_says_what_to_do(system: System) -> None:
    with pytest.raises(RobolinkError, match="robot_description parameter must not be empty: give a URDF file"):
        system.start(RobotStatePublisher)
    with pytest.raises(RobolinkError, match="robot_description:2: two roots"):
        system.start(RobotStatePublisher, parameters={"robot_description": robot(links="a b")})


def test_a_file_serves_as_an_argument(system: System, tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    system.start("robot_state_publisher robot_state_publisher", args=[str(file)])
    assert frames(system.expect("/tf_static")) == [("base_link", "camera")]
    system.expect_log("Assuming argument is name of URDF file.")
    assert system.parameter("robot_state_publisher", "robot_description") == ARM


def test_the_parameter_goes_before_the_file(system: System) -> None:
    node = "robot_state_publisher robot_state_publisher"
    system.start(node, args=["nowhere.urdf"], parameters={"robot_description": ARM})
    assert frames(system.expect("/tf_static")) == [("base_link", "camera")]


def test_a_mistake_in_a_file_has_its_place(system: System, tmp_path: Path) -> None:
    file = tmp_path / "broken.urdf"
    file.write_text(robot(links="a b"))
    for path, said in ((file, r"broken.urdf:2: two roots"), (tmp_path / "nowhere", r"nowhere: No such file")):
        with pytest.raises(DocumentError, match=said):
            system.start("robot_state_publisher robot_state_publisher", args=[str(path)])


def chain(*mimics: tuple[str, str]) -> str:
    """A robot whose joint `root` moves, and in which each other joint mimics the second name, doubled."""
    names = ["root", *(name for name, _ in mimics)]
    inner = {name: f'<mimic joint="{other}" multiplier="2"/>' for name, other in mimics}
    joints = [joint(name, "base", f"link_{name}", inner.get(name, ""), "continuous") for name in names]
    return robot(*joints, links=" ".join(["base", *(f"link_{name}" for name in names)]))


@pytest.mark.parametrize("names", [("a", "b", "c"), ("c", "b", "a")])
def test_a_mimic_of_a_mimic_follows_whatever_the_order_of_names(names: tuple[str, str, str]) -> None:
    one, two, three = names
    model = parse_urdf(chain((three, two), (two, one), (one, "root")))
    assert positions(model, {"root": 0.1}) == pytest.approx({"root": 0.1, one: 0.2, two: 0.4, three: 0.8})
    assert positions(model, {"root": 0.1, two: 1.0})[three] == 2.0


def test_a_mimic_of_nobody_is_left_out_and_told(system: System, capfd: pytest.CaptureFixture[str]) -> None:
    system.start(RobotStatePublisher, parameters={"robot_description": chain(("a", "nobody"))})
    system.run(1.0)
    moved(system, root=0.2)
    assert [each.child_frame_id for each in system.expect("/tf").transforms] == ["link_root"]
    assert "joint 'a' mimics 'nobody', which is not there: it is published only where joint_states has it" in (
        capfd.readouterr().err
    )
