"""nav2_behaviors: small drives in a simulated world, in virtual time, that end where something is in the way."""

from __future__ import annotations

import math
from pathlib import Path as File
from typing import Any

import numpy as np
import pytest

from robolink.action import ActionClient
from robolink.counterparts.nav2_behaviors.collisions import touches
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import Point, Point32, PolygonStamped, Twist
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import AssistedTeleop, BackUp, DriveOnHeading, Spin, Wait
from robolink.interfaces.nav2_msgs.msg import Costmap
from robolink.interfaces.std_msgs.msg import Empty
from robolink.navigation.footprint import circle, cover
from robolink.navigation.grid import Grid
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
WORLD = """
world: {name: hall, size: [6, 4]}
robots:
  - name: robot
    pose: [3, 2, 0.5]
    shape: {circle: 0.17}
"""


class Behaviors:
    """A robot at (3, 2, 0.5) in an empty hall, a behaviour server, and costs that the test publishes."""

    def __init__(self, system: System, folder: File, **parameters: Any) -> None:
        self.system, self.cells = system, np.zeros((80, 120), np.uint8)
        (folder / "hall.yaml").write_text(WORLD, encoding="utf-8")
        system.start("world", parameters={"world": str(folder / "hall.yaml")})
        system.start("nav2_behaviors behavior_server", parameters=parameters)
        assert self.change(Transition.TRANSITION_CONFIGURE)
        assert self.change(Transition.TRANSITION_ACTIVATE)
        system.run(0.5)
        self.feedback: list[Any] = []

    def change(self, transition: int) -> bool:
        request = ChangeState.Request(transition=Transition(id=transition))
        return bool(self.system.call(ChangeState, "/behavior_server/change_state", request).success)

    def publish(self) -> None:
        """Publish the costmap, whose cells of 5 cm cover the hall, and the footprint."""
        costmap = Costmap(data=self.cells.ravel())
        costmap.header.frame_id, costmap.header.stamp = "odom", self.system.node.get_clock().now().to_msg()
        costmap.metadata.resolution, costmap.metadata.size_y, costmap.metadata.size_x = 0.05, *self.cells.shape
        self.system.publish("/local_costmap/costmap_raw", costmap, qos=LATCHED)
        footprint = PolygonStamped(header=costmap.header)
        pose = self.system.robot().pose
        footprint.polygon.points = [Point32(x=x + pose.x, y=y + pose.y) for x, y in circle(0.17).tolist()]
        self.system.publish("/local_costmap/published_footprint", footprint, qos=1)

    def begin(self, name: str, kind: type[Any], **fields: Any) -> Any:
        client = ActionClient(self.system.node, kind, name)
        sent = client.send_goal_async(kind.Goal(**fields), lambda message: self.feedback.append(message.feedback))
        return self.system.result(sent)

    def run(self, name: str, kind: type[Any], **fields: Any) -> tuple[int, Any]:
        """Publish the costs and run a behaviour; return status and result."""
        self.publish()
        return self.end(self.begin(name, kind, **fields))

    def end(self, handle: Any) -> tuple[int, Any]:
        answer = self.system.result(handle.get_result_async())
        return answer.status, answer.result

    def stands(self) -> bool:
        self.system.run(0.6)
        return math.hypot(self.system.robot().twist.v, self.system.robot().twist.w) < 1e-3


def seconds(value: float) -> Duration:
    return Duration(sec=int(value), nanosec=int(value % 1 * 1e9))


@pytest.mark.parametrize("angle", [1.57, -1.57, 4.0])
def test_a_turn(system: System, tmp_path: File, angle: float) -> None:
    behaviors = Behaviors(system, tmp_path)
    status, result = behaviors.run("spin", Spin, target_yaw=angle)
    assert (status, result.error_code) == (GoalStatus.STATUS_SUCCEEDED, 0)
    turned = behaviors.feedback[-1].angular_distance_traveled
    assert abs(turned) == pytest.approx(abs(angle), abs=0.1)
    assert math.copysign(1, turned) == math.copysign(1, angle)
    assert behaviors.stands()
    assert math.remainder(system.robot().pose.theta - 0.5 - angle, math.tau) == pytest.approx(0.0, abs=0.12)
    assert result.total_elapsed_time.sec >= 1


