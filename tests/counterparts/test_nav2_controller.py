"""nav2_controller: paths are followed in simulated worlds, in virtual time, and every end has its reason."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path as File
from typing import Any

import pytest

from robolink.action import ActionClient
from robolink.counterparts.nav2_controller.checkers import (
    GoalChecker,
    GoalOptions,
    PoseProgressOptions,
    PositionOptions,
    ProgressChecker,
    ProgressOptions,
    StoppedOptions,
)
from robolink.geometry.plane import Pose, Speeds
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped, Quaternion, Twist, TwistStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import FollowPath
from robolink.interfaces.nav2_msgs.msg import SpeedLimit
from robolink.interfaces.nav_msgs.msg import Path
from robolink.interfaces.sensor_msgs.msg import LaserScan
from robolink.testing import System

Result = FollowPath.Result

COSTMAP = """
/local_costmap/local_costmap:
  ros__parameters:
    update_frequency: 5.0
    global_frame: odom
    robot_base_frame: base_link
    rolling_window: true
    width: 3
    height: 3
    resolution: 0.05
    robot_radius: 0.17
    plugins: [obstacle_layer, inflation_layer]
    inflation_layer: {inflation_radius: 0.7, cost_scaling_factor: 3.0}
    obstacle_layer:
      observation_sources: scan
      scan: {topic: /scan, clearing: true, marking: true}
"""
ROBOT = """
robots:
  - name: robot
    pose: [1, 1.5, 0]
    shape: {circle: 0.17}
    sensors:
      - {lidar: scan, beams: 360, noise: 0.01}
"""
WALLS = "walls:\n  - {polyline: [[0, 0], [8, 0], [8, 3], [0, 3]], closed: true}\n"


class Drives:
    """A robot at (1, 1.5) in a room of 8 x 3 m, whose frame odom is the world's, and a controller server."""

    def __init__(self, system: System, folder: File, obstacles: Sequence[str] = (), **parameters: Any) -> None:
        self.system = system
        (folder / "costmap.yaml").write_text(COSTMAP, encoding="utf-8")
        things = "".join(f"  - {each}\n" for each in obstacles)
        text = "world: {name: hall, size: [8, 3]}\n" + WALLS + (f"obstacles:\n{things}" if things else "") + ROBOT
        (folder / "hall.yaml").write_text(text, encoding="utf-8")
        system.start("world", parameters={"world": str(folder / "hall.yaml")})
        system.start(
            "nav2_controller controller_server",
            parameters=parameters,
            args=["--ros-args", "--params-file", str(folder / "costmap.yaml")],
        )
        assert self.change(Transition.TRANSITION_CONFIGURE)
        assert self.change(Transition.TRANSITION_ACTIVATE)
        system.run(0.5)
        self.client = ActionClient(system.node, FollowPath, "follow_path")
        self.feedback: list[FollowPath.Feedback] = []
        self.commands = system.messages("/cmd_vel", TwistStamped if parameters.get("enable_stamped_cmd_vel") else Twist)

    def change(self, transition: int) -> bool:
        request = ChangeState.Request(transition=Transition(id=transition))
        return bool(self.system.call(ChangeState, "/controller_server/change_state", request).success)

    def begin(self, *corners: tuple[float, float], frame: str = "odom", **goal: str) -> Any:
        """Send a goal, a path through corners in metres, and return its handle."""
        request = FollowPath.Goal(path=path(*corners, frame=frame), **goal)
        sent = self.client.send_goal_async(request, lambda message: self.feedback.append(message.feedback))
        return self.system.result(sent)

    def follow(self, *corners: tuple[float, float], frame: str = "odom", **goal: str) -> tuple[int, Any]:
        """Drive along a path, and return status and result."""
        return self.end(self.begin(*corners, frame=frame, **goal))

    def end(self, handle: Any, within: float = 60.0) -> tuple[int, Any]:
        answer = self.system.result(handle.get_result_async(), within)
        return answer.status, answer.result

    def is_at(self, x: float, y: float, within: float = 0.3) -> bool:
        pose = self.system.robot().pose
        return math.hypot(pose.x - x, pose.y - y) < within


