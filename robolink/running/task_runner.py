"""Entity that drives a Task in an executor: it resumes the coroutine each time the awaited Future completes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from robolink.running.entity import NOTHING, Entity
from robolink.task import Task

if TYPE_CHECKING:
    from robolink.running.ports import Loop


class TaskRunner(Entity):
    """Runs one task in an executor, again and again until it is done.

    When the task is what `origin`'s callback has returned, that one's group is busy until then.
    """

    def __init__(self, task: Task[Any], executor: Loop, origin: Entity | None = None) -> None:
        super().__init__()
        self.task, self._origin = task, origin
        self.executor, self._queue_ = executor, executor._queue_
        self.serves = origin is not None and origin.serves

    @property
    def origin(self) -> Entity:
        """The entity whose callback is executed."""
        return self._origin or self

    def take(self) -> Any:
        """Return the task."""
        return NOTHING if self.task.done() or self.task.cancelled() else self.task

    def execute(self, taken: Task[Any]) -> None:
        """Resume the task. Raises what it raised."""
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
        queue, awaited = self._queue_, task.awaits
        if queue is None:
            return
        if awaited is None:
            queue.postpone(self)
        else:
            awaited.when_done(lambda: queue.post(self))
