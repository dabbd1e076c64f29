"""Execution of callbacks and tasks: their arguments, their logger, and the exceptions that end a wait."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from robolink.exceptions import RobolinkError
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.logging import get_logger
from robolink.running.entity import NOTHING, Entity
from robolink.task import Task

if TYPE_CHECKING:
    from robolink.running.ports import Loop


class TimeoutException(RobolinkError):  # noqa: N818 - rclpy's name
    """Nothing became ready in time."""


class ShutdownException(RobolinkError):  # noqa: N818 - rclpy's name
    """Nothing more will become ready here: the executor has ended."""


class ConditionReachedException(RobolinkError):  # noqa: N818 - rclpy's name
    """The condition of a wait is met."""


class TimeoutObject:
    """Timeout in seconds that may change while somebody waits."""

    def __init__(self, timeout: float) -> None:
        self.timeout = timeout


async def await_or_execute(callback: Callable[..., Any], *args: Any) -> Any:
    """Call a function, or call and await a coroutine function."""
    return await callback(*args) if inspect.iscoroutinefunction(callback) else callback(*args)


def logger_of(entity: Entity) -> RcutilsLogger:
    """Return the logger of the node that an entity belongs to, or robolink's."""
    owner = entity.origin.node
    return get_logger("robolink") if owner is None else owner.get_logger()


class TaskRunner(Entity):
    """Runs one task in an executor, again and again until it is done.

    When the task is what `origin`'s callback has returned, that one's group is busy until then, if it `holds_group`.
    """

    def __init__(
        self, task: Task[Any], executor: Loop, origin: Entity | None = None, *, holds_group: bool = True
    ) -> None:
        super().__init__()
        self.task, self._origin, self._holds_group = task, origin, holds_group
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
        if self._origin is not None and self._holds_group:
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


def takes_arguments(function: Callable[..., Any], count: int) -> bool:
    """True if `function` can be called with `count` arguments, or does not tell."""
    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:
        return True
    return True
