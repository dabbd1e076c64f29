"""nav2_smoother: the corners of a path are rounded, as far as a costmap allows."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from robolink.action import ActionClient
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import SmoothPath
from robolink.interfaces.nav2_msgs.msg import Costmap
from robolink.interfaces.nav_msgs.msg import Path
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.testing import System

CORNER = [(x, 0.0) for x in np.arange(0.0, 2.0, 0.1)] + [(2.0, y) for y in np.arange(0.0, 2.01, 0.1)]


def path(points: list[tuple[float, float]], frame: str = "map") -> Path:
    made = Path()
    made.header.frame_id = frame
    for x, y in points:
        pose = PoseStamped()
        pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1.0
        made.poses.append(pose)
    return made


def costmap(blocked: tuple[slice, slice] | None = None) -> Costmap:
    cells = np.zeros((80, 80), np.uint8)
    if blocked is not None:
        cells[blocked] = 254
    made = Costmap(data=cells.ravel().tobytes())
    made.header.frame_id = "map"
    made.metadata.resolution, made.metadata.size_x, made.metadata.size_y = 0.05, 80, 80
    made.metadata.origin.position.x = made.metadata.origin.position.y = -1.0
    made.metadata.origin.orientation.w = 1.0
    return made


class Scene:
    def __init__(self, system: System, cells: Costmap | None, **parameters: Any) -> None:
        self.system = system
        if cells is not None:
            latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            system.publish("/global_costmap/costmap_raw", cells, latched)
        system.start("nav2_smoother smoother_server", parameters=parameters)
        for each in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
            request = ChangeState.Request(transition=Transition(id=each))
            assert system.call(ChangeState, "/smoother_server/change_state", request).success
        self.client = ActionClient(system.node, SmoothPath, "smooth_path")
        system.run(0.5)

    def smooth(self, given: Path, **fields: Any) -> tuple[int, Any]:
        handle = self.system.result(self.client.send_goal_async(SmoothPath.Goal(path=given, **fields)))
        answer = self.system.result(handle.get_result_async())
        return answer.status, answer.result


def nearest(found: Path, x: float, y: float) -> float:
    return min(math.dist((each.pose.position.x, each.pose.position.y), (x, y)) for each in found.poses)


def test_a_corner_is_rounded_and_the_ends_stay(system: System) -> None:
    status, result = Scene(system, costmap()).smooth(path(CORNER), check_for_collisions=True)
    assert (status, result.was_completed, len(result.path.poses)) == (GoalStatus.STATUS_SUCCEEDED, True, len(CORNER))
    assert nearest(result.path, 2.0, 0.0) > 0.05
    first, last = result.path.poses[0].pose, result.path.poses[-1].pose
    assert (first.position.x, first.position.y, last.position.x, last.position.y) == pytest.approx((0, 0, 2, 2))
    middle = result.path.poses[len(CORNER) // 2].pose.orientation
    assert 2 * math.atan2(middle.z, middle.w) == pytest.approx(math.pi / 4, abs=0.4)


def test_a_corner_round_something_stays_outside_of_it(system: System) -> None:
    cells = costmap((slice(22, 60), slice(20, 59)))  # what the path goes round: x 0 to 1.95, y 0.1 to 2
    _, result = Scene(system, cells).smooth(path(CORNER), check_for_collisions=True)
    places = [(each.pose.position.x, each.pose.position.y) for each in result.path.poses]
    assert all(x > 1.95 or y < 0.1 for x, y in places)
    assert nearest(result.path, 2.0, 0.0) < 0.11


def test_a_path_through_something_is_told(system: System) -> None:
    status, result = Scene(system, costmap((slice(15, 25), slice(30, 32)))).smooth(
        path(CORNER), check_for_collisions=True
    )
    assert (status, result.error_code) == (GoalStatus.STATUS_ABORTED, SmoothPath.Result.SMOOTHED_PATH_IN_COLLISION)


def test_without_a_costmap_it_says_so_and_smooths(system: System) -> None:
    status, result = Scene(system, None).smooth(path(CORNER))
    assert status == GoalStatus.STATUS_SUCCEEDED
    assert nearest(result.path, 2.0, 0.0) > 0.05
    system.expect_log("no costmap has come")


@pytest.mark.parametrize(
    ("given", "fields", "code"),
    [
        (path([]), {}, SmoothPath.Result.INVALID_PATH),
        (path([(0.0, 0.0), (math.nan, 0.0)]), {}, SmoothPath.Result.INVALID_PATH),
        (path(CORNER), {"smoother_id": "best"}, SmoothPath.Result.INVALID_SMOOTHER),
        (path(CORNER, "moon"), {}, SmoothPath.Result.FAILED_TO_SMOOTH_PATH),
    ],
)
def test_what_cannot_be_smoothed_has_its_code(system: System, given: Path, fields: Any, code: int) -> None:
    assert Scene(system, costmap()).smooth(given, **fields)[1].error_code == code


def test_an_unknown_plugin_is_named(system: System) -> None:
    system.start("nav2_smoother smoother_server", parameters={"simple_smoother.plugin": "mine::Smoother"})
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert not system.call(ChangeState, "/smoother_server/change_state", request).success
    system.expect_log("expected one of nav2_smoother::SimpleSmoother")
