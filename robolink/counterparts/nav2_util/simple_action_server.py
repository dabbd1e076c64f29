"""Action server as Nav2's servers have it: one goal at a time, which a newer goal takes over from (preemption).

Every goal is accepted while the server is active. A goal that comes while another is carried out waits as the one
pending goal; what was pending before is aborted. The execution looks now and then (`is_preempt_requested`,
`is_cancel_requested`) and takes the pending goal over by `accept_pending_goal`: **the old goal is aborted** with an
empty result, as in Nav2. An execution that ends without looking has the pending goal executed after it.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from robolink.action import ActionServer, CancelResponse, GoalResponse
from robolink.action.server import ServerGoalHandle
from robolink.node import Node
from robolink.task import Future, Task
from robolink.text.tracebacks import formatted


class _Goals(ActionServer):
    """Action server that says when it is destroyed: its node has ended, or the context."""

    def __init__(self, on_destroy: Callable[[], None], *args: Any, **options: Any) -> None:
        self._on_destroy = on_destroy
        super().__init__(*args, **options)

    def destroy(self) -> None:
        """Destroy the server."""
        self._on_destroy()
        super().destroy()


class SimpleActionServer:
    """A server of one action that executes one goal at a time, in a coroutine.

        class Waiter(LifecycleNode):
            def on_configure(self, state):
                self.server = SimpleActionServer(self, Wait, "wait", self.execute)
                return TransitionCallbackReturn.SUCCESS

            async def execute(self) -> None:
                goal = self.server.goal
                while not is_over(goal):
                    if self.server.is_cancel_requested:
                        return self.server.terminate_all()
                    if self.server.is_preempt_requested:
                        goal = self.server.accept_pending_goal()
                    self.server.publish_feedback(Wait.Feedback())
                    await pause(self, 0.1, self.group)
                self.server.succeeded_current()

    `on_activate` of the node calls `activate`, `on_deactivate` calls `deactivate`, and `on_cleanup` `destroy`. A goal
    that comes before is rejected.

    Goals end as follows: `succeeded_current` succeeds; `terminate_current` and `terminate_all` cancel a goal for which
    that was requested, and abort another. A goal that an execution leaves open is aborted; so are all goals if it
    raises, or if the server is deactivated meanwhile. Its coroutine is closed then, where it awaits: what must be done
    in any case, such as stopping the robot, belongs into its `finally`, which cannot await.
    """

    def __init__(
        self,
        node: Node,
        action_type: type[Any],
        action_name: str,
        execute: Callable[[], Coroutine[Any, Any, None]],
        *,
        is_acceptable: Callable[[Any], bool] | None = None,
        on_change: Callable[[], None] | None = None,
    ) -> None:
        """Create a server that is not active yet.

        Args:
            node: Node of the server.
            action_type: Class of the action.
            action_name: Name of the action.
            execute: Coroutine function that carries out the current goal, and those that it takes over meanwhile.
            is_acceptable: Called with each new goal; False rejects it. It should log the reason.
            on_change: Called when a goal becomes pending, or is to be cancelled, for an execution that sleeps. The flag
                is set only after the call: let it wake a coroutine, by setting a future's result.
        """
        self.action_type, self.action_name = action_type, action_name
        self._node, self._execute, self._is_acceptable = node, execute, is_acceptable
        self._on_change = on_change or (lambda: None)
        self._logger = node.get_logger()
        self._current: ServerGoalHandle | None = None
        self._pending: ServerGoalHandle | None = None
        self._results: dict[bytes, Future[Any]] = {}
        self._work: Task[Any] | None = None
        self._is_active = False
        self._server = _Goals(
            self._close,
            node,
            action_type,
            action_name,
            self._result_of,
            goal_callback=self._on_goal,
            handle_accepted_callback=self._on_accepted,
            cancel_callback=self._on_cancel,
        )

    # The node's transitions

    @property
    def is_active(self) -> bool:
        """True between `activate` and `deactivate`: goals are accepted."""
        return self._is_active

    def activate(self) -> None:
        """Accept goals from now on."""
        self._is_active = True

    def deactivate(self) -> None:
        """Accept no more goals, end those that are there, and close the coroutine that carries one out."""
        self._is_active = False
        work, self._work = self._work, None
        if work is not None:
            self._warn("Requested to deactivate server but goal is still executing.")
            work.cancel()
        self.terminate_all()

    def destroy(self) -> None:
        """Withdraw the action."""
        self.deactivate()
        self._server.destroy()

    def _close(self) -> None:
        """Close the coroutine when node or context end: else the collector does so at any time, in other code."""
        self._is_active = False
        work, self._work = self._work, None
        if work is not None:
            work.cancel()

    # For the execution

    @property
    def goal(self) -> Any:
        """Goal that is carried out, a message of the action's type ``Goal``; None once it has ended."""
        return self._current.request if self._current is not None else None

    @property
    def goal_id(self) -> bytes:
        """Id of the goal that is carried out, 16 bytes; empty once it has ended."""
        return bytes(self._current.goal_id.uuid) if self._current is not None else b""

    @property
    def pending_goal(self) -> Any:
        """Goal that waits to take over; None if there is none."""
        return self._pending.request if self._pending is not None else None

    @property
    def is_running(self) -> bool:
        """True while the coroutine of a goal runs."""
        return self._work is not None

    @property
    def is_preempt_requested(self) -> bool:
        """True while a goal waits to take over: take it by `accept_pending_goal`, or end it."""
        return self._pending is not None

    @property
    def is_cancel_requested(self) -> bool:
        """True if the goal is to be cancelled; while another is pending, if that one is, as in Nav2."""
        handle = self._pending or self._current
        return handle is not None and handle.is_cancel_requested

    def accept_pending_goal(self) -> Any:
        """Let the pending goal take over, and return it; the one before is aborted. None if there is none."""
        if self._pending is None:
            self._logger.error(f"[{self.action_name}] Attempting to get pending goal when not available")
            return None
        before, self._current, self._pending = self._current, self._pending, None
        if before is not None:
            self._end(before, ServerGoalHandle.abort)
        return self._current.request

    def terminate_pending_goal(self, result: Any = None) -> None:
        """End the pending goal: cancelled if that was requested, otherwise aborted; None is an empty result."""
        handle, self._pending = self._pending, None
        self._terminate(handle, result)

    def terminate_current(self, result: Any = None) -> None:
        """End the current goal: cancelled if that was requested, otherwise aborted; None is an empty result."""
        handle, self._current = self._current, None
        self._terminate(handle, result)

    def terminate_all(self, result: Any = None) -> None:
        """End the current goal and the pending one: cancelled if that was requested, otherwise aborted."""
        self.terminate_current(result)
        self.terminate_pending_goal(result)

    def succeeded_current(self, result: Any = None) -> None:
        """End the current goal as reached; None is an empty result."""
        handle, self._current = self._current, None
        if handle is not None:
            self._end(handle, ServerGoalHandle.succeed, result)

    def publish_feedback(self, feedback: Any) -> None:
        """Send feedback about the current goal; nothing once it has ended."""
        if self._current is not None:
            self._current.publish_feedback(feedback)

    # Goals

    def _on_goal(self, goal: Any) -> GoalResponse:
        if not self._is_active:
            self._logger.info(f"[{self.action_name}] Action server is inactive. Rejecting the goal.")
            return GoalResponse.REJECT
        acceptable = self._is_acceptable is None or self._is_acceptable(goal)
        return GoalResponse.ACCEPT if acceptable else GoalResponse.REJECT

    def _on_accepted(self, handle: ServerGoalHandle) -> None:
        self._results[bytes(handle.goal_id.uuid)] = Future()
        handle.execute()
        executor = self._node.executor
        if not self._is_active or executor is None:  # deactivated between the two callbacks
            self._terminate(handle, None)
        elif self._work is not None:
            if self._pending is not None:
                self.terminate_pending_goal()
            self._pending = handle
            self._on_change()
        else:
            self._current = handle
            self._work = executor.create_task(self._carry_out())

    def _on_cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        if not handle.is_active:
            return CancelResponse.REJECT
        self._on_change()
        return CancelResponse.ACCEPT

    async def _result_of(self, handle: ServerGoalHandle) -> Any:
        """Wait for the result of a goal that was accepted."""
        key = bytes(handle.goal_id.uuid)
        try:
            return await self._results[key]
        finally:
            self._results.pop(key, None)

    async def _carry_out(self) -> None:
        """Carry out the current goal, and then what is pending."""
        while self._current is not None:
            try:
                await self._execute()
            except Exception as error:  # noqa: BLE001 - the goal has failed, not the node
                if not self._node.context.ok():  # its `finally` found nothing left to stop the robot with
                    return
                self._logger.error(f"[{self.action_name}] Action server failed:\n{formatted(error)}")
                self.terminate_all(self._failure(f"{type(error).__name__}: {error}"))
            if self._current is not None:
                self._warn("Current goal was not completed successfully.")
                self.terminate_current()
            if self._pending is not None:
                self.accept_pending_goal()
        self._work = None

    def _failure(self, words: str) -> Any:
        result = self.action_type.Result()
        if hasattr(result, "error_msg"):
            result.error_msg = words
        return result

    def _terminate(self, handle: ServerGoalHandle | None, result: Any) -> None:
        if handle is None:
            return
        if handle.is_cancel_requested:
            self._logger.info(f"[{self.action_name}] Client requested to cancel the goal. Cancelling.")
            self._end(handle, ServerGoalHandle.canceled, result)
            return
        details = [f"{each}: {getattr(result, each)}" for each in ("error_code", "error_msg") if hasattr(result, each)]
        self._warn("Aborting handle." + "".join(f" {each}" for each in details))
        self._end(handle, ServerGoalHandle.abort, result)

    def _end(self, handle: ServerGoalHandle, how: Callable[[ServerGoalHandle], None], result: Any = None) -> None:
        how(handle)
        future = self._results.get(bytes(handle.goal_id.uuid))
        if future is not None and not future.over():
            future.set_result(self.action_type.Result() if result is None else result)

    def _warn(self, words: str) -> None:
        self._logger.warning(f"[{self.action_name}] {words}")
