"""Server of a transform buffer: other nodes look up transforms without a listener, and traffic of /tf, of their own."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any

from robolink.action.server import ActionServer, CancelResponse, ServerGoalHandle
from robolink.callback_groups import ReentrantCallbackGroup
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.action import LookupTransform
from robolink.interfaces.tf2_msgs.msg import TF2Error
from robolink.task import Future
from robolink.tf2.buffer import Buffer
from robolink.tf2.core import nanoseconds
from robolink.tf2.exceptions import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

if TYPE_CHECKING:
    from robolink.node import Node

CODES: dict[type[TransformException], int] = {
    LookupException: TF2Error.LOOKUP_ERROR,
    ConnectivityException: TF2Error.CONNECTIVITY_ERROR,
    ExtrapolationException: TF2Error.EXTRAPOLATION_ERROR,
    InvalidArgumentException: TF2Error.INVALID_ARGUMENT_ERROR,
    TimeoutException: TF2Error.TIMEOUT_ERROR,
}
"""Codes of the exceptions in a result."""


class BufferServer:
    """Server of a buffer's look-ups, as the action tf2_msgs/action/LookupTransform.

    A goal waits until its transform is there or its timeout has passed; its result then has the transform or the error.

    Args:
        buffer: Buffer whose transforms are served.
        node: Node that offers the action; it must be spun.
        ns: Name of the action.
    """

    def __init__(self, buffer: Buffer, node: Node, ns: str) -> None:
        self.buffer, self.node = buffer, node
        self._group = ReentrantCallbackGroup()
        self._waiting: dict[bytes, Future[Any]] = {}
        self.action_server = ActionServer(
            node, LookupTransform, ns, self._execute, callback_group=self._group, cancel_callback=self._cancel
        )

    async def _execute(self, goal_handle: ServerGoalHandle) -> LookupTransform.Result:
        goal = goal_handle.request
        await self._wait(bytes(goal_handle.goal_id.uuid), goal)
        result = LookupTransform.Result()
        try:
            result.transform = self._look_up(goal)
        except TransformException as error:
            result.error = TF2Error(error=CODES.get(type(error), TF2Error.TRANSFORM_ERROR), error_string=str(error))
        if goal_handle.is_cancel_requested:
            goal_handle.canceled()
        elif result.error.error == TF2Error.NO_ERROR:
            goal_handle.succeed()
        else:
            goal_handle.abort()
        return result

    async def _wait(self, key: bytes, goal: LookupTransform.Goal) -> None:
        """Wait until the transform is there or cannot come, the goal is cancelled, or the timeout has passed."""
        span, future = nanoseconds(goal.timeout), self._future(goal)
        if span <= 0:
            future.cancel()
        timer = self.node.create_timer(max(span, 0) / 1e9, future.cancel, callback_group=self._group)
        self._waiting[key] = future
        try:
            with contextlib.suppress(TransformException):  # the lookup that follows raises it
                await future
        finally:
            del self._waiting[key]
            self.node.destroy_timer(timer)

    def _future(self, goal: LookupTransform.Goal) -> Future[TransformStamped]:
        if goal.advanced:
            return self.buffer.wait_for_transform_full_async(*_advanced(goal))
        return self.buffer.wait_for_transform_async(goal.target_frame, goal.source_frame, goal.source_time)

    def _look_up(self, goal: LookupTransform.Goal) -> TransformStamped:
        if goal.advanced:
            return self.buffer.lookup_transform_full_core(*_advanced(goal))
        return self.buffer.lookup_transform_core(goal.target_frame, goal.source_frame, goal.source_time)

    def _cancel(self, goal_handle: ServerGoalHandle) -> CancelResponse:
        future = self._waiting.get(bytes(goal_handle.goal_id.uuid))
        if future is not None:
            future.cancel()
        return CancelResponse.ACCEPT

    def destroy(self) -> None:
        """Close the action server."""
        self.action_server.destroy()


def _advanced(goal: LookupTransform.Goal) -> tuple[str, Any, str, Any, str]:
    return goal.target_frame, goal.target_time, goal.source_frame, goal.source_time, goal.fixed_frame
