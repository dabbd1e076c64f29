"""What an executor runs a task by: on from one await to the next, whenever what the task awaits has come."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from robolink.entity import NOTHING, Entity
from robolink.task import Task


class TaskRunner(Entity):
    """Runs one task, again and again until it is done."""

    def __init__(self, task: Task[Any], on_end: Callable[[], None] | None = None) -> None:
        super().__init__()
        self.task = task
        self.on_end = on_end

    def take(self) -> Any:
        """Give the task."""
        return NOTHING if self.task.done() or self.task.cancelled() else self.task

    def execute(self, taken: Task[Any]) -> None:
        """Run it on. Raises what it raised."""
        taken()
        if not (taken.done() or taken.cancelled()):
            self._sleep(taken)
            return
        if self.on_end is not None:
            self.on_end()
        if taken.exception() is not None:
            raise taken.exception() or RuntimeError

    def _sleep(self, task: Task[Any]) -> None:
        executor = self.executor
        if executor is None:
            return
        if task.awaits is None:
            executor.poll(self)
        else:
            task.awaits.when_done(lambda: executor.post(self))
