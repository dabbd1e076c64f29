"""Launch files of ROS's tutorials with turtlesim: its own multisim.launch.py, and the one of mimic, in virtual time."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.launch.lookup import find
from robolink.testing import System
from robolink.workspace.programs import program_folder

MIMIC = """
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
        Node(package="turtlesim", namespace="turtlesim1", executable="turtlesim_node", name="sim"),
        Node(package="turtlesim", namespace="turtlesim2", executable="turtlesim_node", name="sim"),
        Node(
            package="turtlesim",
            executable="mimic",
            name="mimic",
            remappings=[
                ("/input/pose", "/turtlesim1/turtle1/pose"),
                ("/output/cmd_vel", "/turtlesim2/turtle1/cmd_vel"),
            ],
        ),
    ])
"""
CIRCLE = Twist(linear=Vector3(x=2.0), angular=Vector3(z=-1.8))


def test_one_turtle_mimics_another(system: System, tmp_path: Path) -> None:
    file = tmp_path / "turtlesim_mimic_launch.py"
    file.write_text(MIMIC)
    system.launch(file)
    system.run(1.0)
    system.publish("/turtlesim1/turtle1/cmd_vel", CIRCLE)
    system.expect("/turtlesim2/turtle1/pose", lambda pose: pose.theta < -1.6, within=3.0)
    assert not system.failures


def test_two_turtlesims(system: System) -> None:
    folder = program_folder("turtlesim")
    assert folder is not None
    system.launch(folder / "launch" / "multisim.launch.py")
    system.run(1.0)
    assert set(system.nodes) == {"/turtlesim1/turtlesim", "/turtlesim2/turtlesim"}
    system.publish("/turtlesim1/turtle1/cmd_vel", CIRCLE)
    system.expect("/turtlesim1/turtle1/pose", lambda pose: pose.theta < -1.6, within=3.0)
    assert system.expect("/turtlesim2/turtle1/pose").theta == 0.0


@pytest.mark.parametrize("name", ["multisim.launch.py", "multisim"])
def test_its_launch_file_is_found_by_the_package(name: str) -> None:
    assert find(["turtlesim", name]).name == "multisim.launch.py"


def test_a_misspelt_one_is_not(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", "turtlesim", "multi"]) == 1
    told = "robolink: no launch file named 'multi' in package turtlesim, which has multisim.launch.py\n"
    assert capsys.readouterr().err == told
