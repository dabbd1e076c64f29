"""What an executor runs a task by: on from one await to the next, whenever what the task awaits has come."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.entity import NOTHING, Entity
from robolink.task import Task

if TYPE_CHECKING:
    from robolink.executors import Executor


class TaskRunner(Entity):
    """Runs one task in an executor, again and again until it is done.

    When the task is what `origin`'s callback has returned, that one's group is busy until then.
    """

    def __init__(self, task: Task[Any], executor: Executor, origin: Entity | None = None) -> None:
        super().__init__()
        self.task, self.executor, self._origin = task, executor, origin
        self.serves = origin is not None and origin.serves

    @property
    def origin(self) -> Entity:
        """The entity whose callback is executed."""
        return self._origin or self

    def take(self) -> Any:
        """Give the task."""
        return NOTHING if self.task.done() or self.task.cancelled() else self.task

    def execute(self, taken: Task[Any]) -> None:
        """Run it on. Raises what it raised."""
        taken()
        if not (taken.done() or taken.cancelled()):
            self._sleep(taken)
            return
        if self._origin is not None:
            self._origin.gate.ending_execution(self._origin)
        error = taken.exception()
        if error is not None:
            raise error

    def _sleep(self, task: Task[Any]) -> None:
        executor, awaited = self.executor, task.awaits
        if executor is None:
            return
        if awaited is None:
            executor.poll(self)
        else:
            awaited.when_done(lambda: executor.post(self))
