"""Python modules that a launch file imports and nobody has: what is made with them is left out, and the rest runs."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

from robolink.exceptions import DocumentError
from robolink.launch.lookup import home_of
from robolink.launch.ros.surroundings import surroundings
from tests.support.ros_launch import FIRST, read, write

IMPORT = "from moveit_configs_utils import Builder, launches\nimport as2_core.as2_names\n"
MADE = (
    'made = Builder("arm", package_name="arm").robot_description(file_path="x.xacro").to_moveit_configs()\n'
    "parts = [ComposableNode(package='bot', plugin='bot::Talker', parameters=[made.to_dict()])]\n"
)
NEEDS = "it needs the Python module moveit_configs_utils, which is not here"
TALKER = "Node(package='bot', executable='talker', {}),"
WITH = [
    "launches.generate_demo(made),",
    "GroupAction([launches.generate_demo(made)]),",
    TALKER.format("name='x', parameters=[made.robot_description, {'a': 1}]"),
    TALKER.format("name='x', parameters=[made.to_dict()]"),
    TALKER.format("name='x', parameters=[{**made.to_dict()}]"),
    TALKER.format("name='x', parameters=[{'a': made.value, 'b': [made.more]}]"),
    TALKER.format("name='x', arguments=['-d', made.path / 'x']"),
    TALKER.format("name='x', arguments=['-d', 'x' + made.path]"),
    TALKER.format("name='x', arguments=made.arguments"),
    TALKER.format("name=made['name']"),
    TALKER.format("remappings=[('a', made.topic)]"),
    TALKER.format("remappings=made.remappings"),
    TALKER.format("condition=IfCondition(made.asked)"),
    TALKER.format("condition=made.condition"),
    "IncludeLaunchDescription(PythonLaunchDescriptionSource(made.path)),",
    "IncludeLaunchDescription(made.source),",
    "OpaqueFunction(function=lambda context: f'{made.path}'),",
    "OpaqueFunction(function=made.function),",
    "ExecuteProcess(cmd=[sys.executable, made.path]),",
    "RegisterEventHandler(made.handler),",
    "ComposableNodeContainer(name='c', namespace='', package='p', executable='e', composable_node_descriptions=parts),",
]


def body(actions: str, before: str = IMPORT) -> str:
    head = f"import sys\n{before}{MADE}"
    return f"{head}def generate_launch_description():\n    return LaunchDescription([{actions}\n    ])\n"


@pytest.mark.slow
@pytest.mark.parametrize("action", WITH)
def test_an_action_of_it_is_left_out_and_the_rest_runs(package: Path, action: str) -> None:
    system = read(package, body(f"{action}\n        Node(package='bot', executable='talker', name='last'),"))
    assert [each.name for each in system.entries] == ["last"]
    first, second, *others = system.notes
    assert first == f"bot.launch.py:{FIRST + 1}: moveit_configs_utils is not here: what is made with it is left out"
    assert second == f"bot.launch.py:{FIRST + 2}: as2_core is not here: what is made with it is left out"
    (left,) = others
    assert left.startswith("bot.launch.py:")
    assert left.partition(": left out: ")[2].removeprefix("parameter 'a': ") == NEEDS


def test_what_a_launch_argument_of_it_is_read_for_is_left_out_too(package: Path) -> None:
    system = read(
        package,
        body(
            "DeclareLaunchArgument('a', default_value=made.path), SetLaunchConfiguration('b', made.path),"
            "Node(package='bot', executable='talker', name=LaunchConfiguration('a')),"
            "Node(package='bot', executable='once', name=LaunchConfiguration('b')),"
            "Node(package='bot', executable='talker', name='last')"
        ),
    )
    assert [each.name for each in system.entries] == ["last"]
    assert [each.endswith(NEEDS) for each in system.notes] == [False, False, True, True, True, True]


def test_an_included_file_that_needs_it_is_left_out_as_a_whole(package: Path) -> None:
    write(package, body("LogInfo(msg=str(made)),"), "arm.launch.py")
    include = "IncludeLaunchDescription([ThisLaunchFileDir(), '/arm.launch.py'])"
    system = read(package, f"{include},\nNode(package='bot', executable='talker'),")
    assert [each.name for each in system.entries] == ["talker"]
    assert system.notes[2:] == [f"bot.launch.py:{FIRST + 2}: left out: {NEEDS}"]


def test_the_file_itself_that_needs_it_is_an_error_of_one_line(package: Path) -> None:
    with pytest.raises(DocumentError) as caught:
        read(
            package,
            f"import os\n{IMPORT}{MADE}where = os.path.join('a', made.path)\ndef generate_launch_description(): 0",
        )
    assert (caught.value.line, caught.value.message) == (FIRST + 5, NEEDS)


def test_a_module_of_the_package_may_import_it_and_is_forgotten(package: Path) -> None:
    (package / "bot" / "helper.py").write_text("import my_company.tools as tools\nvalue = tools.value\n")
    system = read(
        package,
        "from bot.helper import value\ndef generate_launch_description():\n    return LaunchDescription([value])",
    )
    assert system.entries == []
    assert system.notes[0] == "helper.py:1: my_company is not here: what is made with it is left out"
    assert not {"my_company", "my_company.tools", "bot.helper"} & set(sys.modules)
    with pytest.raises(ModuleNotFoundError):
        importlib.import_module("my_company")


CAUGHT = [
    "try:\n    import my_company\nexcept ImportError:\n    my_company = None",
    "try:\n    import moveit_configs_utils as my_company\nexcept (KeyError, ImportError):\n    my_company = None",
    "import importlib.util\nmy_company = importlib.util.find_spec('my_company')",
]


@pytest.mark.parametrize("code", CAUGHT)
def test_a_file_that_asks_whether_it_is_there_hears_the_truth(package: Path, code: str) -> None:
    system = read(
        package,
        f"{code}\nassert my_company is None\n"
        "def generate_launch_description():\n    return LaunchDescription([LogInfo(msg='without')])",
    )
    assert system.notes == ["without"]


MISSPELT = [
    "import std_msg.msg",
    "import launch.actoins",
    "import launch_rso",
    "import numpi",
    "import rclpi",
    "import rospy",
]


@pytest.mark.parametrize("name", MISSPELT)
def test_a_misspelt_module_is_an_error(package: Path, name: str) -> None:
    with pytest.raises(DocumentError) as caught:
        read(package, f"import {name}\ndef generate_launch_description():\n    return LaunchDescription([])")
    assert caught.value.line == FIRST


def test_the_folder_of_a_package_in_cpp_is_no_module(package: Path) -> None:
    (package.parent / "core_cpp" / "src").mkdir(parents=True)
    (package.parent / "core_cpp" / "package.xml").write_text("<package><name>core_cpp</name></package>")
    sys.path.append(str(package.parent))
    system = read(
        package,
        "from core_cpp.names import X\ndef generate_launch_description():\n    return LaunchDescription([X])",
    )
    assert system.notes[0].startswith(f"bot.launch.py:{FIRST}: core_cpp.names is not here: ")
    assert "core_cpp.names" not in sys.modules


def test_a_module_that_only_ros_builds_is_left_out_and_a_misspelt_one_is_an_error(package: Path) -> None:
    file = "import bot.{}\ndef generate_launch_description():\n    return LaunchDescription([LogInfo(msg='on')])"
    assert read(package, file.format("built")).notes[-1] == "on"
    with pytest.raises(DocumentError, match=r"No module named 'bot\.talkr' \(did you mean 'talker'\?\)"):
        read(package, file.format("talkr"))


def test_a_library_gets_no_placeholder(package: Path) -> None:
    with surroundings(home_of(package / "launch", None)), pytest.raises(ModuleNotFoundError):
        importlib.import_module("my_company")  # the statement is importlib's


TESTED = """
import unittest
import launch_testing
import launch_testing.actions
import launch_testing.asserts
import launch_testing.markers
import launch_testing.util
from launch_testing.legacy import LaunchTestService

@launch_testing.markers.keep_alive
def generate_launch_description():
    return LaunchDescription([
        Node(package="bot", executable="talker"),
        launch_testing.util.KeepAliveProc(),
        launch_testing.actions.GTest(path="x"),
        launch_testing.actions.ReadyToTest(),
    ])

@launch_testing.post_shutdown_test()
class AfterShutdown(unittest.TestCase):
    def test_exit_code(self, proc_info):
        launch_testing.asserts.assertExitCodes(proc_info)
"""


def test_a_launch_file_that_is_a_test_launches(package: Path) -> None:
    system = read(package, TESTED)
    assert [each.name for each in system.entries] == ["talker", "python"]
    assert [each.partition(": ")[2] for each in system.notes] == ["left out: no program 'x' is on the PATH"]


def test_a_launch_test_that_is_launched_tells_what_runs_it(package: Path) -> None:
    with pytest.raises(DocumentError, match=r"; it is a launch test: pytest bot.launch.py"):
        read(package, "def generate_test_description():\n    pass\ndef generate_launch_description_(): 0")
