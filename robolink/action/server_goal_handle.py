"""A goal as its server has it."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.action.states import ACTIVE, GoalEvent, RCLError, next_status
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.unique_identifier_msgs.msg import UUID

if TYPE_CHECKING:
    from robolink.action.server import ActionServer


class ServerGoalHandle:
    """An accepted goal: what was asked, and how the server says what becomes of it. Usable from any thread.

    Once the server has been destroyed, or the goal's result has expired, its methods do nothing.
    """

    def __init__(self, action_server: ActionServer, goal_info: GoalInfo, goal_request: Any) -> None:
        self._action_server = action_server
        self._goal_info = goal_info
        self._goal_request = goal_request
        self._status: int = GoalStatus.STATUS_ACCEPTED
        self._executed = False
        self._destroyed = False

    def __eq__(self, other: object) -> bool:
        return bool(self.goal_id == other.goal_id) if isinstance(other, ServerGoalHandle) else NotImplemented

    def __hash__(self) -> int:
        return hash(bytes(self.goal_id.uuid))

    @property
    def request(self) -> Any:
        """The goal: a message of the action's type ``Goal``."""
        return self._goal_request

    @property
    def goal_id(self) -> UUID:
        """The id that the client gave it."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """Whether more will come of it: it neither succeeded nor was aborted or cancelled."""
        return self.status in ACTIVE

    @property
    def is_cancel_requested(self) -> bool:
        """Whether it shall be cancelled: end it then, by `canceled` as a rule."""
        return self.status == GoalStatus.STATUS_CANCELING

    @property
    def status(self) -> int:
        """A code of action_msgs/msg/GoalStatus; STATUS_UNKNOWN once it is forgotten."""
        return GoalStatus.STATUS_UNKNOWN if self._destroyed else self._status

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Have the executor run `execute_callback`, by default the server's. Raises RCLError the second time."""
        with self._action_server._lock:
            if self._executed:
                raise RCLError("a goal can be executed once only")
            if not self.is_cancel_requested:  # the callback is called then too: it is what ends the goal
                self._update_state(GoalEvent.EXECUTE)
            self._executed = True
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Tell the client how far it is. Raises TypeError unless it is the action's ``Feedback``."""
        wanted = self._action_server.action_type.Feedback
        if not isinstance(feedback, wanted):
            raise TypeError(f"Expected {wanted}, got {type(feedback)}")
        with self._action_server._lock:
            if not self._destroyed:
                self._action_server._publish_feedback(self.goal_id, feedback)

    def succeed(self) -> None:
        """Say that it has been reached. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """Give it up. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """Say that it has been cancelled. Raises RCLError unless that was asked for."""
        self._update_state(GoalEvent.CANCELED)

    def _update_state(self, event: GoalEvent) -> None:
        server = self._action_server
        with server._lock:
            if self._destroyed:
                return
            self._status = next_status(self._status, event)
            server._note_status(self)
            if not (self.is_active or self._executed):
                server.notify_goal_done()

    def destroy(self) -> None:
        """Forget it: nothing more is published about it."""
        self._destroyed = True
