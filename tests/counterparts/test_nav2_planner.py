"""nav2_planner: paths by its actions and its service, in virtual time."""

from __future__ import annotations

import math
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest

from robolink.action import ActionClient
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.composition_interfaces.srv import LoadNode, UnloadNode
from robolink.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState, GetState
from robolink.interfaces.nav2_msgs.action import ComputePathThroughPoses, ComputePathToPose
from robolink.interfaces.nav2_msgs.srv import IsPathValid
from robolink.interfaces.nav_msgs.msg import OccupancyGrid, Path
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from robolink.tf2.static_transform_broadcaster import StaticTransformBroadcaster

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
PARAMETERS = """
planner_server:
  ros__parameters:
    expected_planner_frequency: 20.0
    GridBased:
      plugin: "nav2_navfn_planner/NavfnPlanner"
      tolerance: 0.3
      use_astar: false
      allow_unknown: true
global_costmap:
  global_costmap:
    ros__parameters:
      update_frequency: 1.0
      robot_radius: 0.17
      resolution: 0.05
      track_unknown_space: true
      plugins: ["static_layer", "inflation_layer"]
      static_layer: {plugin: "nav2_costmap_2d::StaticLayer"}
      inflation_layer: {plugin: "nav2_costmap_2d::InflationLayer", cost_scaling_factor: 3.0, inflation_radius: 0.7}
"""
Result = ComputePathToPose.Result


def change(system: System, transition: int, node: str = "planner_server") -> bool:
    request = ChangeState.Request(transition=Transition(id=transition))
    return bool(system.call(ChangeState, f"/{node}/change_state", request).success)


def configured(system: System, folder: File, text: str = PARAMETERS) -> None:
    (folder / "parameters.yaml").write_text(text)
    system.start("nav2_planner planner_server", args=["--ros-args", "--params-file", str(folder / "parameters.yaml")])
    assert change(system, Transition.TRANSITION_CONFIGURE)


def started(system: System, folder: File, text: str = PARAMETERS) -> None:
    """Start a server in a room of 5 x 4 m with the robot at (1, 1)."""
    configured(system, folder, text)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    place_robot(system, 1.0, 1.0)
    publish_map(system, room())
    system.run(1.5)


def place_robot(system: System, x: float, y: float) -> None:
    found = TransformStamped(child_frame_id="base_link")
    found.header.frame_id = "map"
    found.transform.translation.x, found.transform.translation.y = x, y
    StaticTransformBroadcaster(system.node).sendTransform(found)


def room() -> np.ndarray:
    cells = np.zeros((80, 100), np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = 100
    return cells


def publish_map(system: System, cells: np.ndarray) -> None:
    message = OccupancyGrid(data=cells.ravel())
    message.header.frame_id = "map"
    message.info.resolution = 0.05
    message.info.height, message.info.width = cells.shape
    system.publish("/map", message, qos=LATCHED)


def pose(x: float, y: float, theta: float = 0.0, frame: str = "map") -> PoseStamped:
    found = PoseStamped()
    found.header.frame_id = frame
    found.pose.position.x, found.pose.position.y = x, y
    found.pose.orientation.z, found.pose.orientation.w = math.sin(theta / 2), math.cos(theta / 2)
    return found


def send(system: System, goal: Any, name: str = "compute_path_to_pose") -> Any:
    """Send a goal, and return the handle of the client."""
    kind = ComputePathToPose if isinstance(goal, ComputePathToPose.Goal) else ComputePathThroughPoses
    client = ActionClient(system.node, kind, name)
    system.wait_until(client.server_is_ready)
    return system.result(client.send_goal_async(goal))


def outcome(system: System, goal: Any, name: str = "compute_path_to_pose") -> tuple[int, Any]:
    handle = send(system, goal, name)
    assert handle.accepted
    answer = system.result(handle.get_result_async())
    return answer.status, answer.result


def points(path: Path) -> np.ndarray:
    return np.array([(each.pose.position.x, each.pose.position.y) for each in path.poses])


def test_a_path_to_a_pose(system: System, tmp_path: File) -> None:
    started(system, tmp_path)
    heard: list[Path] = []
    system.node.create_subscription(Path, "/plan", heard.append, 1)
    system.run(0.1)
    status, result = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 3.0, 1.0)))
    assert (status, result.error_code, result.error_msg) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE, "")
    path = points(result.path)
    assert path[0] == pytest.approx((1.0, 1.0))
    assert path[-1] == pytest.approx((4.0, 3.0))
    assert result.path.poses[-1].pose.orientation.z == pytest.approx(math.sin(0.5))
    assert result.path.header.frame_id == result.path.poses[5].header.frame_id == "map"
    assert len(path) > 60
    system.run(0.1)
    assert len(heard[-1].poses) == len(path)
    system.expect_log("Created global planner plugin GridBased of type nav2_navfn_planner::NavfnPlanner")


