"""Action server of one turtle, rotate_absolute: turns it to a heading; of several goals the newest one counts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.action import ActionServer, CancelResponse
from robolink.interfaces.turtlesim.action import RotateAbsolute
from robolink.task import Future

if TYPE_CHECKING:
    from robolink.action.server import ServerGoalHandle
    from robolink.counterparts.turtlesim.turtle import Turn, Turtle
    from robolink.node import Node


class Rotation:
    """Server of the action of one turtle.

    Args:
        node: Node of the server.
        name: Name of the turtle.
        turtle: The turtle that is turned.
    """

    def __init__(self, node: Node, name: str, turtle: Turtle) -> None:
        self._turtle, self._logger = turtle, node.get_logger()
        self._goal: ServerGoalHandle | None = None
        self._ended: Future[Any] = Future()
        self._result = RotateAbsolute.Result()
        self._server = ActionServer(
            node,
            RotateAbsolute,
            f"{name}/rotate_absolute",
            self._execute,
            handle_accepted_callback=self._accept,
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def destroy(self) -> None:
        """End the server, and the goal with it."""
        self.abort()
        self._server.destroy()

    def abort(self, why: str = "") -> None:
        """Abort the goal, if there is one, and warn of it."""
        if self._goal is None:
            return
        if why:
            self._logger.warning(why)
        self._goal.abort()
        self._end()

    def cancel_if_asked(self) -> None:
        """Cancel the goal, and let the turtle stand, if a client has asked for that."""
        if self._goal is not None and self._goal.is_cancel_requested:
            self._logger.info("Rotation goal canceled")
            self._goal.canceled()
            self._turtle.stop()
            self._end()

    def report(self, turn: Turn) -> None:
        """Send the state of the turn as feedback, and the result once the heading is reached."""
        if self._goal is None:
            return
        self._result.delta = turn.delta
        self._goal.publish_feedback(RotateAbsolute.Feedback(remaining=turn.remaining))
        if turn.is_reached:
            self._logger.info("Rotation goal completed successfully")
            self._goal.succeed()
            self._end()

    def _accept(self, goal: ServerGoalHandle) -> None:
        self.abort("Rotation goal received before a previous goal finished. Aborting previous goal")
        self._goal, self._ended, self._result = goal, Future(), RotateAbsolute.Result()
        self._turtle.turn_to(goal.request.theta)
        ended = self._ended
        goal.execute(lambda goal: _awaited(ended))

    async def _execute(self, goal: ServerGoalHandle) -> Any:
        raise NotImplementedError("each goal is executed by a function of its own")

    def _end(self) -> None:
        self._goal = None
        self._ended.set_result(self._result)


async def _awaited(ended: Future[Any]) -> Any:
    return await ended
