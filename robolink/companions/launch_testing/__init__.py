"""launch_testing: launch files that are tests, run by `pytest FILE` with robolink's plugin, or by `launch_test FILE`.

These are the names that such a file imports; `robolink.testing` starts its processes and runs its test classes.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from robolink.companions.launch_testing import actions, asserts, event_handlers, legacy, markers, tools, util
from robolink.companions.launch_testing.io_handler import ActiveIoHandler, IoHandler
from robolink.companions.launch_testing.parametrize import parametrize
from robolink.companions.launch_testing.proc_info_handler import ActiveProcInfoHandler, ProcInfoHandler

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
