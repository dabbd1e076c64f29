"""ROS 2's tutorials on tf2 in Python: static and moving frames, a turtle that follows another, frames added, time."""

from __future__ import annotations

import math

import pytest

from robolink.cli.main import main
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.testing import System
from tests.support.tutorial_workspace import TutorialWorkspace, edit

pytestmark = pytest.mark.annex("turtlesim")

SCRIPTS = [
    f"{each} = learning_tf2_py.{each}:main"
    for each in (
        "static_turtle_tf2_broadcaster",
        "turtle_tf2_broadcaster",
        "turtle_tf2_listener",
        "fixed_frame_tf2_broadcaster",
        "dynamic_frame_tf2_broadcaster",
    )
]
LOOK_UP = """\
                    t = self.tf_buffer.lookup_transform(
                        to_frame_rel,
                        from_frame_rel,
                        rclpy.time.Time())
"""
AT_ONCE = LOOK_UP.replace("rclpy.time.Time()", "self.get_clock().now()")
PATIENTLY = LOOK_UP.replace("rclpy.time.Time()", "self.get_clock().now(), rclpy.duration.Duration(seconds=0.05)")
FIVE_SECONDS_AGO = """\
                    when = self.get_clock().now() - rclpy.time.Duration(seconds=5.0)
                    t = self.tf_buffer.lookup_transform_full(
                        target_frame=to_frame_rel,
                        target_time=rclpy.time.Time(),
                        source_frame=from_frame_rel,
                        source_time=when,
                        fixed_frame='world',
                        timeout=rclpy.duration.Duration(seconds=0.05))
"""


@pytest.fixture
def demo(ros2_ws: TutorialWorkspace) -> TutorialWorkspace:
    """The workspace with the package learning_tf2_py."""
    ros2_ws.create("learning_tf2_py", *SCRIPTS, data="launch")
    return ros2_ws


def distance(system: System) -> float:
    """Metres between the two turtles."""
    one, two = (system.expect(f"/turtle{n}/pose", within=0.5) for n in (1, 2))
    return math.dist((one.x, one.y), (two.x, two.y))


def test_a_static_frame(demo: TutorialWorkspace, system: System) -> None:
    static = system.messages("/tf_static", TFMessage)
    system.start("learning_tf2_py static_turtle_tf2_broadcaster", args=["mystaticturtle", *"001000"])
    system.run(0.5)
    (transform,) = static[-1].transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("world", "mystaticturtle")
    assert (transform.transform.translation.z, transform.transform.rotation.w) == (1.0, 1.0)
    assert demo


@pytest.mark.parametrize(
    ("words", "code", "told"), [("one", 1, "Invalid number"), ("world 0 0 1 0 0 0", 2, "cannot be")]
)
def test_a_static_frame_with_wrong_words(
    demo: TutorialWorkspace, capsys: pytest.CaptureFixture[str], words: str, code: int, told: str
) -> None:
    assert main(["run", "learning_tf2_py", "static_turtle_tf2_broadcaster", *words.split()]) == code
    assert told in capsys.readouterr().err
    assert demo


@pytest.mark.slow
def test_a_turtle_follows_another(demo: TutorialWorkspace, system: System) -> None:
    system.launch("learning_tf2_py turtle_tf2_demo_launch.py")
    system.expect_log("Successfully spawned turtle2")
    system.run(15.0)
    assert distance(system) < 0.5
    system.publish("/turtle1/cmd_vel", Twist(linear=Vector3(x=2.0)))
    system.run(1.5)
    assert 0.5 < distance(system) < 2.1
    system.run(15.0)
    assert distance(system) < 0.5
    assert demo


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["fixed", "dynamic"])
def test_a_frame_is_added(demo: TutorialWorkspace, system: System, kind: str) -> None:
    system.launch(f"learning_tf2_py turtle_tf2_{kind}_frame_demo_launch.py")
    system.expect_log("Successfully spawned turtle2")
    system.run(15.0)
    if kind == "fixed":
        assert distance(system) == pytest.approx(2.0, abs=0.3)  # to the carrot, 2 m left of the first turtle
    else:
        assert system.expect("/turtle2/cmd_vel", lambda twist: twist.linear.x > 1.0)
    assert f"/{kind}_broadcaster" in system.nodes
    assert demo


@pytest.mark.slow
@pytest.mark.parametrize(("lookup", "follows"), [(AT_ONCE, False), (PATIENTLY, True), (FIVE_SECONDS_AGO, True)])
def test_time_travel(demo: TutorialWorkspace, system: System, lookup: str, follows: bool) -> None:
    edit(demo.folder / "src/learning_tf2_py/learning_tf2_py/turtle_tf2_listener.py", (LOOK_UP, lookup))
    system.start("turtlesim turtlesim_node")
    for n in (1, 2):
        system.start(
            "learning_tf2_py turtle_tf2_broadcaster", name=f"broadcaster{n}", parameters={"turtlename": f"turtle{n}"}
        )
    system.run(5.0)  # virtual time begins at 1 s, and no Time is negative
    system.start("learning_tf2_py turtle_tf2_listener")
    system.run(25.0)
    assert (distance(system) < 0.5) is follows
    waited = [each.message for each in system.logs if each.message.startswith("Could not transform turtle2 to turtle1")]
    assert bool(waited) is (lookup is not PATIENTLY)
