"""Helps that Nav2's counterparts share: action servers with preemption, the robot's pose, parameters of a file."""

from __future__ import annotations

from typing import Any

import pytest

from robolink.action import ActionClient
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.counterparts.nav2_util.parameters import keep_unknown
from robolink.counterparts.nav2_util.robot_pose import in_frame, robot_pose
from robolink.counterparts.nav2_util.simple_action_server import SimpleActionServer
from robolink.counterparts.program import pause
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Duration
from robolink.interfaces.geometry_msgs.msg import PoseStamped, TransformStamped
from robolink.interfaces.nav2_msgs.action import Spin, Wait
from robolink.node import Node
from robolink.testing import System
from robolink.tf2 import Buffer, TransformException

SUCCEEDED, CANCELED, ABORTED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED


class Waiter(Node):
    """A node that waits; 7 s fail, and 1000 s are not acceptable."""

    def __init__(self, **options: Any) -> None:
        super().__init__("waiter", **options)
        self.changes, self.closed, self.looks = 0, 0, self.declare_parameter("looks", True).value
        self.server = SimpleActionServer(
            self, Wait, "wait", self.execute, is_acceptable=lambda goal: goal.time.sec < 1000, on_change=self.on_change
        )
        self.group = ReentrantCallbackGroup()

    def on_change(self) -> None:
        self.changes += 1

    async def execute(self) -> None:
        try:
            await self.wait()
        except GeneratorExit:
            self.closed += 1
            raise

    async def wait(self) -> None:
        left = float(self.server.goal.time.sec)
        while left > 0:
            await pause(self, 0.1, self.group)
            left -= 0.1
            if self.server.goal.time.sec == 7:
                raise RuntimeError("seven is too much")
            if self.looks and self.server.is_cancel_requested:
                return self.server.terminate_all(Wait.Result(total_elapsed_time=Duration(sec=1)))
            if self.looks and self.server.is_preempt_requested:
                left = float(self.server.accept_pending_goal().time.sec)
            self.server.publish_feedback(Wait.Feedback(time_left=Duration(sec=int(left))))
        return self.server.succeeded_current(Wait.Result(total_elapsed_time=self.server.goal.time))


class Goals:
    """A client of the action, and what became of its goals."""

    def __init__(self, system: System, **parameters: Any) -> None:
        self.system = system
        self.node: Waiter = system.start(Waiter, parameters=parameters)
        self.server = self.node.server
        self.client = ActionClient(system.node, Wait, "wait")
        self.server.activate()
        system.run(0.1)

    def send(self, seconds: int, feedback: Any = None) -> Any:
        goal = Wait.Goal(time=Duration(sec=seconds))
        return self.system.result(self.client.send_goal_async(goal, feedback_callback=feedback))

    def outcome(self, goal: Any) -> tuple[int, int]:
        answer = self.system.result(goal.get_result_async())
        return answer.status, answer.result.total_elapsed_time.sec


@pytest.fixture
def goals(system: System) -> Goals:
    return Goals(system)


def test_goals_succeed_one_after_the_other(goals: Goals) -> None:
    heard: list[Any] = []
    assert goals.outcome(goals.send(2, heard.append)) == (SUCCEEDED, 2)
    assert len(heard) == 20
    assert not goals.server.is_running
    assert goals.server.goal is None
    assert goals.outcome(goals.send(1)) == (SUCCEEDED, 1)


def test_a_newer_goal_takes_over_and_the_one_before_is_aborted(goals: Goals) -> None:
    first, second = goals.send(50), goals.send(3)
    assert goals.outcome(first) == (ABORTED, 0)
    assert goals.outcome(second) == (SUCCEEDED, 3)
    assert goals.system.time < 5


def test_only_one_goal_is_pending(system: System) -> None:
    goals = Goals(system, looks=False)
    first, second, third = (goals.send(each) for each in (2, 2, 1))
    assert goals.server.pending_goal.time.sec == 1
    assert goals.outcome(second) == (ABORTED, 0)
    assert goals.outcome(first) == (SUCCEEDED, 2)
    assert goals.outcome(third) == (SUCCEEDED, 1)
    assert goals.node.changes == 2


def test_a_goal_is_cancelled(goals: Goals) -> None:
    goal = goals.send(50)
    goals.system.result(goal.cancel_goal_async())
    assert goals.outcome(goal) == (CANCELED, 1)
    assert goals.node.changes == 1
    assert goals.outcome(goals.send(1)) == (SUCCEEDED, 1)


