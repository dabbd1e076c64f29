"""Guard conditions: events that any thread triggers, and whose callback an executor runs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.running.entity import GUARD_CONDITION, NOTHING, Entity

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.running.ports import Loop


class GuardCondition(Entity):
    """Event whose callback runs once after it was triggered, however often; see `Node.create_guard_condition`.

    Args:
        callback: Function, or coroutine function, without arguments; None for an event that only wakes the executor.
        callback_group: Group of the callback; None is none, so that it may run at any time.
        context: Context, as in rclpy; that of its executor counts.
    """

    rank = GUARD_CONDITION

    def __init__(
        self,
        callback: Callable[[], Any] | None,
        callback_group: CallbackGroup | None,
        context: Context | None = None,
    ) -> None:
        super().__init__(callback_group)
        self.callback = callback
        self._triggered = False

    def trigger(self) -> None:
        """Trigger the callback, from any thread. Raises InvalidHandle after `destroy`."""
        if self._destroyed:
            raise self._gone_("the guard condition")
        self._triggered = True
        queue = self._queue_  # another thread may take it away meanwhile
        if queue is not None:
            queue.post(self)

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this executor; an earlier trigger counts."""
        super().attach(executor, has_turn)
        if self._triggered and not has_turn:
            executor._queue_.post(self)

    def take(self) -> Any:
        """Return True, once, if the condition was triggered; else NOTHING."""
        triggered, self._triggered = self._triggered, False
        return True if triggered else NOTHING

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        return self.callback() if self.callback is not None else None

    def destroy(self) -> None:
        """End the guard condition: its callback is not called any more."""
        self._destroyed = True
        self.detach()