def test_a_path_from_a_pose_in_another_frame(system: System, tmp_path: File) -> None:
    started(system, tmp_path)
    goal = ComputePathToPose.Goal(goal=pose(4.0, 3.0), start=pose(1.0, 2.0, frame="base_link"), use_start=True)
    _, result = outcome(system, goal)
    assert points(result.path)[0] == pytest.approx((2.0, 3.0))


def test_a_path_through_poses(system: System, tmp_path: File) -> None:
    started(system, tmp_path)
    goals = [pose(4.0, 1.0), pose(4.0, 3.0), pose(1.0, 3.0, 2.0)]
    goal = ComputePathThroughPoses.Goal(goals=goals, planner_id="GridBased")
    status, result = outcome(system, goal, "compute_path_through_poses")
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, 0)
    path = points(result.path)
    assert np.hypot(*np.diff(path, axis=0).T).sum() == pytest.approx(8.0, abs=0.1)
    assert np.hypot(*np.diff(path, axis=0).T).min() > 0.02  # nothing comes twice
    _, result = outcome(system, ComputePathThroughPoses.Goal(), "compute_path_through_poses")
    assert result.error_code == ComputePathThroughPoses.Result.NO_VIAPOINTS_GIVEN


@pytest.mark.parametrize(
    ("goal", "code", "words"),
    [
        ({"goal": pose(50.0, 1.0)}, Result.GOAL_OUTSIDE_MAP, "(50.00, 1.00) is outside of the map"),
        ({"goal": pose(4.99, 1.0)}, Result.NONE, ""),  # in a wall, but free cells are within the tolerance
        ({"goal": pose(4.0, 1.0), "planner_id": "Fast"}, Result.INVALID_PLANNER, "Planner names are: GridBased"),
        ({"goal": pose(4.0, 1.0, frame="moon")}, Result.TF_ERROR, "Unable to transform poses to global frame"),
        ({"goal": pose(math.nan, 1.0)}, Result.GOAL_OUTSIDE_MAP, "expected finite numbers"),
        (
            {"goal": pose(4.0, 1.0), "start": pose(0.0, 0.0), "use_start": True},
            Result.START_OCCUPIED,
            "the start (0.00, 0.00) is in an obstacle",
        ),
        (
            {"goal": pose(4.0, 1.0), "start": pose(-1.0, 0.0), "use_start": True},
            Result.START_OUTSIDE_MAP,
            "(-1.00, 0.00) is outside of the map of 100 x 80 cells",
        ),
    ],
)
def test_goals_without_a_path_have_codes(
    system: System, tmp_path: File, goal: dict[str, Any], code: int, words: str
) -> None:
    started(system, tmp_path)
    status, result = outcome(system, ComputePathToPose.Goal(**goal))
    assert result.error_code == code
    assert words in result.error_msg
    assert status == (GoalStatus.STATUS_ABORTED if code else GoalStatus.STATUS_SUCCEEDED)


def test_a_map_that_changes(system: System, tmp_path: File) -> None:
    started(system, tmp_path)
    cells = room()
    cells[:, 50] = 100
    publish_map(system, cells)
    system.run(1.5)
    status, result = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.NO_VALID_PATH)
    cells[60:75, 50] = 0  # a door opens
    publish_map(system, np.pad(cells, ((0, 20), (0, 40)), constant_values=-1))
    system.run(1.5)
    status, result = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert 3.2 < points(result.path)[:, 1].max() < 3.7


