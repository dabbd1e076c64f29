"""launch_testing: launch files that are tests, and what runs them.

`pytest FILE` runs such a file with robolink's plugin, `launch_test FILE` with the runner here.
"""

from __future__ import annotations

from robolink.launch.ros.launch_testing import (
    actions,
    asserts,
    event_handlers,
    legacy,
    loader,
    markers,
    test_runner,
    tools,
    util,
)
from robolink.launch.ros.launch_testing.io_handler import ActiveIoHandler, IoHandler
from robolink.launch.ros.launch_testing.markers import parametrize, post_shutdown_test, ready_to_test_action_timeout
from robolink.launch.ros.launch_testing.proc_info_handler import ActiveProcInfoHandler, ProcInfoHandler
from robolink.launch.ros.launch_testing.ready_aggregator import ReadyAggregator

__all__ = [
    "ActiveIoHandler",
    "ActiveProcInfoHandler",
    "IoHandler",
    "ProcInfoHandler",
    "ReadyAggregator",
    "actions",
    "asserts",
    "event_handlers",
    "legacy",
    "loader",
    "markers",
    "parametrize",
    "post_shutdown_test",
    "ready_to_test_action_timeout",
    "test_runner",
    "tools",
    "util",
]
