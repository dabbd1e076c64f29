"""The ways that a goal can go: it succeeds, fails, is rejected or cancelled."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from robolink import Future, Node, Time
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.server import RCLError, ServerGoalHandle
from robolink.executors import SingleThreadedExecutor
from robolink.impl.log_output import Record
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.goals import ABORTED, CANCELED, SUCCEEDED, Waiting, accept, accepted, numbered
from tests.support.spins import done, spin_for

# --- The ways that a goal can go ------------------------------------------------------------------------------------


def test_a_goal_is_executed_with_feedback_on_the_way(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    heard: list[list[int]] = []
    handle = accepted(executor, client, 4, feedback_callback=lambda each: heard.append(list(each.feedback.sequence)))
    answer = done(executor, handle.get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (SUCCEEDED, [0, 1, 1, 2, 3])
    assert heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]
    assert handle.status == SUCCEEDED


def test_feedback_of_other_clients_goals_is_left_out(
    executor: SingleThreadedExecutor, node: Node, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve()
    other = ActionClient(node, Fibonacci, "fibonacci", enable_feedback_msg_optimization=True)
    heard: list[int] = []
    theirs = accepted(executor, client, 4)
    handle = accepted(executor, other, 2, feedback_callback=lambda each: heard.append(len(each.feedback.sequence)))
    done(executor, handle.get_result_async())
    done(executor, theirs.get_result_async())
    assert heard == [3]


def test_a_result_may_be_asked_for_before_and_after_the_end(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    handle = accepted(executor, client, 7)
    early, late = handle.get_result_async(), handle.get_result_async()
    spin_for(executor, 60.0)
    assert not early.done()
    assert handle.status == GoalStatus.STATUS_EXECUTING
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    assert [list(done(executor, each).result.sequence) for each in (early, late)] == [[7], [7]]
    assert list(done(executor, handle.get_result_async()).result.sequence) == [7]


def test_a_goal_can_be_rejected(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve(goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 10 else GoalResponse.REJECT)
    handle = done(executor, client.send_goal_async(Fibonacci.Goal(order=10)))
    assert (handle.accepted, handle.status) == (False, GoalStatus.STATUS_UNKNOWN)
    assert accepted(executor, client, 9).accepted


def test_a_goal_callback_that_answers_nonsense_rejects(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    serve(goal_callback=lambda _: True)
    assert not done(executor, client.send_goal_async(Fibonacci.Goal())).accepted
    assert "goal callback returned True, which is not a GoalResponse" in log_lines[-1].message


def test_callbacks_may_be_coroutines(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], node: Node
) -> None:
    async def a_while(answer: Any = None) -> Any:
        ticked: Future[None] = Future()
        timer = node.create_timer(1.0, lambda: ticked.set_result(None))
        await ticked
        node.destroy_timer(timer)
        return answer

    async def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        while not handle.is_cancel_requested:
            await a_while()
        handle.canceled()
        return Fibonacci.Result(sequence=[5])

    async def hand_over(handle: ServerGoalHandle) -> None:
        await a_while()
        handle.execute()

    serve(
        execute,
        goal_callback=lambda _: a_while(GoalResponse.ACCEPT),
        handle_accepted_callback=hand_over,
        cancel_callback=lambda _: a_while(CancelResponse.ACCEPT),
    )
    handle = accepted(executor, client)
    assert node.context.time.now() == 10**9
    spin_for(executor, 5.0)
    assert len(done(executor, handle.cancel_goal_async()).goals_canceling) == 1
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_goal_that_is_handed_over_is_executed_when_that_is_asked_for(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 3)
    spin_for(executor, 1.0)
    assert (kept[0].status, handle.status) == (GoalStatus.STATUS_ACCEPTED, GoalStatus.STATUS_ACCEPTED)

    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        handle.succeed()
        return Fibonacci.Result(sequence=[8])

    kept[0].execute(execute)
    assert list(done(executor, handle.get_result_async()).result.sequence) == [8]
    with pytest.raises(RCLError, match="once only"):
        kept[0].execute()


def test_execution_waits_for_an_executor(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], server_node: Node
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 3)
    executor.remove_node(server_node)
    kept[0].execute()
    assert kept[0].status == GoalStatus.STATUS_EXECUTING
    executor.add_node(server_node)
    assert done(executor, handle.get_result_async()).status == SUCCEEDED


def test_a_callback_that_raises_aborts_the_goal_and_nothing_else(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    def execute(handle: ServerGoalHandle) -> Fibonacci.Result:
        raise ZeroDivisionError("no wheels")

    serve(execute)
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (ABORTED, [])
    told = [each.message for each in log_lines]
    assert any("ZeroDivisionError: no wheels" in each and "Traceback" in each for each in told)
    assert any("aborted" in each for each in told)
    assert done(executor, accepted(executor, client).get_result_async()).status == ABORTED


def test_a_callback_that_forgets_to_say_how_it_ended_aborts(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    serve(lambda _: Fibonacci.Result(sequence=[1, 2]))
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (ABORTED, [1, 2])


@pytest.mark.parametrize("wrong", [None, Fibonacci.Feedback(), "done"])
def test_a_callback_that_returns_no_result_is_told_of(
    wrong: object,
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    log_lines: list[Record],
) -> None:
    def execute(handle: ServerGoalHandle) -> Any:
        handle.succeed()
        return wrong

    serve(execute)
    answer = done(executor, accepted(executor, client).get_result_async())
    assert (answer.status, list(answer.result.sequence)) == (SUCCEEDED, [])
    assert "returned no result: expected Fibonacci_Result, got" in log_lines[-1].message


def test_what_cannot_happen_to_a_goal_is_refused(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(waiting, handle_accepted_callback=kept.append)
    handle = accepted(executor, client)
    for event in (ServerGoalHandle.succeed, ServerGoalHandle.abort, ServerGoalHandle.canceled):
        with pytest.raises(RCLError, match="a goal that is ACCEPTED cannot"):
            event(kept[0])
    kept[0].execute()
    spin_for(executor, 1.0)
    with pytest.raises(RuntimeError, match="EXECUTING cannot CANCELED; possible: CANCEL_GOAL, SUCCEED, ABORT"):
        kept[0].canceled()
    waiting.futures[0].set_result(ServerGoalHandle.succeed)
    done(executor, handle.get_result_async())
    with pytest.raises(RCLError, match="SUCCEEDED cannot ABORT; possible: nothing any more"):
        kept[0].abort()


# --- Cancelling -----------------------------------------------------------------------------------------------------


def test_a_goal_is_cancelled(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting, cancel_callback=accept)
    handle = accepted(executor, client)
    answer = done(executor, handle.cancel_goal_async())
    assert answer.return_code == CancelGoal.Response.ERROR_NONE
    assert [each.goal_id for each in answer.goals_canceling] == [handle.goal_id]
    assert answer.goals_canceling[0].stamp == handle.stamp
    assert waiting.handles[0].is_cancel_requested
    again = done(executor, handle.cancel_goal_async())
    assert (again.return_code, again.goals_canceling) == (CancelGoal.Response.ERROR_GOAL_TERMINATED, [])
    waiting.futures[0].set_result(ServerGoalHandle.canceled)
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_server_lets_nobody_cancel_unless_it_says_so(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    serve(waiting)
    answer = done(executor, accepted(executor, client).cancel_goal_async())
    assert (answer.return_code, answer.goals_canceling) == (CancelGoal.Response.ERROR_NONE, [])
    assert not waiting.handles[0].is_cancel_requested


def test_a_goal_that_is_not_executed_yet_is_cancelled_and_then_executed(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(cancel_callback=accept, handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 5)
    done(executor, handle.cancel_goal_async())
    assert kept[0].status == GoalStatus.STATUS_CANCELING
    kept[0].execute()
    assert done(executor, handle.get_result_async()).status == CANCELED


def test_a_goal_that_ends_without_having_been_executed_has_an_empty_result(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer]
) -> None:
    kept: list[ServerGoalHandle] = []
    serve(cancel_callback=accept, handle_accepted_callback=kept.append)
    handle = accepted(executor, client, 5)
    future = handle.get_result_async()
    done(executor, handle.cancel_goal_async())
    kept[0].canceled()
    answer = done(executor, future)
    assert (answer.status, list(answer.result.sequence)) == (CANCELED, [])


def test_a_goal_that_ends_while_it_is_asked_whether_to_cancel_is_not_cancelled(
    executor: SingleThreadedExecutor, client: ActionClient, serve: Callable[..., ActionServer], waiting: Waiting
) -> None:
    def end(handle: ServerGoalHandle) -> CancelResponse:
        handle.succeed()
        return CancelResponse.ACCEPT

    serve(waiting, cancel_callback=end)
    answer = done(executor, accepted(executor, client).cancel_goal_async())
    assert (answer.return_code, answer.goals_canceling) == (CancelGoal.Response.ERROR_NONE, [])


def test_many_goals_are_cancelled_by_their_age(
    executor: SingleThreadedExecutor,
    client: ActionClient,
    serve: Callable[..., ActionServer],
    waiting: Waiting,
    node: Node,
) -> None:
    server = serve(waiting, cancel_callback=accept)
    handles = []
    for number in range(1, 5):
        spin_for(executor, 1.0)
        handles.append(accepted(executor, client, number, goal_uuid=numbered(number)))
    assert [each.stamp.sec for each in handles] == [1, 2, 3, 4]
    cancel = node.create_client(CancelGoal, "fibonacci/_action/cancel_goal")

    def canceled(info: GoalInfo) -> tuple[int, set[int]]:
        answer = done(executor, cancel.call_async(CancelGoal.Request(goal_info=info)))
        return answer.return_code, {int(each.goal_id.uuid[0]) for each in answer.goals_canceling}

    assert canceled(GoalInfo(goal_id=numbered(9))) == (CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID, set())
    assert canceled(GoalInfo(goal_id=numbered(3), stamp=Time(seconds=1).to_msg())) == (0, {1, 3})
    assert canceled(GoalInfo(stamp=Time(seconds=2).to_msg())) == (0, {2})
    assert canceled(GoalInfo()) == (0, {4})
    assert canceled(GoalInfo()) == (0, set())
    assert [each.status for each in server._goal_handles.values()] == [GoalStatus.STATUS_CANCELING] * 4