def test_backing_up_and_driving_on(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    status, _ = behaviors.run("backup", BackUp, target=Point(x=0.4), speed=0.2)
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert behaviors.stands()
    pose = system.robot().pose
    assert (pose.x - 3, pose.y - 2) == pytest.approx((-0.4 * math.cos(0.5), -0.4 * math.sin(0.5)), abs=0.04)
    assert behaviors.feedback[-1].distance_traveled == pytest.approx(0.4, abs=0.05)
    status, _ = behaviors.run("drive_on_heading", DriveOnHeading, target=Point(x=0.4), speed=0.3)
    assert status == GoalStatus.STATUS_SUCCEEDED
    pose = system.robot().pose
    assert (pose.x, pose.y) == pytest.approx((3.0, 2.0), abs=0.06)


def test_obstacles_end_it(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    behaviors.cells[:, 50] = 254  # 0.5 m behind the robot
    status, result = behaviors.run("backup", BackUp, target=Point(x=1.0), speed=0.2)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, BackUp.Result.COLLISION_AHEAD)
    assert "Collision Ahead" in result.error_msg
    assert behaviors.stands()
    assert system.robot().pose.x > 2.5 + 0.17
    status, result = behaviors.run("drive_on_heading", DriveOnHeading, target=Point(x=0.3), speed=0.2)
    assert status == GoalStatus.STATUS_SUCCEEDED


def test_a_robot_in_an_obstacle_may_get_out_and_no_deeper_in(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    behaviors.cells[:, :58] = 254
    status, result = behaviors.run("backup", BackUp, target=Point(x=0.3), speed=0.2)
    assert result.error_code == BackUp.Result.COLLISION_AHEAD
    status, _ = behaviors.run("drive_on_heading", DriveOnHeading, target=Point(x=0.3), speed=0.2)
    assert status == GoalStatus.STATUS_SUCCEEDED


def test_nobody_drives_blind(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    status, result = behaviors.end(behaviors.begin("spin", Spin, target_yaw=1.0))
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Spin.Result.COLLISION_AHEAD)
    assert "no costmap has come on 'local_costmap/costmap_raw'" in result.error_msg
    behaviors.publish()
    system.run(6.0)
    _, result = behaviors.end(behaviors.begin("spin", Spin, target_yaw=1.0))
    assert "s old" in result.error_msg
    system.stop("world")
    system.run(1.0)
    status, result = behaviors.run("spin", Spin, target_yaw=1.0)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, Spin.Result.TF_ERROR)


@pytest.mark.parametrize(
    ("name", "kind", "fields", "code"),
    [
        ("drive_on_heading", DriveOnHeading, {"target": Point(x=1.0), "speed": -0.2}, 724),
        ("drive_on_heading", DriveOnHeading, {"target": Point(x=1.0, y=1.0), "speed": 0.2}, 724),
        ("drive_on_heading", DriveOnHeading, {"target": Point(x=math.nan), "speed": 0.2}, 724),
        ("backup", BackUp, {"target": Point(x=1.0, z=1.0), "speed": 0.2}, 713),
        ("backup", BackUp, {"target": Point(x=1.5), "speed": 0.1, "time_allowance": seconds(1.5)}, 711),
        ("spin", Spin, {"target_yaw": 6.0, "time_allowance": seconds(1.0)}, 701),
        ("spin", Spin, {"target_yaw": math.nan}, 700),
    ],
)
def test_error_codes(
    system: System, tmp_path: File, name: str, kind: type[Any], fields: dict[str, Any], code: int
) -> None:
    behaviors = Behaviors(system, tmp_path)
    status, result = behaviors.run(name, kind, **fields)
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, code)
    assert result.error_msg
    assert behaviors.stands()


