"""Launch files of webots_ros2_driver: a world, a driver with a Python plugin, and the topics of its devices."""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from robolink.cli.main import main
from robolink.counterparts.webots_ros2_driver.relays import DeviceError, as_webots_scan, period
from robolink.counterparts.webots_ros2_driver.section import read_section
from robolink.exceptions import DocumentError
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.rosgraph_msgs.msg import Clock
from robolink.interfaces.sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, Range
from robolink.launch.ros.launch_ros.actions import Node as NodeAction
from robolink.launch.ros.surroundings import surroundings
from robolink.launch.system import read_system
from robolink.testing import System
from robolink.webots_controller import webots_controller
from robolink.webots_controller.sensors import words_of
from tests.support.systems import log
from tests.support.webots_package import CART, EYES, make_webots_package, robot, urdf


@pytest.fixture(autouse=True)
def workspace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A workspace, and the path of imports and the package's modules as before afterwards."""
    monkeypatch.setattr(sys, "path", list(sys.path))
    monkeypatch.setattr(sys, "argv", list(sys.argv))
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    for name in [each for each in sys.modules if each.partition(".")[0] == "pen"]:
        del sys.modules[name]


@pytest.mark.slow
def test_a_robot_drives_and_avoids(system: System, workspace: Path) -> None:
    system.launch(make_webots_package(workspace))
    odometry, left = system.messages("/odom", Odometry), system.messages("/left_eye", Range)
    system.run(20.0)
    assert max(each.pose.pose.position.x for each in odometry) > 0.5
    assert max(abs(each.twist.twist.linear.x) for each in odometry) == pytest.approx(0.1, abs=0.01)
    assert min(each.twist.twist.angular.z for each in odometry) < -1.5  # turned away from the wall
    for each in (each.pose.pose.position for each in odometry):
        assert max(abs(each.x), abs(each.y)) < 0.95
    assert {each.header.frame_id for each in left} == {"left_eye_link"}
    assert max(each.range for each in left) == pytest.approx(0.3)  # nothing there: the end of the range, as in Webots
    assert system.expect("/clock", type=Clock).clock.sec < 60  # of the supervisor: simulated time


@pytest.mark.slow
def test_devices_have_the_topics_of_webots_driver(system: System, workspace: Path) -> None:
    imu = '<plugin type="webots_ros2_driver::Ros2IMU"><topicName>/tilt</topicName><alwaysOn>true</alwaysOn></plugin>'
    rate = "<ros><topicName>/laser</topicName><updateRate>2</updateRate></ros>"
    lidar = f'<device reference="LDS" type="Lidar">{rate}</device>'
    system.launch(make_webots_package(workspace, webots=lidar + imu))
    heard: dict[str, list[Any]] = {}
    for topic, kind in (
        ("/laser", LaserScan),
        ("/seen", Image),
        ("/my_cart/front/camera_info", CameraInfo),
        ("/my_cart/eye_left", Range),
    ):
        system.node.create_subscription(kind, topic, heard.setdefault(topic, []).append, 10)
    tilts, unheard = system.messages("/tilt", Imu), system.messages("/my_cart/eye_right", Range)
    system.run(6.0)
    assert 8 <= len(heard["/laser"]) <= 13  # 2 Hz, of a lidar that measures faster
    scan, own = heard["/laser"][-1], system.expect("/scan")
    assert (scan.angle_min, scan.angle_max) == (own.angle_max, own.angle_min)
    assert scan.angle_increment == -own.angle_increment < 0.0
    assert heard["/my_cart/eye_left"][-1].radiation_type == Range.INFRARED
    assert heard["/my_cart/eye_left"][-1].field_of_view == pytest.approx(1.5708, abs=1e-3)
    assert heard["/seen"][-1].width == heard["/my_cart/front/camera_info"][-1].width == 32
    assert heard["/my_cart/eye_left"][-1].range == pytest.approx(0.3)
    assert tilts[-1].linear_acceleration.z == pytest.approx(9.81, abs=0.05)
    assert unheard == []  # nobody listens, and it is not always on


@pytest.mark.slow
def test_without_a_plugin_the_world_obeys_cmd_vel(system: System, workspace: Path) -> None:
    control = '<plugin type="webots_ros2_control::Ros2Control" />'
    wanted = EYES + control + '<device reference="gps" type="GPS"/><device reference="eye lft" type="DistanceSensor"/>'
    system.launch(make_webots_package(workspace, webots=wanted))
    odometry = system.messages("/odom", Odometry)
    system.run(1.4)
    assert odometry[-1].twist.twist.linear.x > 0.05  # the avoider publishes cmd_vel, and no program has the motors
    said = "\n".join(log(system))
    assert "left out: plugin webots_ros2_control::Ros2Control: it needs ros2_control; the world takes cmd_vel" in said
    assert "left out: device 'gps': the world publishes nothing of a GPS" in said
    assert "left out: device 'eye lft': the world's robot has none of this name (did you mean 'eye_left'?)" in said


@pytest.mark.slow
def test_each_driver_finds_its_own_robot(system: System, workspace: Path) -> None:
    two = robot("other", 0.5) + robot("my cart", -0.5)
    system.launch(make_webots_package(workspace, robots=two))
    mine, others = system.messages("/my_cart/odom", Odometry), system.messages("/other/odom", Odometry)
    system.run(3.0)
    assert mine[-1].pose.pose.position.x > 0.1
    assert others[-1].pose.pose.position.x == pytest.approx(0.0, abs=1e-6)