def test_an_execution_that_raises_aborts_its_goal(goals: Goals) -> None:
    goal = goals.send(7)
    answer = goals.system.result(goal.get_result_async())
    assert (answer.status, answer.result.error_msg) == (ABORTED, "RuntimeError: seven is too much")
    goals.system.expect_log("[wait] Action server failed:")
    assert goals.outcome(goals.send(1)) == (SUCCEEDED, 1)


def test_a_goal_that_is_not_acceptable_is_rejected(goals: Goals) -> None:
    assert not goals.send(1000).accepted


def test_deactivation_ends_what_runs(goals: Goals) -> None:
    first, second = goals.send(50), goals.send(60)
    goals.server.deactivate()
    assert goals.node.closed == 1
    assert [goals.outcome(each)[0] for each in (first, second)] == [ABORTED, ABORTED]
    assert not goals.send(1).accepted
    goals.system.expect_log("[wait] Action server is inactive. Rejecting the goal.")
    goals.server.activate()
    assert goals.outcome(goals.send(1)) == (SUCCEEDED, 1)


def test_an_execution_that_forgets_its_goal_aborts_it(system: System) -> None:
    async def forget() -> None:
        pass

    node = system.node
    server = SimpleActionServer(node, Spin, "spin", forget)
    server.activate()
    client = ActionClient(system.node, Spin, "spin")
    goal = system.result(client.send_goal_async(Spin.Goal()))
    assert system.result(goal.get_result_async()).status == ABORTED
    server.destroy()


def transform(parent: str, child: str, x: float, sec: int) -> TransformStamped:
    made = TransformStamped(child_frame_id=child)
    made.header.frame_id, made.header.stamp.sec = parent, sec
    made.transform.translation.x = x
    return made


def test_the_robot_s_pose_and_why_it_is_not_known(system: System) -> None:
    buffer, node = Buffer(), system.node
    with pytest.raises(TransformException, match="no transform from 'base_link' to 'map'"):
        robot_pose(buffer, node, "map", "base_link")
    system.run(10.0)
    buffer.set_transform(transform("map", "odom", 1.0, 8), "test")
    buffer.set_transform(transform("odom", "base_link", 2.0, 8), "test")
    pose = robot_pose(buffer, node, "map", "base_link")
    assert (pose.header.frame_id, pose.pose.position.x, pose.pose.orientation.w) == ("map", 3.0, 1.0)
    with pytest.raises(TransformException, match=r"is 3\.0 s old, and may be 0\.5 s old"):
        robot_pose(buffer, node, "map", "base_link", 0.5)


def test_a_pose_in_another_frame() -> None:
    buffer = Buffer()
    buffer.set_transform(transform("map", "odom", 1.0, 8), "test")
    pose = PoseStamped()
    with pytest.raises(TransformException, match="cannot be empty"):
        in_frame(buffer, pose, "map")
    pose.header.frame_id = "/map"
    assert in_frame(buffer, pose, "map") is pose
    pose.header.frame_id, pose.header.stamp.sec = "odom", 20  # later than any transform: the latest serves
    assert in_frame(buffer, pose, "map").pose.position.x == 1.0
    pose.header.frame_id = "moon"
    with pytest.raises(TransformException):
        in_frame(buffer, pose, "map")


class Configured(Node):
    def __init__(self, **options: Any) -> None:
        super().__init__("configured", **options)
        self.declare_parameter("speed", 0.5)
        self.unknown = keep_unknown(self, except_below=("later",))


def test_parameters_without_effect_are_kept_and_named_once(system: System) -> None:
    given = {"speed": 0.3, "sped": 0.4, "FollowPath.critics": ["a", "b"], "later.x": 1}
    node = system.start(Configured, parameters=given)
    assert node.unknown == ["FollowPath.critics", "sped"]
    assert list(node.get_parameter("FollowPath.critics").value) == ["a", "b"]
    system.expect_log("parameters without effect in robolink: FollowPath.critics, sped")
    assert len([each for each in system.logs if "without effect" in each.message]) == 1


def test_a_pause_until_a_moment_that_is_over_ends_at_once(system: System) -> None:
    paused: list[bool] = []

    async def wait(node: Node) -> None:
        await pause(node, -7.6e-06, ReentrantCallbackGroup())
        paused.append(True)

    assert system.node.executor is not None
    system.node.executor.create_task(wait(system.node))
    system.run(0.1)
    assert paused


def test_the_end_of_the_context_closes_what_runs(capfd: pytest.CaptureFixture[str]) -> None:
    with System(seed=1) as system:
        goals = Goals(system)
        goals.send(50)
        system.run(1.0)
    assert goals.node.closed == 1
    assert "Traceback" not in capfd.readouterr().err
