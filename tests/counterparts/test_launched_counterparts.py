"""Counterparts in launch files of Python, as packages of ROS 2 have them: a robot with its model, a map, a relay."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.interfaces.lifecycle_msgs.srv import GetState
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.interfaces.sensor_msgs.msg import JointState
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.testing import System
from tests.support.urdfs import ARM

LAUNCH = """
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    share = get_package_share_directory("arm")
    urdf = os.path.join(share, "arm.urdf")
    with open(urdf) as file:
        text = file.read()
    names = ["map_server"]
    return LaunchDescription([
        DeclareLaunchArgument("prefix", default_value=""),
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            parameters=[{"robot_description": text, "frame_prefix": LaunchConfiguration("prefix")}],
            arguments=[urdf],
        ),
        Node(package="arm", executable="mover"),
        Node(
            package="joint_state_publisher",
            executable="joint_state_publisher",
            parameters=[{"source_list": ["moved"]}],
        ),
        Node(
            package="tf2_ros",
            executable="static_transform_publisher",
            arguments=["0", "0", "1", "0", "0", "0", "map", "base_link"],
        ),
        Node(
            package="nav2_map_server",
            executable="map_server",
            parameters=[{"yaml_filename": os.path.join(share, "map.yaml")}],
        ),
        Node(
            package="nav2_lifecycle_manager",
            executable="lifecycle_manager",
            name="lifecycle_manager_localization",
            parameters=[{"autostart": True}, {"node_names": names}],
        ),
        Node(package="topic_tools", executable="relay", arguments=["/map", "/map_again"]),
    ])
"""
MOVER = """
import rclpy
from rclpy.node import Node
from sensor_msgs.msg import JointState


class Mover(Node):
    def __init__(self):
        super().__init__("mover")
        self.moved = self.create_publisher(JointState, "moved", 10)
        self.angle = 0.0
        self.create_timer(0.1, self.move)

    def move(self):
        self.angle += 0.01
        self.moved.publish(JointState(name=["shoulder"], position=[self.angle]))


def main():
    rclpy.init()
    rclpy.spin(Mover())
"""
SETUP = """
from setuptools import setup

setup(name="arm", packages=["arm"], entry_points={"console_scripts": ["mover = arm.mover:main"]})
"""
MAP = "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


@pytest.fixture
def launch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The launch file of a package, with its model, its map and a node of its own."""
    package = tmp_path / "src/arm"
    (package / "arm").mkdir(parents=True)
    for name, text in (
        ("package.xml", "<package format='3'><name>arm</name></package>"),
        ("setup.py", SETUP),
        ("arm/__init__.py", ""),
        ("arm/mover.py", MOVER),
        ("arm.urdf", ARM),
        ("map.yaml", MAP),
        ("map.pgm", "P2 2 1 255 0 254"),
        ("arm.launch.py", LAUNCH),
    ):
        (package / name).write_text(text)
    monkeypatch.setenv("ROBOLINK_WORKSPACE", str(tmp_path))
    return package / "arm.launch.py"


@pytest.mark.slow
@pytest.mark.annex("nav2")
def test_a_launch_file_starts_them_all(system: System, launch: Path) -> None:
    system.launch(launch, {"prefix": "one/"})
    static, moving = system.messages("/tf_static", TFMessage), system.messages("/tf", TFMessage)
    system.run(3.0)
    links = {(each.header.frame_id, each.child_frame_id) for message in static for each in message.transforms}
    assert links == {("one/base_link", "one/camera"), ("map", "base_link")}
    assert {each.child_frame_id for each in moving[-1].transforms} == {
        f"one/{each}" for each in ("upper", "slide", "left_finger", "right_finger")
    }
    state = system.expect("/joint_states", type=JointState)
    assert 0.2 < state.position[0] < 0.4
    assert system.call(GetState, "/map_server/get_state").current_state.label == "active"
    for topic in ("/map", "/map_again"):
        assert list(system.expect(topic, type=OccupancyGrid).data) == [100, 0]
