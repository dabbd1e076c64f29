"""Pace of a loop in a coroutine: one timer that wakes it each period."""

from __future__ import annotations

from robolink.callback_groups import CallbackGroup
from robolink.node import Node
from robolink.task import Future


class Pace:
    """A timer of `period` seconds in a group in which nothing waits for the loop.

    A loop that takes longer than a period goes on at once, and catches nothing up.
    """

    def __init__(self, node: Node, period: float, group: CallbackGroup) -> None:
        self._node = node
        self._waiting: Future[None] | None = None
        self._is_due = False
        self._timer = node.create_timer(period, self._wake, callback_group=group)

    def _wake(self) -> None:
        waiting, self._waiting = self._waiting, None
        if waiting is None:
            self._is_due = True
        elif not waiting.over():
            waiting.set_result(None)

    async def next(self) -> None:
        """Wait for the end of the period."""
        if self._is_due:
            self._is_due = False
            return
        self._waiting = waiting = Future[None]()
        await waiting

    def destroy(self) -> None:
        """End the timer."""
        self._node.destroy_timer(self._timer)
