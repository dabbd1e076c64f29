"""Exceptions that end an executor's waiting, and the log line of a callback that has failed."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any

from robolink.exceptions import InvalidHandle, RobolinkError
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.logging import get_logger
from robolink.running.entity import Entity
from robolink.text.tracebacks import formatted

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike


ENDS_THE_SPINNING = "an exception in a callback ends the spinning"
"""Beginning of the line that is logged for a callback that failed; its traceback follows."""


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


def log_failure(entity: Entity, error: Exception, context: ContextLike) -> None:
    """Log a callback's exception, with its traceback, in the name of its node; once, however often it passes."""
    if getattr(error, "__robolink_logged__", False):
        return
    if isinstance(error, InvalidHandle) and not context.ok():
        return  # another thread has ended the context meanwhile
    error.__robolink_logged__ = True  # type: ignore[attr-defined]
    text = formatted(error, _of_the_user(error.__traceback__))
    logger_of(entity).error(f"{ENDS_THE_SPINNING}:\n{text}")


def logger_of(entity: Entity) -> RcutilsLogger:
    """Return the logger of the node that an entity belongs to, or robolink's."""
    owner = entity.origin.node
    return get_logger("robolink") if owner is None else owner.get_logger()


def _of_the_user(trace: TracebackType | None) -> TracebackType | None:
    """Leave out robolink's own frames at the top of a traceback."""
    first = trace
    while first is not None and first.tb_frame.f_globals.get("__name__", "").startswith("robolink."):
        first = first.tb_next
    return first or trace
