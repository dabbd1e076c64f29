"""The node goto: its action from the first goal to the last, in a simulated room."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from robolink import Parameter
from robolink.action import ActionClient
from robolink.action.client import GoalStatus
from robolink.control.approach import Limits
from robolink.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from robolink.interfaces.nav2_msgs.action import FollowPath, NavigateToPose
from robolink.interfaces.nav_msgs.msg import Odometry
from robolink.interfaces.tf2_msgs.msg import TFMessage
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System
from tests.support.nodefiles import load_node_file
from tests.support.systems import PATIENCE, add_world, said

goto = load_node_file("goto")
Codes = FollowPath.Result


def message(**fields: float) -> Any:
    goal = PoseStamped()
    for name, value in fields.items():
        part = goal.pose.position if name in "xyz" else goal.pose.orientation
        setattr(part, name[-1], value)
    return goal


FAULTS = {
    "expected finite numbers": [{"x": math.nan}, {"y": math.inf}, {"qz": math.nan}, {"x": -1e9}],
    "not a quaternion": [{"qw": 0.0}],
}


@pytest.mark.parametrize(("words", "fields"), [(words, each) for words, some in FAULTS.items() for each in some])
def test_nonsense_is_no_goal(system: System, words: str, fields: dict[str, float]) -> None:
    assert words in goto.fault(message(**fields).pose)


# The node


class Client:
    """Somebody who sends goals, and keeps the feedback."""

    def __init__(self, system: System) -> None:
        self.system, self.feedback = system, list[NavigateToPose.Feedback]()
        self.client = ActionClient(system.node, NavigateToPose, "navigate_to_pose")

    def send(self, goal: PoseStamped) -> Any:
        """Give the goal's handle, accepted or not."""
        future = self.client.send_goal_async(
            NavigateToPose.Goal(pose=goal), lambda told: self.feedback.append(told.feedback)
        )
        return self.system.result(future, PATIENCE)

    def end(self, handle: Any) -> tuple[int, NavigateToPose.Result]:
        """Wait for the end of a goal: its status and its result."""
        ended = self.system.result(handle.get_result_async(), PATIENCE)
        return ended.status, ended.result


@pytest.fixture
def room(system: System) -> System:
    """An empty room of 6 by 6 metres, a robot in its middle."""
    add_world(system, "empty_room")
    return system


def is_at(system: System, x: float, y: float, theta: float) -> bool:
    pose = system.robot().pose
    return math.hypot(pose.x - x, pose.y - y) < 0.05 and abs(math.remainder(pose.theta - theta, math.tau)) < 0.1


@pytest.mark.slow
def test_goals_are_reached_one_after_the_other_with_feedback(room: System) -> None:
    room.start(goto.Goto)
    client = Client(room)
    for x, y, theta in ((4.5, 4.0, 1.5), (4.5, 4.0, -1.5), (2.0, 3.0, 3.1)):
        handle = client.send(message(x=x, y=y, qz=math.sin(theta / 2), qw=math.cos(theta / 2)))
        assert client.end(handle) == (GoalStatus.STATUS_SUCCEEDED, NavigateToPose.Result())
        room.run(0.5)
        assert is_at(room, x, y, theta)
        assert abs(room.robot().twist.v) + abs(room.robot().twist.w) < 1e-6
    first, last = client.feedback[0], client.feedback[-1]
    assert first.distance_remaining == pytest.approx(math.hypot(1.5, 1.0), abs=0.05)
    assert first.current_pose.header.frame_id == "odom"
    assert last.distance_remaining < 0.1
    assert last.navigation_time.sec >= 5
    assert first.estimated_time_remaining.sec > last.estimated_time_remaining.sec
    assert said(room, "reached the goal") == 3


def test_a_cancelled_goal_stops_the_robot(room: System) -> None:
    room.start(goto.Goto)
    client = Client(room)
    handle = client.send(message(x=5.0, y=3.0))
    room.run(3.0)
    assert room.robot().twist.v > 0.3
    assert room.result(handle.cancel_goal_async(), PATIENCE).goals_canceling
    assert client.end(handle)[0] == GoalStatus.STATUS_CANCELED
    room.run(1.0)
    assert room.robot().twist.v == pytest.approx(0.0, abs=1e-6)
    assert room.robot().pose.x < 4.5


