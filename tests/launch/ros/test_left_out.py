"""Programs that cannot run here are left out with a line, and the rest runs on."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.ros_launch import FIRST, read

AT = f"bot.launch.py:{FIRST + 2}: "
LEFT_OUT = [
    (
        'Node(package="controller_manager", executable="ros2_control_node")',
        "left out: controller_manager ros2_control_node is not here: ",
    ),
    ('Node(package="slam_all", executable="go")', "left out: slam_all go is not here: no package of this name is in"),
    (
        'Node(package="bot", executable="fast")',
        "left out: bot fast is a C++ program, and robolink builds none",
    ),
    ('ExecuteProcess(cmd=["gzserver", "x.world"])', "left out: no program 'gzserver' is on the PATH"),
    (
        'IncludeLaunchDescription(PythonLaunchDescriptionSource([FindPackageShare("gazebo_ros"), "/g.launch.py"]))',
        "left out: g.launch.py, since package gazebo_ros is not here: Gazebo, a simulator in C++; ",
    ),
    (
        'IncludeLaunchDescription(get_package_share_directory("nobody") + "/launch/g.launch.py")',
        "left out: g.launch.py, since package nobody is not here",
    ),
    (
        'IncludeLaunchDescription(get_package_share_directory("cartographer_ros") + "/launch/mapping_launch.py")',
        "left out: mapping_launch.py, since package cartographer_ros is not here: ",
    ),
    (
        'OpaqueFunction(function=lambda context: open(get_package_share_directory("nobody") + "/urdf/x"))',
        "left out: package nobody is not here, and its urdf/x is needed",
    ),
]


@pytest.mark.parametrize(("action", "line"), LEFT_OUT)
def test_one_line_for_each(package: Path, action: str, line: str) -> None:
    (package / "CMakeLists.txt").write_text("add_executable(fast src/fast.cpp)\n")
    system = read(package, f'{action},\nNode(package="bot", executable="talker"),')
    assert [each.name for each in system.entries] == ["talker"]
    (note,) = system.notes
    assert note.startswith(AT + line)


def test_a_file_of_parameters_that_is_not_there(package: Path) -> None:
    (package / "config" / "params.yaml").write_text("/**: {ros__parameters: {word: x}}\n")
    system = read(
        package,
        """
        Node(package="bot", executable="talker", parameters=[[FindPackageShare("bot"), "/config/parms.yaml"]]),
        Node(package="bot", executable="talker", parameters=[get_package_share_directory("nobody") + "/p.yaml"]),
        """,
    )
    assert [each.node.parameters for each in system.entries] == [{}, {}]
    missing, of_nobody = system.notes
    assert missing.startswith(f"{AT}left out: there is no parameter file {package}/config/parms.yaml (did you mean")
    assert of_nobody.endswith("left out: the parameters in p.yaml, since package nobody is not here")


def test_an_argument_that_nothing_reads_is_told(package: Path) -> None:
    system = read(package, 'DeclareLaunchArgument("speed", default_value="1"), LogInfo(msg="x")', sped="2")
    assert system.notes == ["x", "nothing reads the argument 'sped' (did you mean 'speed'?)"]
