"""launch_testing: launch files that are tests, run by `pytest FILE` with robolink's plugin, or by `launch_test FILE`.

These are the names that such a file imports; `robolink.testing` starts its processes and runs its test classes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from robolink.launch.ros.launch_testing import declarations as actions
from robolink.launch.ros.launch_testing import declarations as event_handlers
from robolink.launch.ros.launch_testing import declarations as legacy
from robolink.launch.ros.launch_testing import declarations as markers
from robolink.launch.ros.launch_testing import handlers as asserts
from robolink.launch.ros.launch_testing import handlers as util
from robolink.launch.ros.launch_testing import tools
from robolink.launch.ros.launch_testing.declarations import parametrize
from robolink.launch.ros.launch_testing.handlers import (
    ActiveIoHandler,
    ActiveProcInfoHandler,
    IoHandler,
    ProcInfoHandler,
)

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "IoHandler",
    "ProcInfoHandler",
    "actions",
    "asserts",
    "event_handlers",
    "legacy",
    "markers",
    "parametrize",
    "post_shutdown_test",
    "tools",
    "util",
]


T = TypeVar("T", bound=type)


def post_shutdown_test() -> Callable[[T], T]:
    """Return a decorator by which a class of tests runs after the processes have ended."""

    def decorate(cls: T) -> T:
        cls.__post_shutdown_test__ = True  # type: ignore[attr-defined]
        return cls

    return decorate
