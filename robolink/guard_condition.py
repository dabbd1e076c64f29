"""Guard conditions: let any thread have a callback run by the executor."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.callback_groups import CallbackGroup
from robolink.entity import NOTHING, Entity

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.executors import Executor


class GuardCondition(Entity):
    """Runs its callback once after it was triggered, however often."""

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
        """Have the callback called. From any thread."""
        if self._destroyed:
            raise self._gone_("the guard condition")
        self._triggered = True
        executor = self.executor  # another thread may take it away meanwhile
        if executor is not None:
            executor.post(self)

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Belong to this executor; an earlier trigger counts."""
        super().attach(executor, queued)
        if self._triggered and not queued:
            executor.post(self)

    def take(self) -> Any:
        """Be called, if triggered."""
        triggered, self._triggered = self._triggered, False
        return True if triggered else NOTHING

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        return self.callback() if self.callback is not None else None

    def destroy(self) -> None:
        """Call no more."""
        self._destroyed = True
        self.detach()
