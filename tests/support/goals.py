"""Action servers and clients for tests: goals, their execution, and sending them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink import Future
from robolink.action import ActionClient, CancelResponse
from robolink.action.server import ServerGoalHandle
from robolink.executors import Executor
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.example_interfaces.action import Fibonacci
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from tests.support.spins import done

PATIENCE = 30.0
SUCCEEDED, CANCELED, ABORTED = GoalStatus.STATUS_SUCCEEDED, GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_ABORTED


def fibonacci(goal_handle: ServerGoalHandle) -> Fibonacci.Result:
    """Execute a goal as the tutorials do."""
    feedback = Fibonacci.Feedback(sequence=[0, 1])
    while len(feedback.sequence) <= goal_handle.request.order:
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
            return Fibonacci.Result(sequence=feedback.sequence)
        feedback.sequence.append(feedback.sequence[-1] + feedback.sequence[-2])
        goal_handle.publish_feedback(feedback)
    goal_handle.succeed()
    return Fibonacci.Result(sequence=feedback.sequence)


def numbered(number: int) -> UUID:
    return UUID(uuid=[number] * 16)


def accept(_: Any) -> CancelResponse:
    return CancelResponse.ACCEPT


class Waiting:
    """Executes goals that go on until they are told how to end."""

    def __init__(self) -> None:
        self.handles: list[ServerGoalHandle] = []
        self.futures: list[Future[Callable[[ServerGoalHandle], None]]] = []

    async def __call__(self, handle: ServerGoalHandle) -> Fibonacci.Result:
        self.handles.append(handle)
        self.futures.append(Future())
        end = await self.futures[-1]
        assert end is not None
        end(handle)
        return Fibonacci.Result(sequence=[handle.request.order])


def accepted(executor: Executor, client: ActionClient, order: int = 1, **options: Any) -> Any:
    """Send a goal; its handle, once the server has accepted it."""
    handle = done(executor, client.send_goal_async(Fibonacci.Goal(order=order), **options))
    assert handle.accepted
    return handle
