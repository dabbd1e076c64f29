"""Handle of a goal on the client's side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.interfaces.action_msgs.srv import CancelGoal
from robolink.interfaces.builtin_interfaces.msg import Time
from robolink.interfaces.unique_identifier_msgs.msg import UUID
from robolink.task import Future
from robolink.type_support import in_brackets

if TYPE_CHECKING:
    from robolink.action.client import ActionClient


class ClientGoalHandle:
    """Handle of a goal on the client's side; made by `ActionClient.send_goal_async`."""

    __class_getitem__ = in_brackets(3)

    def __init__(self, action_client: ActionClient, goal_id: UUID, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status: int = GoalStatus.STATUS_ACCEPTED if goal_response.accepted else GoalStatus.STATUS_UNKNOWN

    def __eq__(self, other: object) -> bool:
        return bool(self._goal_id == other._goal_id) if isinstance(other, ClientGoalHandle) else NotImplemented

    def __hash__(self) -> int:
        return hash(key_of(self._goal_id))

    def __repr__(self) -> str:
        return f"ClientGoalHandle <id={key_of(self._goal_id).hex()}, accepted={self.accepted}, status={self.status}>"

    @property
    def goal_id(self) -> UUID:
        """Id that the goal was sent with."""
        return self._goal_id

    @property
    def stamp(self) -> Time:
        """Time at which the server accepted it, by the server's clock."""
        stamp: Time = self._goal_response.stamp
        return stamp

    @property
    def accepted(self) -> bool:
        """True if the server accepted it."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """The state last received from the server, a code of action_msgs/msg/GoalStatus."""
        return self._status

    def cancel_goal(self) -> CancelGoal.Response:
        """Ask the server to cancel the goal, and return its response. Raises what `Client.call` raises."""
        return self._action_client._cancel_goal(self)

    def cancel_goal_async(self) -> Future[CancelGoal.Response]:
        """Ask the server to cancel the goal; the returned future gets its response, or a ServiceError."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the goal's end, and return ``status`` and ``result``. Raises what `Client.call` raises."""
        return self._action_client._get_result(self)

    def get_result_async(self) -> Future[Any]:
        """Return a future of a response with ``status`` and ``result``, done when the goal has ended.

        It fails with ServiceError (a RuntimeError) if the server goes away before.
        """
        return self._action_client._get_result_async(self)


def key_of(goal_id: UUID) -> bytes:
    """Return an id as a key of a table."""
    return bytes(goal_id.uuid)
