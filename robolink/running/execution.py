"""Exceptions that end an executor's waiting, and the logger of an entity's node."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from robolink.exceptions import RobolinkError
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.logging import get_logger
from robolink.running.entity import Entity


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
