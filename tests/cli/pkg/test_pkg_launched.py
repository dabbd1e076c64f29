"""A package that `pkg create` makes, with the files that tutorials add, is launched without a build."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.testing import System
from robolink.workspace import VARIABLE, share

TALKER = """
import rclpy
from my_interfaces.msg import Num
from rclpy.node import Node

from .start import START


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.step = self.declare_parameter("step", 1).value
        self.num = START
        self.publisher = self.create_publisher(Num, "numbers", 10)
        self.create_timer(1.0, self.on_timer)

    def on_timer(self):
        self.num += self.step
        self.publisher.publish(Num(num=self.num))


def main(args=None):
    rclpy.init(args=args)
    rclpy.spin(Talker())
"""
LAUNCH = """
import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    settings = os.path.join(get_package_share_directory("my_pubsub"), "settings.yaml")
    return LaunchDescription([
        Node(package="my_pubsub", executable="talker", parameters=[settings]),
        Node(package="rviz2", executable="rviz2", arguments=["-d", "robot.rviz"]),
    ])
"""
DATA_FILES = """
        ('share/' + package_name + '/launch', glob('launch/all/*.launch.py')),
        ('share/' + package_name, glob('config/*.yaml')),
    ],
    install_requires"""


@pytest.fixture
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Path:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv(share.HOME, str(tmp_path / "links"))
    monkeypatch.setattr(sys, "path", list(sys.path))
    (tmp_path / "src").mkdir()
    monkeypatch.chdir(tmp_path / "src")
    main(["pkg", "create", "my_interfaces"])
    main(["pkg", "create", "my_pubsub", "--build-type", "ament_python", "--node-name", "talker"])
    capsys.readouterr()
    files = {
        "my_interfaces/msg/Num.msg": "int64 num\n",
        "my_pubsub/my_pubsub/talker.py": TALKER,
        "my_pubsub/my_pubsub/start.py": "START = 100\n",
        "my_pubsub/launch/all/talk.launch.py": LAUNCH,
        "my_pubsub/config/settings.yaml": "talker:\n  ros__parameters:\n    step: 5\n",
    }
    for name, text in files.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text)
    setup = Path("my_pubsub/setup.py")
    text = setup.read_text().replace("    ],\n    install_requires", DATA_FILES.strip("\n"))
    setup.write_text("from glob import glob\n" + text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("workspace")
def test_it_runs_from_where_setup_py_installs_its_files() -> None:
    with System() as system:
        system.launch(Path("src/my_pubsub/launch/all/talk.launch.py"))
        assert system.expect("numbers", lambda each: each.num == 110, within=3.0)
        assert system.nodes == ["/talker"]


@pytest.mark.processes
@pytest.mark.usefixtures("workspace")
def test_it_is_found_by_its_name_and_looked_into(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "my_pubsub", "talk.launch.py", "--validate"]) == 0
    out, err = capsys.readouterr()
    assert out.startswith("no mistake found in ")
    assert err == "robolink: rviz2 was not looked into: it makes no node\n"