@pytest.mark.slow
def test_a_driver_says_for_whom_it_waits(system: System, workspace: Path) -> None:
    system.launch(make_webots_package(workspace, robots=robot("other", 0.5) + robot("third", -0.5)))
    system.run(7.0)
    assert "waiting for the robot 'my cart': there is 'other', 'third'" in log(system)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("plugin", "text"),
    [
        ("pen.crt.Cart", "there is no module 'pen.crt' (did you mean 'cart'?)"),
        ("pen.cart.Car", "'pen.cart' has no class 'Car' (did you mean 'Cart'?)"),
        ("pan.cart.Cart", "there is no module 'pan': no package 'pan' is in the workspace"),
        ("Cart", "expected PACKAGE.MODULE.CLASS, got 'Cart'"),
    ],
)
def test_a_plugin_that_is_not_there(
    plugin: str, text: str, workspace: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = make_webots_package(workspace, webots=CART.replace("pen.cart.Cart", plugin))
    assert main(["simulate", str(file), "--duration", "1"]) == 1
    place = f"{workspace / 'src' / 'pen' / 'resource' / 'cart.urdf'}:3: "
    assert f"{place}{text}" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("no such robot", "robot_description: expected the path of a .urdf or .xacro file, got 'no such robot'"),
        ("<car/>", "robot_description:1: expected <robot>, got <car>: this is not URDF"),
        (urdf("<device/>"), "robot_description:3: a <device> needs its name in the world"),
        (urdf("<plugin/>"), "robot_description:3: a <plugin> needs its class"),
        ("<robot><webots></robot>", "robot_description:1"),
        ("/none/robot.urdf", "/none/robot.urdf: No such file or directory"),
    ],
)
def test_mistakes_in_a_robot_description(text: str, reason: str) -> None:
    with pytest.raises(DocumentError, match=re.escape(reason)):
        read_section(text)


def test_sections() -> None:
    assert read_section("") == read_section("<robot/>") == ([], [])
    devices, plugins = read_section(urdf(EYES + CART))
    assert [(each.name, each.settings["topicName"]) for each in devices] == [
        ("eye left", "/left_eye"),
        ("eye right", "/right_eye"),
    ]
    assert [(each.kind, each.settings) for each in plugins] == [("pen.cart.Cart", {"halfAxle": "0.05"})]


def test_scans_begin_at_the_left() -> None:
    scan = LaserScan(angle_min=-1.0, angle_max=0.5, angle_increment=0.5, ranges=[1.0, 2.0, 3.0, 4.0])
    scan.intensities = [5.0, 6.0, 7.0, 8.0]
    left = LaserScan(angle_min=0.5, angle_max=-1.0, angle_increment=-0.5, ranges=[4.0, 3.0, 2.0, 1.0])
    left.intensities = [8.0, 7.0, 6.0, 5.0]
    as_webots_scan(scan)
    assert scan == left


def test_rates() -> None:
    assert (period(""), period("10")) == (0.0, 0.1)
    for text in ("0", "-1", "fast", "nan"):
        with pytest.raises(DeviceError, match=re.escape(f"got '{text}'")):
            period(text)
    assert math.isfinite(period("1e-300"))


def test_words_of_devices() -> None:
    assert words_of("motor1") & words_of("encoder1") == {"1"}
    assert not words_of("motor1") & words_of("encoder2")


def test_one_name_is_an_action_for_launch_files_and_a_node_for_programs() -> None:
    name = "webots_ros2_driver.webots_controller"
    before = sys.modules.get(name)
    with surroundings(None):
        from webots_ros2_driver import webots_controller as beside  # type: ignore[import-not-found]
        from webots_ros2_driver.webots_controller import WebotsController  # type: ignore[import-not-found]

        assert issubclass(WebotsController, NodeAction)
        assert beside.WebotsController is WebotsController
    assert sys.modules.get(name) is before
    sys.modules.pop(name, None)
    from webots_ros2_driver.webots_controller import WebotsController as Program

    assert Program is webots_controller.WebotsController


def test_what_is_left_out_of_a_launch_file(workspace: Path) -> None:
    file = make_webots_package(workspace)
    file.write_text(
        "from launch import LaunchDescription\n"
        "from webots_ros2_driver.urdf_spawner import URDFSpawner, get_webots_driver_node\n"
        "from webots_ros2_driver.utils import controller_url_prefix\n"
        "from webots_ros2_driver.webots_launcher import Ros2SupervisorLauncher, WebotsLauncher\n"
        "def generate_launch_description():\n"
        "    assert controller_url_prefix() == 'ipc://1234/'\n"
        "    arm = URDFSpawner(name='arm', urdf_path='arm.urdf', translation='0 0 1')\n"
        "    return LaunchDescription([Ros2SupervisorLauncher(), arm])\n"
    )
    system = read_system(file)
    assert (system.entries, len(system.notes)) == ([], 1)
    assert system.notes[0].startswith(
        "pen.launch.py:7: left out: webots_ros2_driver urdf_spawner is not here: it adds a robot"
    )
