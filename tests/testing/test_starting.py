"""What a test can start: launch files, worlds, nodes by name or file, scripts; how these stop and start anew."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink import Node
from robolink.exceptions import NotFoundError
from robolink.interfaces.std_msgs.msg import String
from robolink.testing import System
from tests.support.ros_tree import write_package

LAUNCH = """
arguments: {pace: 0.2}
nodes:
  - {node: world, parameters: {world: corners}}
  - {node: wall_follower, parameters: {speed: "{pace}"}}
"""


@pytest.mark.slow
def test_a_launch_file_with_arguments_parameters_and_faults(tested: System, tmp_path: Path) -> None:
    file, faults = tmp_path / "drive.yaml", tmp_path / "faults.yaml"
    file.write_text(LAUNCH)
    faults.write_text("messages: [{topic: scan, loss: 0.2}]\n")
    tested.launch(file, {"pace": 0.3}, set={"wall_follower.distance": 0.6}, faults=faults)
    assert tested.nodes == ["/wall_follower", "/world"]
    assert tested.parameter("wall_follower", "speed") == 0.3
    assert tested.parameter("wall_follower", "distance") == 0.6
    tested.run(20.0)
    robot = tested.robot()
    assert robot.contacts == 0
    assert robot.driven > 3.0
    assert tested.expect("odom", lambda odom: abs(odom.pose.pose.position.x - robot.pose.x) < 0.1)
    with pytest.raises(NotFoundError, match="no robot named 'robt' in the world, which has robot"):
        tested.robot("robt")


def test_robots_of_two_worlds_are_called_by_their_namespaces(tested: System) -> None:
    tested.start("world", namespace="one", parameters={"world": "empty_room"})
    one = tested.robot()
    assert tested.robot("robot") is tested.robot("one/robot") is one
    tested.start("world", namespace="two", parameters={"world": "empty_room"})
    assert tested.robot("one/robot") is one
    assert tested.robot("/two/robot") is not one
    with pytest.raises(NotFoundError, match=r"which robot 'robot'\? There are one/robot, two/robot: give a whole name"):
        tested.robot("robot")
    with pytest.raises(NotFoundError, match=r"which robot\? The world has one/robot, two/robot: give a name"):
        tested.robot()


def test_what_is_not_there_is_named(tested: System, tmp_path: Path) -> None:
    with pytest.raises(NotFoundError, match="did you mean 'follow'"):
        tested.launch("folow")
    with pytest.raises(NotFoundError, match="did you mean 'wall_follower'"):
        tested.launch("follow", set={"wall_folower.speed": 1})
    with pytest.raises(NotFoundError, match="did you mean 'wall_follower'"):
        tested.start("wall_folower")
    with pytest.raises(NotFoundError, match="no simulated world"):
        tested.robot()
    assert tested.nodes == []


HELLO = """
from robolink import Node


class Hello(Node):
    def __init__(self):
        super().__init__("hello")
        self.declare_parameter("seed", 0)
"""


def test_nodes_are_started_by_name_or_file(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "hello.py"
    file.write_text(HELLO)
    assert tested.start(file, name="hallo").get_name() == "hallo"
    assert tested.parameter("hallo", "seed") == 7
    tested.start("wall_follower", namespace="ada", parameters={"side": "left"})
    assert tested.nodes == ["/ada/wall_follower", "/hallo"]
    assert tested.parameter("ada/wall_follower", "side") == "left"


SCRIPT = """
import sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


def main():
    rclpy.init()
    node = Node("script")
    publisher = node.create_publisher(Int32, "count", 10)
    while rclpy.ok():
        publisher.publish(Int32(data=int(sys.argv[1])))
        rclpy.spin_once(node, timeout_sec=0.25)


if __name__ == "__main__":
    main()
"""


def test_a_script_with_a_main_of_its_own(tested: System, tmp_path: Path) -> None:
    file = tmp_path / "script.py"
    file.write_text(SCRIPT)
    heard = tested.messages("count")
    tested.start(file, args=["100"], namespace="ada", remappings={"count": "/count"})
    assert tested.nodes == ["/ada/script"]
    tested.run(1.1)
    assert [each.data for each in heard] == [100] * 5
    tested.stop("script")
    assert tested.nodes == []


def test_stopped_crashed_and_restarted(tested: System) -> None:
    class Polite(Node):
        def __init__(self) -> None:
            super().__init__("polite")
            self.publisher = self.create_publisher(String, "words", 10)
            self.publisher.publish(String(data="hello"))

        def destroy_node(self) -> None:
            self.publisher.publish(String(data="goodbye"))
            super().destroy_node()

    words = tested.messages("words")
    node = tested.start(Polite)
    tested.crash(node)
    assert tested.nodes == []
    other = tested.restart("polite")
    assert tested.nodes == ["/polite"]
    tested.stop(other)
    tested.run(0.0)
    assert [each.data for each in words] == ["hello", "hello", "goodbye"]
    assert tested.nodes == []
    with pytest.raises(NotFoundError, match="did you mean 'polite'"):
        tested.stop("polit")
    tested.run(1.0)
    assert tested.failures == []


def test_what_a_constructor_raises_comes_from_start(tested: System) -> None:
    class Broken(Node):
        def __init__(self) -> None:
            super().__init__("broken")
            raise KeyError("no such thing")

    with pytest.raises(KeyError, match="no such thing"):
        tested.start(Broken)
    tested.run(1.0)
    assert tested.nodes == []


RELATIVE = """
from rclpy.node import Node
import rclpy
from .words import WORD

made = []


def main():
    rclpy.init()
    made.append(1)
    node = Node(f"{WORD}_{len(made)}")
    node.create_timer(1.0, lambda: None)
    rclpy.spin(node)
"""


@pytest.mark.parametrize("word", ["first", "second"])
def test_an_executable_of_a_package_imports_its_neighbours_by_a_dot(
    word: str, tested: System, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Twice in this process, from two workspaces; and each program has variables of its own."""
    write_package(
        tmp_path / "src", "pkg_dots", {"words.py": f"WORD = '{word}'\n", "talk.py": RELATIVE}, "t = pkg_dots.talk:main"
    )
    monkeypatch.chdir(tmp_path)
    for namespace in ("/a", "/b"):
        tested.start("pkg_dots t", namespace=namespace)
    tested.run(1.0)
    assert tested.nodes == [f"/a/{word}_1", f"/b/{word}_1"]