def test_a_wait(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    before = system.node.get_clock().now()
    status, result = behaviors.run("wait", Wait, time=seconds(2.5))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert (system.node.get_clock().now() - before).nanoseconds / 1e9 == pytest.approx(2.5, abs=0.15)
    assert behaviors.feedback[0].time_left.sec == 2
    assert result.total_elapsed_time.sec == 2


def test_a_cancel_stops_the_robot(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    behaviors.publish()
    handle = behaviors.begin("spin", Spin, target_yaw=6.0)
    system.run(1.0)
    handle.cancel_goal_async()
    assert behaviors.end(handle)[0] == GoalStatus.STATUS_CANCELED
    assert behaviors.stands()
    handle = behaviors.begin("spin", Spin, target_yaw=6.0)
    system.run(1.0)
    assert behaviors.change(Transition.TRANSITION_DEACTIVATE)
    assert behaviors.end(handle)[0] == GoalStatus.STATUS_ABORTED
    assert behaviors.stands()


def test_a_second_goal_ends_the_first(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(system, tmp_path)
    behaviors.publish()
    first = behaviors.begin("spin", Spin, target_yaw=6.0)
    system.run(0.5)
    second = behaviors.begin("spin", Spin, target_yaw=0.5)
    assert behaviors.end(first)[0] == GoalStatus.STATUS_ABORTED
    assert behaviors.end(second)[0] == GoalStatus.STATUS_SUCCEEDED


def test_driving_by_hand_slows_down_before_an_obstacle(system: System, tmp_path: File) -> None:
    behaviors = Behaviors(
        system,
        tmp_path,
        behavior_plugins=["assisted_teleop"],
        **{"assisted_teleop.plugin": "nav2_behaviors/AssistedTeleop"},
    )
    behaviors.cells[:, 74:] = 254  # 0.7 m ahead
    behaviors.publish()
    commands = system.messages("/cmd_vel", Twist)
    handle = behaviors.begin("assisted_teleop", AssistedTeleop)
    twist = Twist()
    twist.linear.x = 0.4
    for _ in range(40):
        system.publish("/cmd_vel_teleop", twist)
        system.run(0.1)
    speeds = [each.linear.x for each in commands]
    assert max(speeds) == pytest.approx(0.4)
    assert sorted(speeds[5:], reverse=True) == speeds[5:]
    assert speeds[-1] < 0.1
    assert system.robot().pose.x < 3.7 - 0.17
    system.publish("/preempt_teleop", Empty())
    assert behaviors.end(handle)[0] == GoalStatus.STATUS_SUCCEEDED


def test_an_unknown_behaviour_is_refused(system: System, tmp_path: File) -> None:
    system.start(
        "nav2_behaviors behavior_server",
        parameters={"behavior_plugins": ["spin", "dance"], "dance.plugin": "nav2_behaviors::Spinn"},
    )
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert not system.call(ChangeState, "/behavior_server/change_state", request).success
    line = system.expect_log("dance.plugin: expected one of").message
    assert "did you mean 'nav2_behaviors::Spin'" in line


def test_points_on_obstacles_are_counted() -> None:
    cells = np.zeros((20, 20), np.uint8)
    cells[10, 14], cells[10, 15], cells[10, 16] = 254, 255, 253
    points = cover(circle(0.1), 0.03)
    poses = np.array([(0.5, 0.5, 0.0), (0.72, 0.52, 0.0), (0.95, 0.5, 0.0), (0.05, 0.5, 0.0)])
    none, both, edge, outside = touches(Grid(cells, 0.05), points, poses).tolist()
    assert none == 0
    assert both > 3
    assert outside > 3
    assert edge > 3
