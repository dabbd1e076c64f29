"""Actions of a node on asyncio's event loop: goals, feedback, results, cancellation, and what never comes."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from robolink import Context
from robolink.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from robolink.action.client import ClientGoalHandle
from robolink.action.server import ServerGoalHandle
from robolink.exceptions import BlockingCallError
from robolink.experimental import AsyncNode
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from tests.support.goals import ABORTED, CANCELED, SUCCEEDED, accept
from tests.support.loops import run, until

Talk = Callable[[ActionClient], Awaitable[Any]]


async def count(goal: ServerGoalHandle) -> Fibonacci.Result:
    """Execute a goal, with feedback before each number."""
    result = Fibonacci.Result()
    for number in range(goal.request.order):
        if goal.is_cancel_requested:
            goal.canceled()
            return result
        goal.publish_feedback(Fibonacci.Feedback(sequence=[number]))
        result.sequence.append(number)
        await asyncio.sleep(0.001)
    goal.succeed()
    return result


def served(context: Context, execute: Callable[[ServerGoalHandle], Any], talk: Talk, **options: Any) -> Any:
    """Return what a client's coroutine returns, beside a server of a node of its own."""

    async def main() -> Any:
        async with AsyncNode("server", context=context) as server, AsyncNode("client", context=context) as node:
            ActionServer(server, Fibonacci, "count", execute, **options)
            client = ActionClient(node, Fibonacci, "count")
            assert await client.wait_for_server(timeout_sec=5.0)
            return await talk(client)

    return run(main())


def test_a_goal_its_feedback_and_its_result_are_awaited(context: Context) -> None:
    async def talk(client: ActionClient) -> tuple[Any, list[int]]:
        seen: list[int] = []

        async def on_feedback(message: Any) -> None:
            await asyncio.sleep(0)
            seen.extend(message.feedback.sequence)

        goal = await client.send_goal_async(Fibonacci.Goal(order=3), feedback_callback=on_feedback)
        assert goal is not None
        assert goal.accepted
        answer = await goal.get_result_async()
        await until(lambda: len(seen) == 3)
        return answer, seen

    answer, seen = served(context, count, talk)
    assert (answer.status, [*answer.result.sequence], seen) == (SUCCEEDED, [0, 1, 2], [0, 1, 2])


def test_callbacks_of_a_server_may_await(context: Context) -> None:
    async def decide(goal: Fibonacci.Goal) -> GoalResponse:
        await asyncio.sleep(0.001)
        return GoalResponse.ACCEPT if goal.order > 0 else GoalResponse.REJECT

    async def agree(handle: ServerGoalHandle) -> CancelResponse:
        await asyncio.sleep(0.001)
        return CancelResponse.ACCEPT

    async def talk(client: ActionClient) -> tuple[bool, int, int]:
        refused = await client.send_goal_async(Fibonacci.Goal(order=0))
        goal = await client.send_goal_async(Fibonacci.Goal(order=10_000))
        assert goal is not None
        assert refused is not None
        response = await goal.cancel_goal_async()
        assert response is not None
        return refused.accepted, len(response.goals_canceling), await _status(goal)

    found = served(context, count, talk, goal_callback=decide, cancel_callback=agree)
    assert found == (False, 1, CANCELED)


def test_goals_run_side_by_side(context: Context) -> None:
    barrier: list[None] = []

    async def meet(goal: ServerGoalHandle) -> Fibonacci.Result:
        barrier.append(None)
        await until(lambda: len(barrier) == 3)
        goal.succeed()
        return Fibonacci.Result()

    async def talk(client: ActionClient) -> list[int]:
        goals = await asyncio.gather(*(client.send_goal_async(Fibonacci.Goal()) for _ in range(3)))
        return [*await asyncio.gather(*(_status(goal) for goal in goals))]

    assert served(context, meet, talk) == [SUCCEEDED] * 3


def test_a_goal_that_fails_is_aborted_and_the_node_goes_on(context: Context) -> None:
    async def fail(goal: ServerGoalHandle) -> Fibonacci.Result:
        raise ValueError("no numbers")

    async def give_up(goal: ServerGoalHandle) -> Fibonacci.Result:
        raise asyncio.CancelledError

    async def talk(client: ActionClient) -> int:
        goal = await client.send_goal_async(Fibonacci.Goal())
        assert goal is not None
        return await _status(goal)

    assert served(context, fail, talk) == ABORTED
    assert served(context, give_up, talk) == ABORTED


def test_a_wait_for_a_result_may_be_cancelled(context: Context) -> None:
    async def talk(client: ActionClient) -> int:
        goal = await client.send_goal_async(Fibonacci.Goal(order=10_000))
        assert goal is not None
        with pytest.raises(asyncio.TimeoutError):
            await asyncio.wait_for(_awaited(goal.get_result_async()), 0.01)
        await goal.cancel_goal_async()
        return await _status(goal)

    assert served(context, count, talk, cancel_callback=accept) == GoalStatus.STATUS_CANCELED


async def _status(goal: ClientGoalHandle | None) -> int:
    assert goal is not None
    answer: Any = await goal.get_result_async()
    return int(answer.status)


async def _awaited(future: Awaitable[Any]) -> Any:
    return await future


def test_the_end_of_a_node_cancels_who_awaits_its_goals(context: Context) -> None:
    async def wait(goal: ServerGoalHandle) -> Fibonacci.Result:
        await asyncio.Event().wait()
        return Fibonacci.Result()

    async def talk(client: ActionClient) -> bool:
        goal = await client.send_goal_async(Fibonacci.Goal())
        assert goal is not None
        waiting = asyncio.ensure_future(_awaited(goal.get_result_async()))
        await asyncio.sleep(0.001)
        client._node.destroy_node()
        await asyncio.wait([waiting])
        return waiting.cancelled()

    assert served(context, wait, talk)


def test_a_call_that_would_block_the_event_loop_is_refused(context: Context) -> None:
    async def talk(client: ActionClient) -> None:
        with pytest.raises(BlockingCallError, match="this call would wait in the thread of the event loop"):
            client.send_goal(Fibonacci.Goal())
        goal = await client.send_goal_async(Fibonacci.Goal(order=1))
        assert goal is not None
        with pytest.raises(BlockingCallError):
            goal.get_result()
        with pytest.raises(TypeError, match="await this wait first"):
            assert client.wait_for_server()

    served(context, count, talk)


def test_a_blocking_call_before_the_node_runs_is_refused_too(context: Context) -> None:
    async def main() -> None:
        client = ActionClient(AsyncNode("client", context=context), Fibonacci, "count")
        with pytest.raises(BlockingCallError):
            client.send_goal(Fibonacci.Goal())

    run(main())


def test_a_server_that_never_comes_is_told_after_the_timeout(context: Context) -> None:
    async def main() -> bool:
        async with AsyncNode("client", context=context) as node:
            return bool(await ActionClient(node, Fibonacci, "count").wait_for_server(timeout_sec=0.01))

    assert run(main()) is False
