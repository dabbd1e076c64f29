"""A package of its own with launch, config, interfaces, a model and two nodes: launched, simulated, and under test."""

from __future__ import annotations

import importlib
import json
import subprocess

import pytest

from robolink.testing import System
from robolink.workspace import use_interfaces
from tests.support.commands import ROBOLINK
from tests.support.tutorial_workspace import TutorialWorkspace, edit

INSTALL = """\
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)

rosidl_generate_interfaces(${PROJECT_NAME}
  "msg/WheelState.msg"
  "srv/SetSpeed.srv"
  DEPENDENCIES std_msgs
)
install(PROGRAMS scripts/wheel_driver.py scripts/wheel_watcher.py DESTINATION lib/${PROJECT_NAME})
install(DIRECTORY launch config urdf DESTINATION share/${PROJECT_NAME})
"""


@pytest.fixture
def my_robot(ros2_ws: TutorialWorkspace) -> TutorialWorkspace:
    package = ros2_ws.create("my_robot", options="--dependencies rclpy std_msgs sensor_msgs robot_state_publisher")
    edit(package / "CMakeLists.txt", ("find_package(ament_cmake REQUIRED)\n", INSTALL))
    return ros2_ws


def test_what_it_has(my_robot: TutorialWorkspace) -> None:
    assert my_robot.ros2("ros2 pkg executables my_robot") == "my_robot wheel_driver.py\nmy_robot wheel_watcher.py\n"
    assert my_robot.ros2("ros2 interface package my_robot") == "my_robot/msg/WheelState\nmy_robot/srv/SetSpeed\n"
    assert my_robot.ros2("ros2 launch my_robot robot.launch.py --show-args") == (
        "speed  First speed, in rad/s. (default: 1.0)\n"
    )


@pytest.mark.processes
@pytest.mark.usefixtures("my_robot")
def test_it_is_launched() -> None:
    words = ("launch", "my_robot", "robot.launch.py", "speed:=4.0", "--duration", "3")
    done = subprocess.run([*ROBOLINK, *words], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stdout
    for line in ("[wheel_driver]: turning at 4.0 rad/s", "[wheel_watcher]: too fast: 4.0 rad/s"):
        assert line in done.stdout
    assert "[robot_state_publisher]" in done.stdout
    assert "Traceback" not in done.stdout


def test_it_is_simulated(my_robot: TutorialWorkspace) -> None:
    told = json.loads(my_robot.ros2("ros2 simulate my_robot robot.launch.py --duration 10 --json"))
    assert [(each["name"], each["state"]) for each in told["programs"]] == [
        ("robot_state_publisher", "running"),
        ("wheel_driver", "running"),
        ("wheel_watcher", "running"),
    ]
    assert told["messages"]["/wheel_state"] == told["messages"]["/joint_states"] == 200


@pytest.mark.slow
@pytest.mark.usefixtures("my_robot")
def test_it_is_tested(system: System) -> None:
    use_interfaces()
    set_speed = importlib.import_module("my_robot.srv").SetSpeed
    system.launch("my_robot robot.launch.py", arguments={"speed": 2.0})
    system.run(1.0)
    assert system.expect("wheel_state").angle == pytest.approx(2.0, abs=0.2)
    assert system.expect("/tf", lambda tf: tf.transforms[0].child_frame_id == "wheel")
    assert system.call(set_speed, "set_speed", set_speed.Request(speed=9.0)).reason == "5.0 rad/s is the limit"
    assert system.call(set_speed, "set_speed", set_speed.Request(speed=4.0)).accepted
    system.expect_log("too fast: 4.0 rad/s")
    assert system.call(set_speed, "set_speed", set_speed.Request(speed=0.5)).accepted
    system.expect_log("slow again")
