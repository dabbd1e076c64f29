"""Lookups that another node's buffer answers: a BufferServer, or ROS 2's."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

from robolink.action.client import ActionClient
from robolink.duration import Duration
from robolink.exceptions import ServiceError
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.builtin_interfaces.msg import Time as TimeMsg
from robolink.interfaces.geometry_msgs.msg import TransformStamped
from robolink.interfaces.tf2_msgs.action import LookupTransform
from robolink.interfaces.tf2_msgs.msg import TF2Error
from robolink.queues import A_WHILE
from robolink.task import Future
from robolink.tf2.buffer_interface import BufferInterface
from robolink.tf2.buffer_server import CODES
from robolink.tf2.core import nanoseconds
from robolink.tf2.exceptions import TimeoutException, TransformException
from robolink.tf2.waiting import check

if TYPE_CHECKING:
    from robolink.node import Node

EXCEPTIONS = {code: kind for kind, code in CODES.items()}


class BufferClient(BufferInterface):
    """Asks the buffer that is served as the action `ns`; something must spin the node, as a callback of it does.

    A lookup takes its own timeout and `timeout_padding` at most. `check_frequency` is tf2's, and not needed here.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration = Duration(seconds=2.0),  # noqa: B008 - tf2's signature
    ) -> None:
        super().__init__()
        self.node, self.check_frequency, self.timeout_padding = node, check_frequency, timeout_padding
        self.action_client = ActionClient(node, LookupTransform, action_name=ns)

    def lookup_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Give the transform that takes what is given in `source_frame` to `target_frame`, at a time, 0 the latest.

        Raises what `Buffer.lookup_transform` raises, and TimeoutException when the server is not there or silent.
        """
        goal = LookupTransform.Goal(target_frame=target_frame, source_frame=source_frame, source_time=_message(time))
        return self._ask(goal, timeout)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> TransformStamped:
        """Give the transform from one frame and time to another; `fixed_frame` stands still in between."""
        goal = LookupTransform.Goal(
            target_frame=target_frame,
            source_frame=source_frame,
            source_time=_message(source_time),
            target_time=_message(target_time),
            fixed_frame=fixed_frame,
            advanced=True,
        )
        return self._ask(goal, timeout)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> bool:
        """Say whether `lookup_transform` would succeed."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = Duration(),  # noqa: B008
    ) -> bool:
        """Say whether `lookup_transform_full` would succeed."""
        try:
            self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        except TransformException:
            return False
        return True

    def _ask(self, goal: LookupTransform.Goal, timeout: Duration) -> TransformStamped:
        goal.timeout = timeout.to_msg()
        if not self.action_client.server_is_ready():
            raise TimeoutException("The BufferServer is not ready.")
        base = self.node.context.time
        deadline = base.steady() + nanoseconds(timeout, "timeout") + self.timeout_padding.nanoseconds
        try:
            handle = self._wait(self.action_client.send_goal_async(goal), deadline)
            if not handle.accepted:
                raise TimeoutException("The BufferServer rejected the lookup.")
            answer = self._wait(handle.get_result_async(), deadline)
        except ServiceError as error:
            raise TimeoutException(f"The BufferServer went away: {error}") from None
        return _found(answer)

    def _wait(self, future: Future[Any], deadline: int) -> Any:
        executor, context = self.node.executor, self.node.context
        if executor is not None and executor.spins_here:
            executor.serve_until(future, deadline)
        elif context.time.virtual:
            context.time.wait_until(future.done, deadline)
        else:
            came = threading.Event()
            future.when_done(came.set)
            while not came.wait(min(A_WHILE, max(0.0, (deadline - context.time.steady()) / 1e9))):
                check([context])
                if context.time.steady() >= deadline:
                    break
        if not future.done():
            future.cancel()
            raise TimeoutException(
                "The BufferServer did not answer in time: something is wrong with it, or nobody spins this node."
            )
        return future.result()

    def destroy(self) -> None:
        """Ask no more."""
        self.action_client.destroy()


def _found(answer: Any) -> TransformStamped:
    """Give the transform of an answer, or raise the exception that it stands for."""
    error, transform = answer.result.error, answer.result.transform
    if error.error != TF2Error.NO_ERROR:
        raise EXCEPTIONS.get(error.error, TransformException)(error.error_string)
    if answer.status != GoalStatus.STATUS_SUCCEEDED:  # ROS 2's server says no more when a timeout has passed
        raise TimeoutException("The BufferServer found no such transform in time.")
    assert isinstance(transform, TransformStamped)
    return transform


def _message(moment: Any) -> TimeMsg:
    seconds, rest = divmod(nanoseconds(moment), 10**9)
    return TimeMsg(sec=seconds, nanosec=rest)
