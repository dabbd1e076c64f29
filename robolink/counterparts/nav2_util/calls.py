"""Calls of other servers from a coroutine: an action's goal up to its result, and a service, with clear outcomes."""

from __future__ import annotations

from typing import Any, NamedTuple

from robolink.action import ActionClient
from robolink.action.client import ClientGoalHandle
from robolink.callback_groups import CallbackGroup
from robolink.client import Client
from robolink.counterparts.program import pause
from robolink.exceptions import ServiceError
from robolink.interfaces.action_msgs.msg import GoalStatus
from robolink.node import Node

LOOK = 0.1
"""Time between two looks for a server, in seconds."""


class Outcome(NamedTuple):
    """Outcome of a goal."""

    status: int
    """Code of action_msgs/msg/GoalStatus; UNKNOWN if no server carried it out."""
    result: Any = None
    """The action's result; None if no server carried the goal out."""
    words: str = ""
    """Reason why it did not succeed; empty if it did."""

    @property
    def succeeded(self) -> bool:
        """True if the goal was reached."""
        return self.status == GoalStatus.STATUS_SUCCEEDED

    @property
    def code(self) -> int:
        """Error code of the result; 0 if there is none."""
        return int(getattr(self.result, "error_code", 0))


class ActionCall:
    """Client of an action, for one goal at a time: a newer goal is sent while the one before is still carried out."""

    def __init__(self, node: Node, action_type: type[Any], name: str, group: CallbackGroup) -> None:
        self.action_type, self.name = action_type, name
        self._node, self._group = node, group
        self._client = ActionClient(node, action_type, name, callback_group=group)
        self._handle: ClientGoalHandle | None = None
        self._number = 0

    async def run(self, goal: Any, patience: float) -> Outcome:
        """Send a goal, and return how it ended.

        Args:
            goal: The goal.
            patience: Time to wait for the server, in seconds.
        """
        self._number += 1
        number = self._number
        if not await is_there(self._node, self._client, patience, self._group):
            return self._failed(f"nobody serves the action {self.name}: is its node started, and active?")
        try:
            handle = await self._client.send_goal_async(goal)
            if handle is None or not handle.accepted:
                return self._failed(f"the server of the action {self.name} rejected the goal: is its node active?")
            if number != self._number:  # cancelled, or replaced, before it was accepted
                handle.cancel_goal_async()
            else:
                self._handle = handle
            answer: Any = await handle.get_result_async()
        except ServiceError as error:
            return self._failed(f"the server of the action {self.name} went away: {error}")
        finally:
            if number == self._number:
                self._handle = None
        return Outcome(answer.status, answer.result, _words(self.name, answer))

    def cancel(self) -> None:
        """Cancel the goal that is carried out, or about to be sent; its `run` ends soon."""
        self._number += 1
        handle, self._handle = self._handle, None
        if handle is not None:
            handle.cancel_goal_async()

    def destroy(self) -> None:
        """Cancel the goal, and destroy the client."""
        self.cancel()
        self._client.destroy()

    def _failed(self, words: str) -> Outcome:
        return Outcome(GoalStatus.STATUS_UNKNOWN, None, words)


def _words(name: str, answer: Any) -> str:
    if answer.status == GoalStatus.STATUS_SUCCEEDED:
        return ""
    said = getattr(answer.result, "error_msg", "")
    ended = "was cancelled" if answer.status == GoalStatus.STATUS_CANCELED else "failed"
    return str(said) or f"{name} {ended}, with error code {getattr(answer.result, 'error_code', 0)}"


async def is_there(node: Node, client: Any, patience: float, group: CallbackGroup) -> bool:
    """Wait up to `patience` seconds until the server of a client of a service or an action is there."""
    ready = client.server_is_ready if isinstance(client, ActionClient) else client.service_is_ready
    waited = 0.0
    while not ready():
        if waited >= patience:
            return False
        await pause(node, LOOK, group)
        waited += LOOK
    return True


async def called(node: Node, client: Client, request: Any, patience: float, group: CallbackGroup) -> Any:
    """Call a service, and return its response; None if nobody answers. `patience`: longest wait for a server, in s."""
    if not await is_there(node, client, patience, group):
        node.get_logger().warning(f"nobody serves {client.service_name}", throttle_duration_sec=10.0)
        return None
    try:
        return await client.call_async(request)
    except ServiceError as error:
        node.get_logger().warning(f"{client.service_name}: no answer: {error}")
        return None
