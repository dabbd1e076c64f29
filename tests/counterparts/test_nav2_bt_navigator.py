"""nav2_bt_navigator: from a goal to its end, by planner, controller and recoveries that are faked here."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_bt_navigator.decisions import RETRIES, Do, Event, Happened, State, decide
from robolink.counterparts.nav2_bt_navigator.progress import Speed, metres_left, passed, seconds_left
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped
from robolink.interfaces.lifecycle_msgs.msg import Transition
from robolink.interfaces.lifecycle_msgs.srv import ChangeState
from robolink.interfaces.nav2_msgs.action import (
    BackUp,
    ComputePathThroughPoses,
    ComputePathToPose,
    FollowPath,
    NavigateThroughPoses,
    NavigateToPose,
    Spin,
    Wait,
)
from robolink.interfaces.nav2_msgs.srv import ClearEntireCostmap
from robolink.interfaces.nav_msgs.msg import Path
from robolink.node import Node
from robolink.testing import System
from robolink.tf2 import TransformBroadcaster

SUCCEEDED, CANCELED, ABORTED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED
BEGUN, RENEWED, DUE = (Event(each) for each in (Happened.BEGUN, Happened.RENEWED, Happened.DUE))
NO_PATH, OCCUPIED = ComputePathToPose.Result.NO_VALID_PATH, ComputePathToPose.Result.GOAL_OCCUPIED
STUCK = FollowPath.Result.FAILED_TO_MAKE_PROGRESS


def ok(of: Do) -> Event:
    return Event(Happened.SUCCEEDED, of)


def failed(of: Do, code: int = 0, *, is_hopeless: bool = False) -> Event:
    return Event(Happened.FAILED, of, code, f"{of.value} failed", is_hopeless)


def played(*events: Event) -> tuple[State, list[list[Do]]]:
    state, steps = State(), []
    for each in events:
        state, step = decide(state, each)
        steps.append(step)
    return state, steps


def test_a_path_is_planned_again_while_it_is_followed() -> None:
    _, steps = played(BEGUN, ok(Do.PLAN), DUE, DUE, ok(Do.PLAN), ok(Do.FOLLOW))
    assert steps == [[Do.PLAN], [Do.FOLLOW], [Do.PLAN], [], [Do.FOLLOW], [Do.SUCCEED]]


def test_a_planner_that_fails_has_the_global_costmap_cleared_once() -> None:
    state, steps = played(BEGUN, failed(Do.PLAN, NO_PATH), ok(Do.CLEAR_GLOBAL), failed(Do.PLAN, NO_PATH))
    assert steps == [[Do.PLAN], [Do.CLEAR_GLOBAL], [Do.PLAN], [Do.CLEAR_BOTH]]
    assert state.recoveries == 3


def test_a_controller_that_fails_has_the_local_costmap_cleared_once() -> None:
    _, steps = played(BEGUN, ok(Do.PLAN), failed(Do.FOLLOW, STUCK), ok(Do.CLEAR_LOCAL), failed(Do.FOLLOW, STUCK))
    assert steps[2:] == [[Do.CLEAR_LOCAL], [Do.FOLLOW], [Do.CLEAR_BOTH]]


def test_recoveries_come_in_turn_and_are_six_at_most() -> None:
    state, steps = played(BEGUN)
    recoveries = []
    while steps[-1] != [Do.FAIL]:
        of = steps[-1][-1]
        if of not in (Do.PLAN, Do.CLEAR_GLOBAL):
            recoveries.append(of)
        event = failed(of, NO_PATH) if of is Do.PLAN else ok(of)
        state, step = decide(state, event)
        steps.append(step)
    assert recoveries == [Do.CLEAR_BOTH, Do.SPIN, Do.WAIT, Do.BACK_UP, Do.CLEAR_BOTH, Do.SPIN]
    assert (state.code, state.words) == (NO_PATH, "plan a path failed")


def test_a_recovery_that_fails_is_followed_by_the_next_and_four_of_them_by_the_end() -> None:
    begin = (BEGUN, ok(Do.PLAN), failed(Do.FOLLOW, STUCK), failed(Do.CLEAR_LOCAL))
    _, steps = played(*begin, failed(Do.CLEAR_BOTH), failed(Do.SPIN, 703), failed(Do.WAIT), failed(Do.BACK_UP, 714))
    assert steps[3:] == [[Do.CLEAR_BOTH], [Do.SPIN], [Do.WAIT], [Do.BACK_UP], [Do.FAIL]]
    state, steps = played(*begin, failed(Do.CLEAR_BOTH), ok(Do.SPIN))
    assert (steps[-1], state.turn) == ([Do.PLAN], 2)


@pytest.mark.parametrize(
    "event", [failed(Do.PLAN, OCCUPIED), failed(Do.PLAN, NO_PATH, is_hopeless=True), failed(Do.PLAN, 0)]
)
def test_what_no_recovery_mends_is_the_end(event: Event) -> None:
    state, steps = played(BEGUN, event)
    assert (steps[-1], state.code) == ([Do.FAIL], event.code)


def test_a_plan_that_fails_on_the_way_stops_the_robot() -> None:
    _, steps = played(BEGUN, ok(Do.PLAN), DUE, failed(Do.PLAN, OCCUPIED))
    assert steps[-1] == [Do.STOP, Do.FAIL]


def test_a_new_goal_takes_over_and_the_end_of_the_old_path_is_not_its_end() -> None:
    _, steps = played(BEGUN, ok(Do.PLAN), RENEWED, ok(Do.FOLLOW), ok(Do.PLAN), ok(Do.FOLLOW))
    assert steps[2:] == [[Do.PLAN], [], [Do.FOLLOW], [Do.SUCCEED]]


def test_a_new_goal_ends_a_recovery() -> None:
    state, steps = played(BEGUN, failed(Do.PLAN, NO_PATH), failed(Do.CLEAR_GLOBAL), RENEWED, ok(Do.CLEAR_BOTH))
    assert steps[-2:] == [[Do.HALT, Do.PLAN], []]
    assert (state.retries, state.recoveries) == (0, 0)


@given(st.lists(st.tuples(st.booleans(), st.sampled_from([0, NO_PATH, OCCUPIED, STUCK])), min_size=80, max_size=80))
def test_whatever_fails_a_goal_that_is_not_renewed_comes_to_an_end(luck: list[tuple[bool, int]]) -> None:
    state, open_, followed = State(), [BEGUN], 0
    for has_worked, code in luck:
        if not open_:
            return
        state, steps = decide(state, open_.pop(0))
        if Do.SUCCEED in steps or Do.FAIL in steps:
            return
        for each in steps:
            if each not in (Do.STOP, Do.HALT):
                works = has_worked and each is not Do.FOLLOW
                open_.append(ok(each) if works else failed(each, code))
                followed += each is Do.FOLLOW
    assert state.retries <= RETRIES
    raise AssertionError(f"no end after {len(luck)} events: {state}")


# Numbers of the feedback


def test_the_way_that_is_left_begins_at_the_nearest_place() -> None:
    path = np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)])
    assert [metres_left(path, *at) for at in [(-1, 0), (2, 0), (3, 5)]] == [7, 4, 0]
    assert metres_left(np.empty((0, 2)), 0, 0) == 0
    assert [seconds_left(*each) for each in [(2, 0.5), (2, 0.001), (0.05, 0.5)]] == [4, 0, 0]


def test_goals_on_the_way_are_passed_but_the_last_is_not() -> None:
    goals = [(0.0, 0.0), (5.0, 0.0), (5.2, 0.0)]
    assert [passed(goals, x, 0, 0.7) for x in (0.5, 1.0)] == [1, 0]
    assert passed(goals[1:], 5, 0, 0.7) == 1


def test_the_speed_is_that_of_the_last_second_even_if_time_goes_back() -> None:
    speed = Speed()
    assert [speed.at(each / 10, each * 0.05, 0) for each in range(31)][-1] == pytest.approx(0.5)
    assert speed.at(0.5, 0, 0) == 0


# The node, with servers that are faked


class Servers(Node):
    """Fake planner, controller and recoveries; `answers` has error codes by action, one for each goal."""

    def __init__(self, **options: Any) -> None:
        super().__init__("servers", **options)
        self.calls: list[str] = []
        self.answers: dict[str, list[int]] = {}
        self.goals: list[Any] = []
        self.drive, self.x, self.is_lost = 2.0, 0.0, False
        self.group = ReentrantCallbackGroup()
        for name, kind in {
            "compute_path_to_pose": ComputePathToPose,
            "compute_path_through_poses": ComputePathThroughPoses,
            "spin": Spin,
            "wait": Wait,
            "backup": BackUp,
        }.items():
            ActionServer(
                self,
                kind,
                name,
                self.execute(name, kind),
                goal_callback=lambda goal: GoalResponse.ACCEPT,
                cancel_callback=lambda goal: CancelResponse.ACCEPT,
            )
        self.controller = SimpleActionServer(self, FollowPath, "follow_path", self.follow)
        self.controller.activate()
        for name in ("global", "local"):
            service = f"{name}_costmap/clear_entirely_{name}_costmap"
            self.create_service(ClearEntireCostmap, service, self.on_clear(f"clear {name}"))
        self.broadcaster = TransformBroadcaster(self)
        self.create_timer(0.05, self.on_timer)

    def on_timer(self) -> None:
        if not self.is_lost:
            made = TransformStamped(child_frame_id="base_link")
            made.header.frame_id, made.header.stamp = "map", self.get_clock().now().to_msg()
            made.transform.translation.x = self.x
            self.broadcaster.sendTransform(made)

    def on_clear(self, name: str) -> Callable[[Any, Any], Any]:
        def clear(request: Any, response: Any) -> Any:
            self.calls.append(name)
            return response

        return clear

    def code(self, name: str) -> int:
        """Note a call, and return its error code; the last one of a list stays."""
        self.calls.append(name)
        codes = self.answers.get(name) or [0]
        return codes.pop(0) if len(codes) > 1 else codes[0]

    def execute(self, name: str, kind: Any) -> Callable[[ServerGoalHandle], Any]:
        async def run(handle: ServerGoalHandle) -> Any:
            code = self.code(name)
            self.goals.append(handle.request)
            await pause(self, 0.1, self.group)
            if code:
                handle.abort()
                return kind.Result(error_code=code, error_msg=f"{name} says {code}")
            handle.succeed()
            path = Path(poses=[pose(each) for each in np.arange(0.0, 1.01, 0.1)])
            return kind.Result(path=path) if name.startswith("compute") else kind.Result()

        return run

    async def follow(self) -> None:
        """Drive to x = 1 in `drive` seconds."""
        server, code = self.controller, self.code("follow_path")
        while self.x < 1.0:
            await pause(self, 0.1, self.group)
            if server.is_cancel_requested or code:
                words = f"follow_path says {code}"
                return server.terminate_all(FollowPath.Result(error_code=code, error_msg=words))
            if server.is_preempt_requested:
                server.accept_pending_goal()
                code = self.code("follow_path")
            self.x += 0.1 / self.drive
        return server.succeeded_current()


def pose(x: float, frame: str = "map", w: float = 1.0) -> PoseStamped:
    made = PoseStamped()
    made.header.frame_id, made.pose.position.x, made.pose.orientation.w = frame, float(x), w
    return made


class Scene:
    """The navigator among its fake servers, and a client."""

    def __init__(self, system: System, *, has_servers: bool = True) -> None:
        self.system = system
        self.servers: Any = system.start(Servers) if has_servers else None
        system.start("nav2_bt_navigator bt_navigator")
        system.run(0.5)
        for each in (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE):
            self.change(each)
        self.clients = {
            kind: ActionClient(system.node, kind, name)
            for kind, name in ((NavigateToPose, "navigate_to_pose"), (NavigateThroughPoses, "navigate_through_poses"))
        }
        self.feedback: list[Any] = []
        system.run(0.5)

    def change(self, transition: int) -> None:
        request = ChangeState.Request(transition=Transition(id=transition))
        assert self.system.call(ChangeState, "/bt_navigator/change_state", request).success

    def send(self, goal: Any = None) -> Any:
        goal = goal or NavigateToPose.Goal(pose=pose(1))
        client = next(each for kind, each in self.clients.items() if isinstance(goal, kind.Goal))
        return self.system.result(client.send_goal_async(goal, lambda each: self.feedback.append(each.feedback)))

    def end(self, goal: Any) -> tuple[int, int, str]:
        answer = self.system.result(goal.get_result_async())
        return answer.status, answer.result.error_code, answer.result.error_msg


@pytest.fixture
def scene(system: System) -> Scene:
    return Scene(system)


def test_a_goal_is_reached_with_feedback(scene: Scene) -> None:
    scene.servers.drive = 3.0
    assert scene.end(scene.send()) == (SUCCEEDED, 0, "")
    assert scene.servers.calls.count("compute_path_to_pose") == 3
    first, last = scene.feedback[2], scene.feedback[-1]
    assert 25 <= len(scene.feedback) <= 35
    assert first.distance_remaining == pytest.approx(1.0, abs=0.11)
    assert last.distance_remaining < 0.2
    assert last.current_pose.pose.position.x == pytest.approx(scene.servers.x, abs=0.1)
    assert last.navigation_time.sec == 3
    middle = scene.feedback[15]
    expected = middle.distance_remaining * 3.0
    assert middle.estimated_time_remaining.sec + middle.estimated_time_remaining.nanosec / 1e9 == pytest.approx(
        expected, rel=0.4
    )
    scene.system.expect_log("Begin navigating from current location (0.00, 0.00) to (1.00, 0.00)")
    scene.system.expect_log("Goal succeeded")


def test_goals_through_poses_are_passed_one_after_the_other(scene: Scene) -> None:
    scene.servers.drive = 5.0
    goal = NavigateThroughPoses.Goal(poses=[pose(0.8), pose(1.6), pose(2.0)])
    assert scene.end(scene.send(goal)) == (SUCCEEDED, 0, "")
    assert {each.number_of_poses_remaining for each in scene.feedback} == {1, 2, 3}
    planned = [each for each in scene.servers.goals if isinstance(each, ComputePathThroughPoses.Goal)]
    assert [len(each.goals) for each in planned] == [3, 2]


def test_recoveries_are_carried_out_until_one_helps(scene: Scene) -> None:
    scene.servers.answers = {"compute_path_to_pose": [NO_PATH, NO_PATH, NO_PATH, NO_PATH, 0]}
    assert scene.end(scene.send())[:2] == (SUCCEEDED, 0)
    plan = "compute_path_to_pose"
    begin = [plan, "clear global", plan, "clear local", "clear global", plan, "clear global", plan, "spin", plan]
    assert scene.servers.calls[: len(begin)] == begin
    assert scene.feedback[-1].number_of_recoveries == 5


def test_a_goal_in_a_wall_fails_at_once_with_the_planner_s_words(scene: Scene) -> None:
    scene.servers.answers = {"compute_path_to_pose": [OCCUPIED]}
    assert scene.end(scene.send()) == (ABORTED, OCCUPIED, f"compute_path_to_pose says {OCCUPIED}")
    assert scene.servers.calls == ["compute_path_to_pose"]


def test_a_robot_that_is_stuck_fails_after_six_recoveries(scene: Scene) -> None:
    scene.servers.answers = {"follow_path": [STUCK]}
    assert scene.end(scene.send()) == (ABORTED, STUCK, f"follow_path says {STUCK}")
    assert [scene.servers.calls.count(each) for each in ("spin", "wait", "backup")] == [2, 1, 1]


def test_a_cancelled_goal_stops_the_controller_first(scene: Scene) -> None:
    goal = scene.send()
    scene.system.run(0.5)
    scene.system.result(goal.cancel_goal_async())
    assert scene.end(goal)[0] == CANCELED
    x = scene.servers.x
    scene.system.run(1.0)
    assert scene.servers.x == x < 0.5


def test_a_newer_goal_takes_over(scene: Scene) -> None:
    first = scene.send()
    scene.system.run(0.5)
    second = scene.send(NavigateToPose.Goal(pose=pose(7)))
    assert scene.end(first)[0] == ABORTED
    assert scene.end(second)[0] == SUCCEEDED
    planned = [each.goal.pose.position.x for each in scene.servers.goals if isinstance(each, ComputePathToPose.Goal)]
    assert planned[:2] == [1, 7]
    assert set(planned[1:]) == {7}


def test_a_goal_that_nobody_filled_in_moves_nothing(scene: Scene) -> None:
    status, code, words = scene.end(scene.send(NavigateToPose.Goal()))
    assert (status, code) == (ABORTED, 9002)
    assert "frame_ids cannot be empty" in words
    assert not scene.servers.goals


def test_a_newer_goal_with_a_mistake_leaves_the_old_one(scene: Scene) -> None:
    first = scene.send()
    scene.system.run(0.5)
    second = scene.send(NavigateToPose.Goal(pose=pose(7, frame="moon")))
    status, code, words = scene.end(second)
    assert (status, code) == (ABORTED, 9002)
    assert "frame_id 'moon' to the global frame 'map'" in words
    assert scene.end(first)[0] == SUCCEEDED


@pytest.mark.parametrize(
    ("goal", "code", "words"),
    [
        (NavigateToPose.Goal(pose=pose(1, w=0.0)), 9000, "not a quaternion"),
        (NavigateToPose.Goal(pose=pose(math.nan)), 9000, "finite numbers"),
        (NavigateToPose.Goal(pose=pose(1), behavior_tree="/home/me/tree.xml"), 9001, "/home/me/tree.xml"),
        (NavigateThroughPoses.Goal(), 9000, "has no poses"),
    ],
)
def test_a_goal_with_a_mistake_says_so(scene: Scene, goal: Any, code: int, words: str) -> None:
    status, found, text = scene.end(scene.send(goal))
    assert (status, found) == (ABORTED, code)
    assert words in text
    assert scene.end(scene.send())[0] == SUCCEEDED


def test_the_names_of_nav2_s_own_trees_are_taken(scene: Scene) -> None:
    tree = "/opt/ros/jazzy/share/nav2_bt_navigator/behavior_trees/navigate_to_pose_w_replanning_and_recovery.xml"
    assert scene.end(scene.send(NavigateToPose.Goal(pose=pose(1), behavior_tree=tree)))[0] == SUCCEEDED


def test_two_navigators_do_not_drive_at_once(scene: Scene) -> None:
    first = scene.send()
    second = scene.send(NavigateThroughPoses.Goal(poses=[pose(1)]))
    assert scene.end(second)[0] == ABORTED
    assert scene.end(first)[0] == SUCCEEDED


def test_without_servers_a_goal_fails_and_says_what_is_missing(system: System) -> None:
    scene = Scene(system, has_servers=False)
    status, code, words = scene.end(scene.send())
    assert (status, code) == (ABORTED, 9002)
    assert "no transform from 'base_link' to 'map'" in words


def test_a_controller_that_goes_away_ends_the_goal(scene: Scene) -> None:
    goal = scene.send()
    scene.system.run(0.5)
    scene.system.stop("servers")
    status, _, words = scene.end(goal)
    assert status == ABORTED
    assert "went away" in words or "nobody serves" in words


def test_a_robot_that_is_lost_ends_the_goal(scene: Scene) -> None:
    scene.servers.drive = 60.0
    goal = scene.send()
    scene.system.run(0.5)
    scene.servers.is_lost = True
    status, code, words = scene.end(goal)
    assert (status, code) == (ABORTED, 9002)
    assert "the robot's pose has not been known for 5 s" in words
    assert scene.system.time < 12


def test_a_message_on_goal_pose_is_a_goal(scene: Scene) -> None:
    scene.system.publish("/goal_pose", pose(1))
    scene.system.expect_log("Goal succeeded")


def test_deactivation_stops_the_robot_and_a_new_activation_goes_on(scene: Scene) -> None:
    goal = scene.send()
    scene.system.run(0.5)
    scene.change(Transition.TRANSITION_DEACTIVATE)
    assert scene.end(goal)[0] == ABORTED
    x = scene.servers.x
    scene.system.run(1.0)
    assert scene.servers.x < x + 0.2
    assert not scene.send().accepted
    scene.change(Transition.TRANSITION_ACTIVATE)
    assert scene.end(scene.send())[0] == SUCCEEDED
    for each in (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP, Transition.TRANSITION_CONFIGURE):
        scene.change(each)


def test_a_custom_tree_in_a_file_of_parameters_is_told(system: System) -> None:
    system.start("nav2_bt_navigator bt_navigator", parameters={"default_nav_to_pose_bt_xml": "mine.xml", "odom": "o"})
    request = ChangeState.Request(transition=Transition(id=Transition.TRANSITION_CONFIGURE))
    assert system.call(ChangeState, "/bt_navigator/change_state", request).success
    system.expect_log("robolink has no behaviour trees")
    system.expect_log("parameters without effect in robolink: odom")
