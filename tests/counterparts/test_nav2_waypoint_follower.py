"""nav2_waypoint_follower: places one after the other, by an action navigate_to_pose that is faked here."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.action import ActionClient
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import FollowWaypoints, NavigateToPose
from robolink.node import Node
from robolink.testing import System

SUCCEEDED, CANCELED, ABORTED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED


class Navigator(Node):
    """A fake navigator: a goal takes a second; one with a negative x fails with code 206."""

    def __init__(self, **options: Any) -> None:
        super().__init__("bt_navigator", **options)
        self.visited: list[float] = []
        self.server = SimpleActionServer(self, NavigateToPose, "navigate_to_pose", self.execute)
        self.server.activate()
        self.group = ReentrantCallbackGroup()

    async def execute(self) -> None:
        goal, left = self.server.goal, 10
        while left > 0:
            await pause(self, 0.1, self.group)
            left -= 1
            if self.server.is_cancel_requested:
                return self.server.terminate_all()
            if self.server.is_preempt_requested:
                goal, left = self.server.accept_pending_goal(), 10
        x = goal.pose.pose.position.x
        if x < 0:
            return self.server.terminate_current(NavigateToPose.Result(error_code=206, error_msg="in a wall"))
        self.visited.append(x)
        return self.server.succeeded_current()


def poses(*places: float) -> list[PoseStamped]:
    found = []
    for x in places:
        made = PoseStamped()
        made.header.frame_id, made.pose.position.x, made.pose.orientation.w = "map", float(x), 1.0
        found.append(made)
    return found


class Scene:
    def __init__(self, system: System, *, has_navigator: bool = True, **parameters: Any) -> None:
        self.system = system
        self.navigator: Any = system.start(Navigator) if has_navigator else None
        given = {name.replace("__", "."): value for name, value in parameters.items()}
        system.start("nav2_waypoint_follower waypoint_follower", parameters=given)
        system.run(0.5)
        assert self.change(Transition.TRANSITION_CONFIGURE)
        assert self.change(Transition.TRANSITION_ACTIVATE)
        self.client = ActionClient(system.node, FollowWaypoints, "follow_waypoints")
        self.feedback: list[int] = []
        system.run(0.5)

    def change(self, transition: int) -> bool:
        request = ChangeState.Request(transition=Transition(id=transition))
        return bool(self.system.call(ChangeState, "/waypoint_follower/change_state", request).success)

    def send(self, *places: float, **fields: Any) -> Any:
        goal = FollowWaypoints.Goal(poses=poses(*places), **fields)

        def hear(message: Any) -> None:
            if self.feedback[-1:] != [message.feedback.current_waypoint]:
                self.feedback.append(message.feedback.current_waypoint)

        return self.system.result(self.client.send_goal_async(goal, hear))

    def end(self, goal: Any) -> Any:
        return self.system.result(goal.get_result_async())


def test_places_are_visited_in_order_with_feedback(system: System) -> None:
    scene = Scene(system)
    answer = scene.end(scene.send(1, 2, 3))
    assert (answer.status, answer.result.missed_waypoints) == (SUCCEEDED, [])
    assert (scene.navigator.visited, scene.feedback) == ([1, 2, 3], [0, 1, 2])
    system.expect_log("Completed all 3 waypoints requested.")


def test_loops_begin_again_at_the_first_and_a_goal_may_begin_later(system: System) -> None:
    scene = Scene(system)
    assert scene.end(scene.send(1, 2, number_of_loops=1, goal_index=1)).status == SUCCEEDED
    assert scene.navigator.visited == [2, 1, 2]


def test_it_waits_at_each_place(system: System) -> None:
    scene = Scene(system, wait_at_waypoint__waypoint_pause_duration=2000)
    scene.end(scene.send(1, 2))
    assert 6.5 < system.time < 8.5
    system.expect_log("Arrived at 0'th waypoint, sleeping for 2000 milliseconds")


def test_the_first_place_that_is_missed_is_the_end(system: System) -> None:
    scene = Scene(system)
    answer = scene.end(scene.send(1, -2, 3))
    assert (answer.status, answer.result.error_code) == (ABORTED, 603)
    assert "Failed to process waypoint 1" in answer.result.error_msg
    assert "in a wall" in answer.result.error_msg
    (missed,) = answer.result.missed_waypoints
    assert (missed.index, missed.error_code, missed.goal.pose.position.x) == (1, 206, -2)
    assert scene.navigator.visited == [1]


def test_places_that_are_missed_may_be_passed_over(system: System) -> None:
    scene = Scene(system, stop_on_failure=False)
    answer = scene.end(scene.send(-1, 2, -3))
    assert answer.status == SUCCEEDED
    assert [(each.index, each.error_code) for each in answer.result.missed_waypoints] == [(0, 206), (2, 206)]


@pytest.mark.parametrize(("places", "index"), [((), 0), ((1, 2), 2)])
def test_a_goal_without_a_place_is_refused(system: System, places: tuple[float, ...], index: int) -> None:
    scene = Scene(system)
    answer = scene.end(scene.send(*places, goal_index=index))
    assert (answer.status, answer.result.error_code) == (ABORTED, 602)
    assert f"no waypoint has the number {index}: the goal has {len(places)}" in answer.result.error_msg


def test_a_cancelled_goal_stops_the_robot(system: System) -> None:
    scene = Scene(system)
    goal = scene.send(1, 2)
    system.run(0.5)
    system.result(goal.cancel_goal_async())
    assert scene.end(goal).status == CANCELED
    system.run(5.0)
    assert scene.navigator.visited == []


def test_a_newer_goal_takes_over(system: System) -> None:
    scene = Scene(system)
    first = scene.send(1, 2)
    system.run(1.5)
    second = scene.send(7)
    assert scene.end(first).status == ABORTED
    assert scene.end(second).status == SUCCEEDED
    assert scene.navigator.visited == [1, 7]


def test_without_a_navigator_the_result_says_so(system: System) -> None:
    scene = Scene(system, has_navigator=False)
    answer = scene.end(scene.send(1))
    assert answer.status == ABORTED
    assert "nobody serves the action navigate_to_pose" in answer.result.error_msg
    assert answer.result.missed_waypoints[0].error_code == 600


def test_an_unknown_task_is_named(system: System) -> None:
    given = {"waypoint_task_executor_plugin": "photo", "photo.plugin": "nav2_waypoint_follower::PhotoAtWaypoint"}
    system.start("nav2_waypoint_follower waypoint_follower", parameters=given)
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert not system.call(ChangeState, "/waypoint_follower/change_state", request).success
    system.expect_log("photo.plugin is 'nav2_waypoint_follower::PhotoAtWaypoint', and robolink has")