def test_who_ends_it_on_the_way_stops_the_robot_and_its_goal(room: System) -> None:
    node = room.start(goto.Goto)
    client = Client(room)
    handle = client.send(message(x=5.0, y=3.0))
    room.run(3.0)
    assert room.robot().twist.v > 0.3
    heard = room.messages("cmd_vel")
    room.stop(node)
    node.destroy_node()
    room.run(0.2)
    assert heard == [Twist()]
    ended = handle.get_result_async()
    room.run(5.0)
    assert "the server went away" in str(ended.exception())


def test_a_new_goal_replaces_the_one_before_without_a_stop(room: System) -> None:
    room.start(goto.Goto)
    client = Client(room)
    first = client.send(message(x=5.0, y=3.0))
    room.run(3.0)
    commands = room.messages("cmd_vel")
    second = client.send(message(x=5.4, y=3.1))
    status, result = client.end(first)
    assert (status, result.error_msg) == (GoalStatus.STATUS_ABORTED, "replaced by another goal")
    room.run(0.5)
    assert min(each.linear.x for each in commands) > 0.2
    assert client.end(second)[0] == GoalStatus.STATUS_SUCCEEDED
    assert is_at(room, 5.4, 3.1, 0.0)


@pytest.mark.parametrize("fields", [{"x": math.nan}, {"qw": 0.0}])
def test_a_refused_goal_says_why_and_leaves_the_present_one_alone(room: System, fields: dict[str, float]) -> None:
    room.start(goto.Goto)
    client = Client(room)
    handle = client.send(message(x=4.0, y=3.0))
    assert not client.send(message(**fields)).accepted
    assert said(room, "refused a goal: ") == 1
    assert client.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


@pytest.mark.slow
def test_rviz_sends_goals_by_a_topic(room: System) -> None:
    room.start(goto.Goto)
    publisher = room.node.create_publisher(PoseStamped, "goal_pose", 10)
    publisher.publish(message(x=math.inf))
    publisher.publish(message(x=4.0, y=3.0))
    room.run(10.0)
    assert (said(room, "refused a goal"), said(room, "reached the goal")) == (1, 1)
    assert is_at(room, 4.0, 3.0, 0.0)


@pytest.mark.slow
def test_a_goal_of_another_frame_needs_a_transform(room: System) -> None:
    room.start(goto.Goto)
    client = Client(room)
    goal = message(x=1.0, y=0.0)
    goal.header.frame_id = "site"
    room.run(0.1)
    assert not client.send(goal).accepted
    assert said(room, "refused a goal: its frame 'site' is not known here") == 1
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    transform = TransformStamped(child_frame_id="site")  # it begins at (5, 4) in the room, turned by 90 degrees
    transform.header.frame_id = "odom"
    place, turn = transform.transform.translation, transform.transform.rotation
    place.x, place.y, turn.z, turn.w = 5.0, 4.0, math.sqrt(0.5), math.sqrt(0.5)
    room.node.create_publisher(TFMessage, "/tf_static", latched).publish(TFMessage(transforms=[transform]))
    room.run(0.1)
    handle = client.send(goal)
    assert handle.accepted
    assert client.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED
    assert is_at(room, 5.0, 5.0, math.pi / 2)


@pytest.mark.slow
@pytest.mark.parametrize("frame", ["base_link", "/base_link"])
def test_a_goal_in_a_frame_of_the_robot_does_not_move_along_with_it(room: System, frame: str) -> None:
    room.start(goto.Goto)
    client = Client(room)
    goal = message(x=1.0, y=1.0)
    goal.header.frame_id = frame
    room.run(0.1)
    handle = client.send(goal)
    assert handle.accepted
    assert client.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED
    assert is_at(room, 4.0, 4.0, 0.0)


def test_without_odometry_it_gives_up(room: System) -> None:
    node = room.start(goto.Goto, parameters={"odom_timeout": 2.0})
    client = Client(room)
    handle = client.send(message(x=5.0, y=3.0))
    room.run(3.0)
    room.stop("world")
    status, result = client.end(handle)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Codes.TF_ERROR)
    assert result.error_msg.startswith("no odometry on /odom for 2.")
    handle = client.send(message(x=5.0, y=3.0))
    lost = room.node.create_publisher(Odometry, "odom", 10)
    for x in (math.nan, math.inf, 1e300):
        odometry = Odometry()
        odometry.pose.pose.position.x = x
        lost.publish(odometry)
    assert client.end(handle)[1].error_code == Codes.TF_ERROR
    assert node.trip is None