def path(*corners: tuple[float, float], frame: str = "odom", step: float = 0.1) -> Path:
    """A path through corners, whose poses look along it."""
    found = Path()
    found.header.frame_id = frame
    for (x1, y1), (x2, y2) in itertools.pairwise(corners):
        count, theta = max(1, round(math.dist((x1, y1), (x2, y2)) / step)), math.atan2(y2 - y1, x2 - x1)
        for index in range(count + 1):
            pose = PoseStamped()
            pose.pose.position.x = x1 + (x2 - x1) * index / count
            pose.pose.position.y = y1 + (y2 - y1) * index / count
            pose.pose.orientation = Quaternion(z=math.sin(theta / 2), w=math.cos(theta / 2))
            found.poses.append(pose)
    return found


PURSUIT = {"FollowPath.plugin": "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"}


@pytest.mark.parametrize("parameters", [{}, PURSUIT], ids=["mppi", "pursuit"])
def test_a_path_is_followed_to_its_end(system: System, tmp_path: File, parameters: dict[str, Any]) -> None:
    drives = Drives(system, tmp_path, **parameters)
    status, result = drives.follow((1.0, 1.5), (4.0, 1.5), (5.5, 2.3))
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, Result.NONE)
    assert drives.is_at(5.5, 2.3)
    assert system.robot().contacts == 0
    assert drives.commands[-1] == Twist()
    left = [each.distance_to_goal for each in drives.feedback]
    assert left[0] == pytest.approx(4.7, abs=0.1)
    assert all(later <= earlier + 1e-6 for earlier, later in itertools.pairwise(left))
    assert max(each.speed for each in drives.feedback) == pytest.approx(0.5, abs=0.02)
    assert len(drives.feedback) < 20 * 1.5 * 4.7 / 0.5
    system.expect_log("Reached the goal!")


STRAIGHT = ((1.0, 1.5), (7.0, 1.5))


@pytest.mark.slow
def test_people_who_cross_the_way_are_not_run_into(system: System, tmp_path: File) -> None:
    walks = [
        "{circle: 0.2, path: [[3, 0.4], [3, 2.6]], speed: 0.4}",
        "{circle: 0.2, path: [[5, 2.6], [5, 0.4]], speed: 0.3}",
    ]
    drives = Drives(system, tmp_path, walks)
    status, _ = drives.follow(*STRAIGHT)
    assert (status, system.robot().contacts) == (GoalStatus.STATUS_SUCCEEDED, 0)


@pytest.mark.slow
def test_a_gap_of_1_3_robot_widths_is_passed(system: System, tmp_path: File) -> None:
    half = 1.3 * 0.17
    walls = [
        f"{{box: [0.2, {1.5 - half}], pose: [4, {(1.5 - half) / 2}]}}",
        f"{{box: [0.2, {1.5 - half}], pose: [4, {3 - (1.5 - half) / 2}]}}",
    ]
    drives = Drives(system, tmp_path, walls)
    status, _ = drives.follow(*STRAIGHT)
    assert (status, system.robot().contacts) == (GoalStatus.STATUS_SUCCEEDED, 0)


@pytest.mark.parametrize("parameters", [{}, PURSUIT], ids=["mppi", "pursuit"])
def test_a_path_without_a_way_ends_with_a_reason(system: System, tmp_path: File, parameters: dict[str, Any]) -> None:
    drives = Drives(system, tmp_path, ["{box: [0.2, 2.9], pose: [4, 1.5]}"], **parameters)
    status, result = drives.follow(*STRAIGHT)
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_code in (Result.FAILED_TO_MAKE_PROGRESS, Result.NO_VALID_CONTROL)
    assert result.error_msg
    assert drives.commands[-1] == Twist()
    assert system.robot().contacts == 0


