"""Containers of composable nodes: Python classes share a process, components of C++ are left out."""

from __future__ import annotations

from pathlib import Path

import pytest

from robolink.cli.main import main
from robolink.interfaces.std_msgs.msg import String
from robolink.launch.planning import processes
from robolink.launch.system import read_system
from robolink.testing import System
from tests.support.ros_launch import FIRST, read, write

CONTAINER = """
def component(plugin, **more):
    return ComposableNode(package="bot", plugin=plugin, **more)

def generate_launch_description():
    container = ComposableNodeContainer(
        name="box", namespace="ns", package="rclcpp_components", executable="component_container", output="screen",
        composable_node_descriptions=[
            component("bot::Talker", name="one", parameters=[{{"word": "one"}}], remappings=[("chatter", "/said")]),
            component("bot.talker.Talker", name="two", namespace="in",
                      extra_arguments=[{{"use_intra_process_comms": True}}]),
            component("bot::Talker", name="off", condition=IfCondition("false")),
            component("bot::Fast"), component("bot::Faster"),
            ComposableNode(package="image_proc", plugin="image_proc::RectifyNode"),
        ])
    return LaunchDescription([container, {more}])
"""


def test_python_classes_share_the_process(package: Path) -> None:
    system = read(package, CONTAINER.format(more=""))
    (launched,) = processes(system.entries)
    assert (launched.name, [each.name for each in launched.entries]) == ("ns/box", ["one", "in/two"])
    assert launched.entries[0].node.parameters == {"word": "one"}
    assert launched.entries[0].node.remappings == {"chatter": "/said"}
    assert [each.node.endswith("talker.py:Talker") for each in launched.members] == [True, True]
    cpp, absent = system.notes
    assert cpp == (
        f"bot.launch.py:{FIRST + 4}: left out: bot::Fast, bot::Faster of container /ns/box: "
        "package bot has no Python class of this name, and robolink builds no C++"
    )
    assert "left out: image_proc::RectifyNode of container /ns/box: package image_proc is not here" in absent


def test_nodes_are_loaded_into_a_container(package: Path) -> None:
    load = 'LoadComposableNodes(target_container={}, composable_node_descriptions=[component("Talker", name="three")])'
    for target in ("container", "'/ns/box'", "['/ns/', 'box']"):
        system = read(package, CONTAINER.format(more=load.format(target)))
        (launched,) = processes(system.entries)
        assert [each.name for each in launched.entries] == ["one", "in/two", "three"]
    system = read(package, CONTAINER.format(more=load.format("'other'")))
    assert [each.name for each in processes(system.entries)] == ["ns/box", "other"]


def test_a_container_of_nothing_that_runs_here(package: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write(
        package,
        """
        ComposableNodeContainer(name="box", namespace="", package="rclcpp_components", executable="component_container",
                                composable_node_descriptions=[ComposableNode(package="bot", plugin="bot::Fast")]),
        """,
    )
    assert main(["launch", "bot", "bot"]) == 1
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 2)
    assert err.endswith("bot.launch.py: nothing of it can be started\n")


def test_components_that_come_later_have_a_process_of_their_own(package: Path, system: System) -> None:
    later = (
        "TimerAction(period=5.0, actions=[LoadComposableNodes(target_container=container, "
        'composable_node_descriptions=[component("bot::Talker", name="late", remappings=[("chatter", "late")])])])'
    )
    path = write(package, CONTAINER.format(more=later))
    foreseen = processes(read_system(path, foresee=True).entries)
    assert [each.name for each in foreseen] == ["ns/box"]
    said = system.messages("late", type=String)
    system.launch(path)
    assert system.expect("said", type=String).data == "one"
    assert system.expect("in/chatter", type=String).data == "hi"
    assert said == []
    system.run(6.0)
    assert [each.data for each in said][:1] == ["hi"]


@pytest.mark.annex("nav2")
def test_components_of_ros_have_counterparts(package: Path, system: System) -> None:
    (package / "map.yaml").write_text(
        "image: map.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )
    (package / "map.pgm").write_text("P2 1 1 255 0")
    write(
        package,
        f"""
        ComposableNodeContainer(
            name="localization", namespace="", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[
                ComposableNode(
                    package="nav2_map_server", plugin="nav2_map_server::MapServer", name="map_server",
                    parameters=[{{"yaml_filename": {str(package / "map.yaml")!r}}}], remappings=[("map", "/floor")],
                ),
                ComposableNode(
                    package="nav2_lifecycle_manager", plugin="nav2_lifecycle_manager::LifecycleManager",
                    name="manager", parameters=[{{"autostart": True, "node_names": ["map_server"]}}],
                ),
                ComposableNode(package="composition", plugin="composition::Talker"),
                ComposableNode(
                    package="tf2_ros", plugin="tf2_ros::StaticTransformBroadcasterNode", name="fixed",
                    parameters=[{{"frame_id": "map", "child_frame_id": "odom", "translation.x": 2.0}}],
                ),
            ]),
        """,
    )
    system.launch(package / "launch/bot.launch.py")
    system.run(2.0)
    assert list(system.expect("/floor").data) == [100]
    assert system.expect("/tf_static").transforms[0].transform.translation.x == 2
    system.expect("/chatter", type=String)