def test_odometry_may_bear_any_stamp(room: System) -> None:
    node = room.start(goto.Goto)
    client = Client(room)
    client.send(message(x=5.0, y=3.0))
    odom = room.node.create_publisher(Odometry, "odom", 10)
    for sec in (-5, 2**31 - 1, 0, -(2**31)):
        odometry = Odometry()
        odometry.header.stamp.sec = sec
        odometry.pose.pose.position.x = -1e6
        odom.publish(odometry)
        room.run(0.02)
        assert 0.0 <= node.speeds.v <= Limits().speed


WALL = """
world: {name: wall, size: [6, 6]}
obstacles: [{circle: 0.2, pose: [4.5, 3]}]
robots: [{name: robot, pose: [3, 3, 0], sensors: [{lidar: scan}]}]
"""


@pytest.mark.slow
def test_it_waits_before_an_obstacle_then_gives_up(system: System, tmp_path: Path) -> None:
    path = tmp_path / "wall.yaml"
    path.write_text(WALL)
    add_world(system, path)
    node = system.start(goto.Goto, parameters={"progress_timeout": 3.0, "detours": False})
    client = Client(system)
    status, result = client.end(client.send(message(x=5.5, y=3.0)))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Codes.FAILED_TO_MAKE_PROGRESS)
    assert result.error_msg.endswith("from the goal: something is in the way")
    assert system.robot().contacts == 0
    assert 3.85 < system.robot().pose.x < 4.0
    node.set_parameters([Parameter("obstacle_stop", value=False)])
    status, result = client.end(client.send(message(x=5.5, y=3.0)))
    assert result.error_msg.endswith("from the goal: the robot does not move")
    assert system.robot().contacts > 0


@pytest.mark.slow
def test_what_is_beyond_the_goal_is_not_in_the_way(room: System) -> None:
    room.start(goto.Goto)
    client = Client(room)
    assert client.end(client.send(message(x=5.7, y=3.0)))[0] == GoalStatus.STATUS_SUCCEEDED
    assert room.robot().contacts == 0


def test_the_speed_can_be_changed_on_the_way_and_has_a_range(room: System) -> None:
    node = room.start(goto.Goto)
    client = Client(room)
    client.send(message(x=5.0, y=3.0))
    room.run(2.0)
    assert not node.set_parameters([Parameter("speed", value=-1.0)])[0].successful
    assert node.set_parameters([Parameter("speed", value=0.1)])[0].successful
    room.run(1.0)
    assert room.robot().twist.v == pytest.approx(0.1)
    assert all(each.description for each in node.describe_parameters(list(goto.PARAMETERS)))


BOX = """
walls:
  - {polyline: [[0, 0], [8, 0], [8, 6], [0, 6]], closed: true}
obstacles:
  - {box: [0.6, 2.0], pose: [4, 3]}
robots:
  - {name: robot, pose: [1.5, 3, 0], sensors: [{lidar: scan, noise: 0.01}]}
"""


@pytest.mark.slow
@pytest.mark.annex("nav2")
def test_it_drives_round_what_the_scanner_sees(system: System, tmp_path: Path) -> None:
    path = tmp_path / "box.yaml"
    path.write_text(BOX)
    add_world(system, path)
    system.start(goto.Goto)
    client = Client(system)
    status, _ = client.end(client.send(message(x=6.5, y=3.0)))
    assert (status, system.robot().contacts) == (GoalStatus.STATUS_SUCCEEDED, 0)
    assert is_at(system, 6.5, 3.0, 0.0)


@pytest.mark.slow
def test_without_detours_it_waits_as_before(system: System, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "box.yaml"
    path.write_text(BOX)
    add_world(system, path)
    monkeypatch.setattr(goto, "DETOURS", "robolink.nowhere:Detours")
    system.start(goto.Goto, parameters={"progress_timeout": 3.0})
    client = Client(system)
    status, result = client.end(client.send(message(x=6.5, y=3.0)))
    assert status == GoalStatus.STATUS_ABORTED
    assert result.error_msg.endswith("something is in the way")
    assert any("robolink.navigation, which plans, is not installed" in each.message for each in system.logs)