def test_a_new_path_takes_over_without_a_stop(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path)
    first = drives.begin(*STRAIGHT)
    system.run(4.0)
    drives.commands.clear()
    second = drives.begin((2.5, 1.5), (4.0, 1.5), (4.5, 2.2))
    assert drives.end(first)[0] == GoalStatus.STATUS_ABORTED
    system.run(1.0)
    assert min(each.linear.x for each in drives.commands) > 0.3
    assert drives.end(second)[0] == GoalStatus.STATUS_SUCCEEDED
    assert drives.is_at(4.5, 2.2)


def test_a_cancel_and_a_deactivation_stop_the_robot(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path)
    handle = drives.begin(*STRAIGHT)
    system.run(3.0)
    handle.cancel_goal_async()
    assert drives.end(handle)[0] == GoalStatus.STATUS_CANCELED
    assert drives.commands[-1] == Twist()
    handle = drives.begin(*STRAIGHT)
    system.run(2.0)
    assert drives.change(Transition.TRANSITION_DEACTIVATE)
    assert drives.end(handle)[0] == GoalStatus.STATUS_ABORTED
    system.run(0.1)
    assert drives.commands[-1] == Twist()


@pytest.mark.parametrize(
    ("fields", "code"),
    [
        ({"controller_id": "Fly"}, Result.INVALID_CONTROLLER),
        ({"goal_checker_id": "Fly"}, Result.UNKNOWN),
        ({"progress_checker_id": "Fly"}, Result.UNKNOWN),
        ({"frame": "moon"}, Result.TF_ERROR),
    ],
)
def test_goals_that_cannot_be_followed(system: System, tmp_path: File, fields: dict[str, str], code: int) -> None:
    drives = Drives(system, tmp_path)
    status, result = drives.follow(*STRAIGHT, **fields)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code)
    assert next(iter(fields.values())) in result.error_msg
    assert drives.is_at(1.0, 1.5)


@pytest.mark.parametrize("corners", [(), ((1.0, 1.5), (math.nan, 2.0))], ids=["empty", "nan"])
def test_paths_that_are_none(system: System, tmp_path: File, corners: tuple[tuple[float, float], ...]) -> None:
    drives = Drives(system, tmp_path)
    request = FollowPath.Goal(path=Path())
    for x, y in corners:
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y = x, y
        request.path.poses.append(pose)
    status, result = drives.end(system.result(drives.client.send_goal_async(request)))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Result.INVALID_PATH)


def test_nobody_drives_blind(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path)
    handle = drives.begin(*STRAIGHT)
    system.run(3.0)
    system.stop("world")
    status, result = drives.end(handle, within=5.0)
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_code in (Result.TF_ERROR, Result.CONTROLLER_TIMED_OUT)
    assert drives.commands[-1] == Twist()


def test_scans_that_say_nothing_harm_nobody(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path)
    handle = drives.begin((1.0, 1.5), (2.5, 1.5))
    for number, frame in enumerate(("", "odom", "base_link", "moon")):
        scan = LaserScan(angle_min=math.nan, angle_increment=math.inf, range_min=math.nan, ranges=[math.nan] * number)
        scan.header.frame_id, scan.header.stamp.sec = frame, (-5, 0, 2**31 - 1, 3)[number]
        system.publish("/scan", scan)
        system.run(0.3)
    assert drives.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


def test_speed_limits_and_stamped_commands(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path, enable_stamped_cmd_vel=True)
    system.publish("/speed_limit", SpeedLimit(percentage=True, speed_limit=40.0))
    system.publish("/speed_limit", SpeedLimit(speed_limit=math.nan))
    drives.begin(*STRAIGHT)
    system.run(4.0)
    assert max(each.twist.linear.x for each in drives.commands) == pytest.approx(0.2, abs=0.01)
    assert drives.commands[-1].header.frame_id == "base_link"
    system.publish("/speed_limit", SpeedLimit())
    system.run(2.0)
    assert drives.commands[-1].twist.linear.x > 0.25  # what a robot that stands may speed up to


