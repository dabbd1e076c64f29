"""nav2_controller: paths are followed in simulated worlds, in virtual time, and every end has its reason."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from pathlib import Path as File
from typing import Any

import pytest

from robolink.action import ActionClient
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped, Quaternion, Twist, TwistStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import FollowPath
from robolink.interfaces.nav_msgs.msg import Path
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

    def follow(self, *corners: tuple[float, float], within: float = 60.0, **goal: str) -> tuple[int, Any]:
        """Drive along a path, and return status and result."""
        return self.end(self.begin(*corners, **goal), within)

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