def test_a_costmap_that_is_not_current_is_waited_for(system: System, tmp_path: File) -> None:
    configured(system, tmp_path)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    place_robot(system, 1.0, 1.0)
    began = system.time
    status, result = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TIMEOUT)
    assert system.time - began == pytest.approx(1.0, abs=0.2)
    handle = send(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    publish_map(system, room())
    assert system.result(handle.get_result_async()).status == GoalStatus.STATUS_SUCCEEDED


def test_goals_that_wait_are_cancelled_and_preempted(system: System, tmp_path: File) -> None:
    configured(system, tmp_path, PARAMETERS.replace("20.0", "20.0\n    costmap_update_timeout: 10.0"))
    assert change(system, Transition.TRANSITION_ACTIVATE)
    place_robot(system, 1.0, 1.0)
    handle = send(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    system.run(0.5)
    system.result(handle.cancel_goal_async())
    assert system.result(handle.get_result_async()).status == GoalStatus.STATUS_CANCELED
    first = send(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    system.run(0.2)
    second = send(system, ComputePathToPose.Goal(goal=pose(4.0, 3.0)))
    publish_map(system, room())
    assert system.result(first.get_result_async()).status == GoalStatus.STATUS_ABORTED
    answer = system.result(second.get_result_async())
    assert answer.status == GoalStatus.STATUS_SUCCEEDED
    assert points(answer.result.path)[-1] == pytest.approx((4.0, 3.0))


def test_without_a_robot_there_is_no_path(system: System, tmp_path: File) -> None:
    configured(system, tmp_path)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    publish_map(system, room())
    status, result = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.TIMEOUT)
    system.expect_log("no transform from 'base_link' to 'map'")


def test_whether_a_path_is_valid(system: System, tmp_path: File) -> None:
    started(system, tmp_path)
    path = Path(poses=[pose(x, 1.0) for x in (0.0, 1.1, 2.0, 3.0, 4.0)])
    assert system.call(IsPathValid, "/is_path_valid", IsPathValid.Request(path=path)).is_valid
    cells = room()
    cells[20, 60] = 100
    publish_map(system, cells)
    system.run(1.5)
    answer = system.call(IsPathValid, "/is_path_valid", IsPathValid.Request(path=path))
    assert (answer.is_valid, list(answer.invalid_pose_indices)) == (False, [3])
    assert not system.call(IsPathValid, "/is_path_valid").is_valid
    path.poses[2].header.frame_id = "moon"
    assert not system.call(IsPathValid, "/is_path_valid", IsPathValid.Request(path=path)).is_valid


def test_plugins_by_their_names(system: System, tmp_path: File) -> None:
    smac = PARAMETERS.replace("nav2_navfn_planner/NavfnPlanner", "nav2_smac_planner::SmacPlanner2D")
    started(system, tmp_path, smac.replace("use_astar: false", "max_iterations: 1000"))
    status, _ = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert status == GoalStatus.STATUS_SUCCEEDED
    system.expect_log("parameters without effect in robolink: GridBased.max_iterations")
    assert system.parameter("/planner_server", "GridBased.cost_travel_multiplier") == 1.0


def test_an_unknown_plugin_is_refused_and_another_try_is_possible(system: System, tmp_path: File) -> None:
    file = tmp_path / "parameters.yaml"
    file.write_text(PARAMETERS.replace("navfn_planner/NavfnPlanner", "smac_planner::SmacPlannerHybrid"))
    system.start("nav2_planner planner_server", args=["--ros-args", "--params-file", str(file)])
    assert not change(system, Transition.TRANSITION_CONFIGURE)
    system.expect_log("expected nav2_navfn_planner::NavfnPlanner or nav2_smac_planner::SmacPlanner2D")
    system.set_parameter("/planner_server", "GridBased.plugin", "nav2_navfn_planner::NavfnPlanner")
    assert change(system, Transition.TRANSITION_CONFIGURE)


def test_transitions_are_those_of_the_costmap(system: System, tmp_path: File) -> None:
    started(system, tmp_path)

    def state() -> str:
        return str(system.call(GetState, "/global_costmap/global_costmap/get_state").current_state.label)

    assert state() == "active"
    assert change(system, Transition.TRANSITION_DEACTIVATE)
    assert state() == "inactive"
    assert not send(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0))).accepted
    assert change(system, Transition.TRANSITION_CLEANUP)
    assert state() == "unconfigured"
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert change(system, Transition.TRANSITION_ACTIVATE)
    system.run(1.5)
    status, _ = outcome(system, ComputePathToPose.Goal(goal=pose(4.0, 1.0)))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert system.nodes.count("/global_costmap/global_costmap") == 1


def test_a_container_loads_the_server_with_its_costmap(system: System) -> None:
    system.start("rclcpp_components component_container")
    request = LoadNode.Request(package_name="nav2_planner", plugin_name="nav2_planner::PlannerServer")
    answer = system.call(LoadNode, "/ComponentManager/_container/load_node", request)
    assert (answer.error_message, answer.full_node_name) == ("", "/planner_server")
    assert change(system, Transition.TRANSITION_CONFIGURE)
    assert system.parameter("/global_costmap/global_costmap", "resolution") == 0.1
    unload = UnloadNode.Request(unique_id=answer.unique_id)
    assert system.call(UnloadNode, "/ComponentManager/_container/unload_node", unload).success
    system.run(0.1)
    assert system.nodes == ["/ComponentManager"]
