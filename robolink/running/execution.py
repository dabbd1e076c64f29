"""Execution of callbacks and tasks: their arguments, their logger, and the exceptions that end a wait."""

from __future__ import annotations

from collections.abc import Callable
from types import FunctionType, MethodType
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
    import inspect  # late: it takes a node's start 5 ms

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
    plain, own = (function.__func__, 1) if isinstance(function, MethodType) else (function, 0)
    if isinstance(plain, FunctionType) and _tells_all(plain, own):
        return _has_parameters(plain, count + own)  # most callbacks: nothing is imported for them
    import inspect

    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:
        return True
    return True


_VARARGS = 4
"""Flag of the code of a function with `*args`, `inspect.CO_VARARGS`."""


def _tells_all(function: FunctionType, bound: int) -> bool:
    """True if the signature of a function is that of its code, and it takes what is bound to it."""
    is_its_own = not vars(function).keys() & {"__wrapped__", "__signature__"}
    return is_its_own and (not bound or bool(function.__code__.co_argcount or function.__code__.co_flags & _VARARGS))


def _has_parameters(function: FunctionType, count: int) -> bool:
    """True if a `def` or `lambda` can be called with `count` arguments by position."""
    code, defaults = function.__code__, function.__defaults__ or ()
    by_name = code.co_varnames[code.co_argcount : code.co_argcount + code.co_kwonlyargcount]
    if not set(by_name) <= (function.__kwdefaults__ or {}).keys():
        return False
    has_room = count <= code.co_argcount or bool(code.co_flags & _VARARGS)
    return has_room and count >= code.co_argcount - len(defaults)
