"""Type stubs: checkers know rclpy, messages and a workspace's own types, and find a wrong field and argument."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.scaffold.stubs import FOLDER, settings_to_change, write_stubs
from tests.support import node_modules

TALKER = """\
import rclpy
from my_msgs.msg import Wheels
from my_msgs.srv import Ask
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String


class Talker(Node):
    def __init__(self) -> None:
        super().__init__("talker")
        self.publisher = self.create_publisher(String, "chatter", 10)
        self.wheels = self.create_publisher(Wheels, "wheels", 10)
        self.create_service(Ask, "ask", self.ask)
        self.create_timer(0.5, self.tick)

    def tick(self) -> None:
        self.publisher.publish(String(data="hello"))
        message = Wheels(names=["left"])
        message.stamp = self.get_clock().now().to_msg()
        message.speed.x = 1.0
        self.wheels.publish(message)

    def ask(self, request: Ask.Request, response: Ask.Response) -> Ask.Response:
        response.ok = request.a > Wheels.MOST
        return response


def main() -> None:
    rclpy.init()
    try:
        rclpy.spin(Talker())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()
"""
FOLLOWER = """\
import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from sensor_msgs.msg import LaserScan
from tf2_ros import Buffer, TransformListener


class Follower(Node):
    def __init__(self) -> None:
        super().__init__("follower")
        self.declare_parameter("distance", 0.5)
        self.buffer = Buffer()
        self.listener = TransformListener(self.buffer, self)
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.publisher = self.create_publisher(Twist, "cmd_vel", qos)
        self.create_subscription(LaserScan, "scan", self.heard, qos_profile_sensor_data)

    def heard(self, scan: LaserScan) -> None:
        command = Twist()
        command.linear.x = 0.2 if min(scan.ranges) > 0.5 else 0.0
        self.publisher.publish(command)
        self.get_logger().info(f"{scan.header.frame_id} {Duration(seconds=1).nanoseconds}")


def main(args: list[str] | None = None) -> None:
    with rclpy.init(args=args):
        rclpy.spin(Follower())
"""
WRONG = """\
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Wrong(Node):
    def __init__(self) -> None:
        super().__init__("wrong")
        self.publisher = self.create_publisher(Twist, "cmd_vel", "ten".upper)

    def ahead(self) -> None:
        command = Twist()
        command.linear.z1 = 1.0
        self.publisher.publish(command)
"""
WRONG_LINES = [8, 12]
OWN_WRONG = 'from my_msgs.msg import Wheels\n\nWheels(name=["left"])\nWheels().speed = 1.0\n'
OWN_WRONG_LINES = [3, 4]


@pytest.fixture(scope="module")
def workspace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A workspace with stubs, with messages of its own, and four programs."""
    folder = tmp_path_factory.mktemp("workspace")
    package = folder / "interfaces" / "my_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "srv").mkdir()
    fields = "uint8 MOST=3\nstring[] names\ngeometry_msgs/Vector3 speed\nbuiltin_interfaces/Time stamp\nWheel[2] both\n"
    (package / "msg" / "Wheels.msg").write_text(fields)
    (package / "msg" / "Wheel.msg").write_text("float64 v\n")
    (package / "srv" / "Ask.srv").write_text("int64 a\n---\nbool ok\n")
    programs = {"talker": TALKER, "follower": FOLLOWER, "wrong": WRONG, "own_wrong": OWN_WRONG}
    for name, text in programs.items():
        (folder / f"{name}.py").write_text(text)
    assert write_stubs(folder) == [FOLDER, "mypy.ini", "pyrightconfig.json"]
    return folder


@pytest.mark.processes
@pytest.mark.slow
def test_mypy_finds_both_mistakes_and_nothing_else(workspace: Path) -> None:
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", "cache", "talker.py", "follower.py"]
    command += ["wrong.py", "own_wrong.py", "--output", "json"]
    done = subprocess.run(command, cwd=workspace, capture_output=True, text=True, check=False, timeout=100)
    found = [json.loads(line) for line in done.stdout.splitlines()]
    errors = sorted((each["file"], each["line"]) for each in found if each["severity"] == "error")
    expected = [("own_wrong.py", each) for each in OWN_WRONG_LINES] + [("wrong.py", each) for each in WRONG_LINES]
    assert errors == expected, done.stdout + done.stderr


@pytest.mark.processes
@pytest.mark.slow
def test_pyright_finds_both_mistakes_and_nothing_else(workspace: Path) -> None:
    node_modules.need("pyright")
    script = node_modules.FOLDER / "node_modules" / "pyright" / "index.js"
    command = node_modules.command(script, "--pythonpath", sys.executable, "--outputjson")
    done = subprocess.run(command, cwd=workspace, capture_output=True, text=True, check=False, timeout=100)
    found = json.loads(done.stdout)["generalDiagnostics"]
    places = sorted({(Path(each["file"]).name, each["range"]["start"]["line"] + 1) for each in found})
    expected = [("own_wrong.py", each) for each in OWN_WRONG_LINES] + [("wrong.py", each) for each in WRONG_LINES]
    assert places == expected, done.stdout


@pytest.mark.slow
def test_stubs_are_written_anew_and_settings_stay(workspace: Path, tmp_path: Path) -> None:
    folder = tmp_path / "workspace"
    shutil.copytree(workspace, folder)
    (folder / FOLDER / "left_over.pyi").write_text("")
    (folder / "mypy.ini").write_text("[mypy]\nstrict = true\n")
    (folder / "pyrightconfig.json").unlink()
    (folder / "pyproject.toml").write_text("[tool.pyright]\n[tool.mypy]\n")
    assert write_stubs(folder) == [FOLDER]
    assert not (folder / FOLDER / "left_over.pyi").exists()
    assert (folder / "mypy.ini").read_text() == "[mypy]\nstrict = true\n"
    assert settings_to_change(folder) == {
        "mypy.ini": "mypy_path = typings",
        "pyproject.toml": '"reportMissingModuleSource": false, "ignore": ["typings"]',
    }


def test_settings_that_name_the_stubs_need_no_change(workspace: Path) -> None:
    assert settings_to_change(workspace) == {}


def test_a_stub_has_the_names_that_a_program_can_import(workspace: Path) -> None:
    """Not those that a module of robolink's imports for types alone."""
    text = (workspace / FOLDER / "rclpy" / "node.pyi").read_text()
    assert "from robolink.node import Node as Node\n" in text
    assert "TYPE_CHECKING" not in text
    assert (
        "from robolink.interfaces.geometry_msgs.msg import Twist as Twist\n"
        in (workspace / FOLDER / "geometry_msgs" / "msg.pyi").read_text()
    )