def test_paths_are_published_while_somebody_listens(system: System, tmp_path: File) -> None:
    drives = Drives(system, tmp_path)
    plans: list[Path] = []
    parts: list[Path] = []
    system.node.create_subscription(Path, "/local_plan", plans.append, 10)
    system.node.create_subscription(Path, "/transformed_global_plan", parts.append, 10)
    drives.begin(*STRAIGHT)
    system.run(2.0)
    assert (plans[-1].header.frame_id, len(plans[-1].poses)) == ("odom", 28)
    assert parts[-1].poses[-1].pose.position.x - parts[-1].poses[0].pose.position.x == pytest.approx(1.7, abs=0.05)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"FollowPath.plugin": "nav2_mppi_controller::MPPI"}, "did you mean 'nav2_mppi_controller::MPPIController'"),
        ({"FollowPath.critics": ["CostCritic", "GoalCritik"]}, "did you mean 'GoalCritic'"),
        ({"FollowPath.model_dt": 0.01}, "FollowPath.model_dt: expected at least the period of control"),
        ({"goal_checker.plugin": "x"}, "goal_checker.plugin: expected one of"),
    ],
)
def test_parameters_that_cannot_work_are_named(system: System, parameters: dict[str, Any], words: str) -> None:
    system.start("nav2_controller controller_server", parameters=parameters)
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert not system.call(ChangeState, "/controller_server/change_state", request).success
    system.expect_log(words)


@pytest.mark.parametrize(
    "plugin", ["dwb_core::DWBLocalPlanner", "nav2_rotation_shim_controller/RotationShimController"]
)
def test_other_plugins_of_nav2_have_a_deputy(system: System, plugin: str) -> None:
    system.start("nav2_controller controller_server", parameters={"FollowPath.plugin": plugin})
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert system.call(ChangeState, "/controller_server/change_state", request).success
    system.expect_log("takes its place")


def test_checkers() -> None:
    checker = GoalChecker(StoppedOptions())
    goal, moving, still = Pose(1.0, 1.0, 0.0), Speeds(0.5, 0.0), Speeds(0.0, 0.0)
    assert not checker.is_reached(Pose(1.2, 1.2, 0.0), goal, still)
    assert not checker.is_reached(Pose(1.1, 1.1, 1.0), goal, still)
    assert checker.is_reached(Pose(1.5, 1.0, 0.1), goal, still)  # it was there, and turns
    assert not checker.is_reached(Pose(1.0, 1.0, 0.1), goal, moving)
    checker.reset()
    assert not checker.is_reached(Pose(1.5, 1.0, 0.1), goal, still)
    assert GoalChecker(PositionOptions()).is_reached(Pose(1.1, 1.0, 3.0), goal, moving)
    assert GoalChecker(GoalOptions(symmetric_yaw_tolerance=True)).is_reached(Pose(1.0, 1.0, 3.1), goal, moving)


def test_progress() -> None:
    simple, turning = ProgressChecker(ProgressOptions()), ProgressChecker(PoseProgressOptions())
    for checker in (simple, turning):
        assert checker.gets_on(Pose(0.0, 0.0, 0.0), 1.0)
        assert checker.gets_on(Pose(0.6, 0.0, 0.0), 9.0)
        assert checker.gets_on(Pose(0.6, 0.0, 0.6), 18.0)
    assert not simple.gets_on(Pose(0.7, 0.0, 0.6), 20.0)
    assert turning.gets_on(Pose(0.7, 0.0, 0.6), 20.0)
    assert not turning.gets_on(Pose(0.7, 0.0, 0.7), 29.0)
