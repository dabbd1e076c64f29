"""ROS 2's launch files by the commands and in tests: launch, its options, simulate, and robolink.testing."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.impl.log_output import Record
from robolink.interfaces.std_msgs.msg import String
from robolink.testing import System
from tests.support.launched_systems import said
from tests.support.ros_launch import TALKER, write

SYSTEM = """
DeclareLaunchArgument("word", default_value=["hel", "lo"], description="The word."),
DeclareLaunchArgument("more", choices=["a", "b"], default_value="a"),
Node(package="controller_manager", executable="ros2_control_node"),
Node(package="bot", executable="talker", namespace="r", parameters=[{"word": LaunchConfiguration("word")}]),
"""


def test_arguments_are_shown(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(package, SYSTEM)
    code, out, err = said(capsys, "bot", "bot.launch.py", "--show-args")
    assert (code, err) == (0, "")
    assert out == "word  The word. (default: hello)\nmore  (default: a; one of a, b)\n"
    assert json.loads(said(capsys, "bot", "bot", "-s", "--json")[1])[0]["default"] == "hello"


def test_what_a_file_prints_is_apart_from_what_a_machine_reads(
    package: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(package, "print('read')\ndef generate_launch_description():\n    return LaunchDescription([])")
    assert said(capsys, str(path), "-s", "--json") == (0, "[]\n", "read\n")
    code, out, err = said(capsys, str(path), "--validate", "--json")
    assert (code, json.loads(out)["mistakes"], err) == (0, [], "read\n")
    assert said(capsys, str(path), "-s")[1].startswith("read\n")


def test_the_version_of_ros_is_set_for_files_and_nodes(package: Path, system: System) -> None:
    text = TALKER.replace(".value))", '.value + os.environ["ROS_DISTRO"]))')
    (package / "bot" / "talker.py").write_text(f"import os\n{text}")
    read = write(
        package,
        """
        import os
        def generate_launch_description():
            word = ["v", EnvironmentVariable("ROS_VERSION"), os.environ["ROS_PYTHON_VERSION"]]
            return LaunchDescription([Node(package="bot", executable="talker", parameters=[{"word": word}])])
        """,
    )
    system.launch(read)
    assert system.expect("/chatter", type=String).data == "v23jazzy"


@pytest.mark.processes
def test_a_program_with_the_terminal_of_its_prefix_is_noted(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    action = 'Node(package="teleop_twist_keyboard", executable="teleop_twist_keyboard", prefix="env")'
    code, out, err = said(capsys, str(write(package, action)), "--validate")
    assert code == 0, out
    assert "was not looked into: teleop_twist_keyboard reads keys from a terminal" in err


@pytest.mark.processes
def test_a_file_is_validated(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(package, SYSTEM.replace('"word": L', '"wrd": L'))
    code, out, err = said(capsys, str(path), "--validate")
    line = path.read_text().partition("wrd")[0].count("\n") + 1
    assert (code, out) == (1, f"{path}:{line}: 'r/talker' declares no parameter 'wrd' (did you mean 'word'?)\n")
    assert "left out: controller_manager ros2_control_node" in err
    assert err.count("\n") == 1


def test_a_system_in_virtual_time(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(package, SYSTEM)
    assert main(["simulate", "bot", "bot.launch.py", "word:=ho", "--duration", "10", "--json"]) == 0
    out, err = capsys.readouterr()
    assert [(each["name"], each["state"]) for each in json.loads(out)["programs"]] == [("r/talker", "running")]
    assert "left out: controller_manager ros2_control_node" in err


def test_a_system_under_test(package: Path, system: System) -> None:
    system.launch(write(package, SYSTEM), arguments={"word": "hey"})
    assert system.expect("/r/chatter", type=String).data == "hey"


def test_parameters_for_every_node_are_not_missed_by_those_that_lack_them(
    package: Path, log_lines: list[Record]
) -> None:
    (package / "config" / "all.yaml").write_text("/**: {ros__parameters: {word: hey, max_speed: 1.0}}\n")
    node = """
    Node(package="bot", executable="talker", name="{}", parameters=[[FindPackageShare("bot"), "/config/all.yaml"], {}]),
    """
    with System() as system:
        system.launch(write(package, node.format("a", {}) + node.format("b", {"colour": 1.0})))
        assert system.expect("/chatter", type=String).data == "hey"
    assert [each.message for each in log_lines if "was given" in each.message] == [
        "parameter 'colour' was given, but no node declared it"
    ]


@pytest.mark.processes
def test_a_system_of_processes(package: Path) -> None:
    write(package, 'Node(package="bot", executable="once", on_exit=Shutdown(), parameters=[{"code": 3}]),' + SYSTEM)
    command = [sys.executable, "-m", "robolink", "launch", "bot", "bot.launch.py"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 3
    assert "left out: controller_manager ros2_control_node" in done.stdout
    assert "[launch] once ended with exit code 3" in done.stdout


@pytest.mark.processes
def test_our_own_files_need_none_of_it(package: Path) -> None:
    file = package / "launch" / "own.yaml"
    file.write_text("nodes: [node: bot talker]\n")
    code = (
        "import sys; from robolink.launch.system import read_system; import robolink.launch.command\n"
        f"read_system({str(file)!r})\n"
        "print([each for each in sys.modules if 'launch.ros' in each])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
