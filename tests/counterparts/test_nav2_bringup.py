"""nav2_bringup: launch files of a whole navigation, under Nav2's names."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from robolink.action import ActionClient
from robolink.companions.ament_index import get_package_share_directory
from robolink.geometry.plane import Pose
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import Twist, Vector3
from robolink.interfaces.nav2_msgs.action import NavigateToPose
from robolink.interfaces.nav_msgs.msg import OccupancyGrid
from robolink.launch import plan, shared_process
from robolink.launch.lookup import find, parameter_file
from robolink.testing import System
from tests.support.navigation_lives import pose_message

SHARE = Path(get_package_share_directory("nav2_bringup"))


def test_the_package_is_found_by_its_name() -> None:
    assert (SHARE / "params/nav2_params.yaml").is_file()
    assert find(("nav2_bringup", "bringup_launch.py")) == SHARE / "launch/bringup_launch.py"
    assert parameter_file("nav2_bringup params/nav2_params.yaml", None, Path()) == SHARE / "params/nav2_params.yaml"
    with pytest.raises(LookupError, match=r"did you mean 'params/nav2_params.yaml'"):
        parameter_file("nav2_bringup params/nav2_parms.yaml", None, Path())


def test_a_launch_file_names_the_parameters_of_a_package(tmp_path: Path) -> None:
    text = (
        "nodes: [{node: nav2_map_server::MapServer, name: amcl, process: nav2,"
        " parameters: nav2_bringup params/nav2_params.yaml}]"
    )
    (process,) = plan(tmp_path / "x.yaml", text=text)
    (member,) = shared_process.read(process.input)
    assert "max_beams:=60" in member.args
    assert "/local_costmap/local_costmap:width:=3" in member.args  # the server makes that node itself


@pytest.mark.slow
def test_navigate_drives_to_a_click_in_the_page(system: System) -> None:
    system.launch("navigate")
    system.expect_log("Managed nodes are active", within=10.0)
    system.run(1.0)
    system.publish("/goal_pose", pose_message(Pose(4.0, 4.2, 1.57)))
    system.expect_log("Goal succeeded", within=30.0)
    robot = system.robot()
    assert math.dist((robot.pose.x, robot.pose.y), (4.0, 4.2)) < 0.35
    assert robot.contacts == 0


@pytest.mark.slow
def test_map_it_makes_a_map_while_somebody_drives(system: System) -> None:
    system.launch("map_it")
    system.expect_log("Managed nodes are active", within=10.0)
    system.run(1.0)
    before = known(system)
    for _ in range(60):
        system.publish("/cmd_vel", Twist(linear=Vector3(x=0.4)))
        system.run(0.1)
    system.run(6.0)
    assert known(system) > before > 1000


def known(system: System) -> int:
    """Count the cells of the map that are known."""
    return sum(each >= 0 for each in system.expect("/map", type=OccupancyGrid).data)


@pytest.mark.processes
@pytest.mark.slow
def test_navigate_drives_in_processes_and_real_time() -> None:
    with System(seed=1, transport="zenoh") as system:
        system.launch("navigate")
        system.expect_log("Managed nodes are active", within=40.0)
        system.expect("/amcl_pose", within=20.0)
        client = ActionClient(system.node, NavigateToPose, "navigate_to_pose")
        assert client.wait_for_server(timeout_sec=10.0)
        goal = NavigateToPose.Goal(pose=pose_message(Pose(2.0, 4.0)))
        handle = system.result(client.send_goal_async(goal), within=20.0)
        assert system.result(handle.get_result_async(), within=40.0).status == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
def test_a_simulation_drives_to_a_click_too(system: System) -> None:
    system.launch(SHARE / "launch/tb3_simulation_launch.py")
    system.expect_log("Managed nodes are active", within=20.0)
    system.run(3.0)
    system.publish("/goal_pose", pose_message(Pose(4.0, 4.2, 1.57)))
    system.expect_log("Goal succeeded", within=30.0)
    robot = system.robot()
    assert math.dist((robot.pose.x, robot.pose.y), (4.0, 4.2)) < 0.35


@pytest.mark.slow
def test_a_simulation_with_slam_drives_on_the_map_that_it_makes(system: System) -> None:
    system.launch(SHARE / "launch/tb3_simulation_launch.py", {"slam": "True"})
    system.expect_log("Managed nodes are active", within=20.0)
    system.run(6.0)
    place = system.robot().pose
    system.publish("/goal_pose", pose_message(Pose(place.x + 1.5, place.y, 0.0)))
    system.expect_log("Goal succeeded", within=30.0)
    assert math.dist((system.robot().pose.x, system.robot().pose.y), (place.x, place.y)) > 1.0
