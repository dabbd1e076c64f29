"""A ROS 2 package with two nodes, for tests of launch files in Python, XML and ROS 2's YAML."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from robolink.launch.entry import Entry, System
from robolink.launch.system import read_system
from robolink.workspace import VARIABLE

HEAD = """\
from ament_index_python.packages import get_package_share_directory
import launch_ros
from launch import LaunchDescription, events
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.event_handlers import *
from launch_ros.substitutions import *
from launch_ros.descriptions import *

"""
FIRST = HEAD.count("\n") + 1
"""Number of the first line behind it."""

TALKER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.declare_parameter("word", "hi")
        self.declare_parameter("period", 1.0)
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.create_timer(self.get_parameter("period").value, self.tell)

    def tell(self):
        self.publisher.publish(String(data=self.get_parameter("word").value))


def main():
    rclpy.init()
    rclpy.spin(Talker())
"""

ONCE = """
import sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import String


class Once(Node):
    def __init__(self):
        super().__init__("once")
        self.declare_parameter("code", 0)
        self.declare_parameter("after", 1.0)
        self.publisher = self.create_publisher(String, "once", 10)
        self.create_timer(self.get_parameter("after").value, self.end)

    def end(self):
        self.publisher.publish(String(data="ending"))
        sys.exit(self.get_parameter("code").value)


def main():
    rclpy.init()
    rclpy.spin(Once())
"""


def make_package(top: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Make a workspace with a package `bot`, go there, and return the package's folder."""
    package = top / "src" / "bot"
    for folder in ("launch", "config", "bot"):
        (package / folder).mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>bot</name></package>")
    scripts = "['talker = bot.talker:main', 'once = bot.once:main']"
    (package / "setup.py").write_text(
        f"from setuptools import setup\nsetup(name='bot', entry_points={{'console_scripts': {scripts}}})\n"
    )
    (package / "bot" / "__init__.py").write_text("")
    (package / "bot" / "talker.py").write_text(TALKER)
    (package / "bot" / "once.py").write_text(ONCE)
    monkeypatch.setenv("ROBOLINK_LOG_DIR", str(top / "log"))
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.chdir(top)
    return package


def write(package: Path, body: str, name: str = "bot.launch.py") -> Path:
    """Write a launch file whose description has the actions of `body`, or that `body` makes as a whole."""
    body = textwrap.dedent(body).strip("\n")
    if "def generate_launch_description" not in body:
        actions = textwrap.indent(body, "        ")
        body = f"def generate_launch_description():\n    return LaunchDescription([\n{actions}\n    ])"
    path = package / "launch" / name
    path.write_text(f"{HEAD}{body}\n")
    return path


def read(package: Path, body: str, **given: str) -> System:
    """Read a launch file of these actions."""
    return read_system(write(package, body), given)


def only(package: Path, body: str, **given: str) -> Entry:
    """Read a launch file of these actions that starts one process, and leaves nothing out."""
    system = read(package, body, **given)
    assert system.notes == []
    (entry,) = system.entries
    return entry
