"""Handle of a goal on the server's side."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.action.states import ACTIVE, GoalEvent, next_status
from robolink.exceptions import RCLError
from robolink.interfaces.action_msgs.msg import GoalInfo, GoalStatus
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.type_support import in_brackets

if TYPE_CHECKING:
    from robolink.action.server import ActionServer


class ServerGoalHandle:
    """Handle of an accepted goal on the server's side: its request, feedback and end. Usable from any thread.

    Once the server has been destroyed, or the goal's result has expired, its methods do nothing.
    """

    __class_getitem__ = in_brackets(3)

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
        """Id that the client gave it."""
        return self._goal_info.goal_id

    @property
    def is_active(self) -> bool:
        """True until the goal has succeeded or was aborted or cancelled."""
        return self.status in ACTIVE

    @property
    def is_cancel_requested(self) -> bool:
        """True once the goal is to be cancelled: end it then, usually by `canceled`."""
        return self.status == GoalStatus.STATUS_CANCELING

    @property
    def status(self) -> int:
        """State, a code of action_msgs/msg/GoalStatus; STATUS_UNKNOWN once it is forgotten."""
        return GoalStatus.STATUS_UNKNOWN if self._destroyed else self._status

    def execute(self, execute_callback: Callable[[ServerGoalHandle], Any] | None = None) -> None:
        """Schedule the execution of the goal.

        Args:
            execute_callback: Called with this handle; None takes the server's.

        Raises:
            RCLError: if it was executed before.
        """
        with self._action_server._lock:
            if self._executed:
                raise RCLError("a goal can be executed once only")
            if not self.is_cancel_requested:  # the callback is called then too: it is what ends the goal
                self._update_state(GoalEvent.EXECUTE)
            self._executed = True
        self._action_server.notify_execute(self, execute_callback)

    def publish_feedback(self, feedback: Any) -> None:
        """Send feedback to the client.

        Args:
            feedback: A message of the action's ``Feedback``.

        Raises:
            TypeError: if it is of another type.
        """
        wanted = self._action_server.action_type.Feedback
        if not isinstance(feedback, wanted):
            raise TypeError(f"Expected {wanted}, got {type(feedback)}")
        with self._action_server._lock:
            if not self._destroyed:
                self._action_server._publish_feedback(self.goal_id, feedback)

    def succeed(self) -> None:
        """End the goal as reached. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.SUCCEED)

    def abort(self) -> None:
        """End the goal as failed. Raises RCLError unless it is executing or to be cancelled."""
        self._update_state(GoalEvent.ABORT)

    def canceled(self) -> None:
        """End the goal as cancelled. Raises RCLError unless that was asked for."""
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
        """Forget the goal: nothing more is published about it."""
        self._destroyed = True
