"""Client of a remote transform buffer: look-ups that a BufferServer, robolink's or ROS 2's, answers."""

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
from robolink.system.waits import A_WHILE
from robolink.task import Future
from robolink.tf2.buffer_interface import BufferInterface
from robolink.tf2.buffer_server import CODES
from robolink.tf2.core import nanoseconds
from robolink.tf2.exceptions import TimeoutException, TransformException
from robolink.tf2.waiting import check

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.node import Node

EXCEPTIONS = {code: kind for kind, code in CODES.items()}
"""Exceptions by the code of a result."""


class BufferClient(BufferInterface):
    """Client of the buffer that a BufferServer offers as an action.

    The node must be spun, unless one of its own callbacks asks.

    Times are `Time` or `builtin_interfaces/msg/Time`; zero means the latest.

    Args:
        node: Node that asks.
        ns: Name of the server's action.
        check_frequency: Unused; an argument of tf2's client, which polls at this rate in Hz.
        timeout_padding: Time that an answer may take beyond a look-up's own timeout; 2 s by default.
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
        """Return the transform that takes coordinates in `source_frame` to coordinates in `target_frame`.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait of the server for the transform; zero does not wait.

        Raises:
            TimeoutException: if there is no server, or it does not answer in time.
            TransformException: any of `Buffer.lookup_transform`, as the server found it.
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
        """Return the transform from `source_frame` at one time to `target_frame` at another.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.
            timeout: Longest wait of the server for the transform; zero does not wait.

        Raises:
            TimeoutException: if there is no server, or it does not answer in time.
            TransformException: any of `Buffer.lookup_transform_full`, as the server found it.
        """
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
        """True if `lookup_transform` would succeed with these arguments.

        Args:
            target_frame: Name of the frame to which data are transformed.
            source_frame: Name of the frame in which data are given.
            time: Time of the transform; zero means the latest.
            timeout: Longest wait of the server for the transform; zero does not wait.
        """
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
        """True if `lookup_transform_full` would succeed with these arguments.

        Args:
            target_frame: Name of the frame to which data are transformed.
            target_time: Time at which the target frame is taken; zero means the latest.
            source_frame: Name of the frame in which data are given.
            source_time: Time at which the source frame is taken; zero means the latest.
            fixed_frame: Name of a frame that does not move between the two times.
            timeout: Longest wait of the server for the transform; zero does not wait.
        """
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
        else:
            context.time.wait_notified(future.done, deadline, lambda _: _block(future, deadline, context))
        if not future.done():
            future.cancel()
            raise TimeoutException(
                "The BufferServer did not answer in time: something is wrong with it, or nobody spins this node."
            )
        return future.result()

    def destroy(self) -> None:
        """Close the action client."""
        self.action_client.destroy()


def _block(future: Future[Any], deadline: int, context: Context) -> None:
    """Block until the future is done or steady time is `deadline`; raise as `check` does when the context ends."""
    came = threading.Event()
    future.when_done(came.set)
    while not came.wait(min(A_WHILE, max(0.0, (deadline - context.time.steady()) / 1e9))):
        check([context])
        if context.time.steady() >= deadline:
            break


def _found(answer: Any) -> TransformStamped:
    """Return the transform of a result, or raise the exception of its code."""
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
