"""ROS 2 nodes from `pip install`: rclpy's API over Eclipse Zenoh.

    import robolink as rclpy

Everything is imported when it is first used, so that ``import robolink`` costs next to nothing.
"""

from __future__ import annotations

import atexit
import importlib
import sys
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from types import FrameType

    from robolink.clock import Clock
    from robolink.context import Context
    from robolink.control.pid import Pid
    from robolink.duration import Duration
    from robolink.exceptions import ExternalShutdownException, RobolinkError
    from robolink.message import Message
    from robolink.node import Node
    from robolink.parameter import Parameter
    from robolink.qos import QoSProfile
    from robolink.running.timebase import VirtualTime
    from robolink.signals import SignalHandlerOptions, install_signal_handlers, uninstall_signal_handlers
    from robolink.spinning import (
        InitContextManager,
        create_node,
        get_global_executor,
        init,
        shutdown,
        spin,
        spin_once,
        spin_until_future_complete,
        try_shutdown,
    )
    from robolink.task import Future
    from robolink.time import Time
    from robolink.utilities import get_default_context, get_rmw_implementation_identifier, ok

_HOMES = {
    "Clock": "clock",
    "Context": "context",
    "Duration": "duration",
    "ExternalShutdownException": "exceptions",
    "Future": "task",
    "InitContextManager": "spinning",
    "Message": "message",
    "Node": "node",
    "Parameter": "parameter",
    "Pid": "control.pid",
    "QoSProfile": "qos",
    "RobolinkError": "exceptions",
    "SignalHandlerOptions": "signals",
    "Time": "time",
    "VirtualTime": "running.timebase",
    "create_node": "spinning",
    "get_default_context": "utilities",
    "get_global_executor": "spinning",
    "get_rmw_implementation_identifier": "utilities",
    "init": "spinning",
    "install_signal_handlers": "signals",
    "ok": "utilities",
    "shutdown": "spinning",
    "spin": "spinning",
    "spin_once": "spinning",
    "spin_until_future_complete": "spinning",
    "try_shutdown": "spinning",
    "uninstall_signal_handlers": "signals",
}
"""Each public name and the module that it lives in."""

_ROOMS = frozenset(
    [
        "action",
        "callback_groups",
        "client",
        "clock",
        "clock_type",
        "constants",
        "context",
        "duration",
        "exceptions",
        "executors",
        "expand_topic_name",
        "guard_condition",
        "impl",
        "lifecycle",
        "logging",
        "logging_service",
        "node",
        "parameter",
        "parameter_client",
        "parameter_event_handler",
        "parameter_service",
        "publisher",
        "qos",
        "qos_overriding_options",
        "serialization",
        "service",
        "service_introspection",
        "signals",
        "subscription",
        "task",
        "tf2",
        "time",
        "time_source",
        "timer",
        "topic_or_service_is_hidden",
        "type_support",
        "utilities",
        "validate_full_topic_name",
        "validate_namespace",
        "validate_node_name",
        "validate_parameter_name",
        "validate_topic_name",
        "wait_for_message",
        "waitable",
    ]
)
"""Modules that a bare ``import robolink as rclpy`` gives as attributes: programs rely on ``rclpy.qos`` and the like."""

__all__ = [
    "Clock",
    "Context",
    "Duration",
    "ExternalShutdownException",
    "Future",
    "InitContextManager",
    "Message",
    "Node",
    "Parameter",
    "Pid",
    "QoSProfile",
    "RobolinkError",
    "SignalHandlerOptions",
    "Time",
    "VirtualTime",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "install_signal_handlers",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]


_NOT_RCLPYS = frozenset(["Clock", "Duration", "ExternalShutdownException", "Message", "Node", "Time"])
"""Names that a program which calls this rclpy has to import from a module on a robot."""


def _warn_of_home(name: str, frame: FrameType | None) -> None:
    """Warn a program that calls this rclpy, not robolink: what works here raises on a robot."""
    while frame is not None and frame.f_globals.get("__name__") == "importlib._bootstrap":
        frame = frame.f_back  # `from rclpy import Node`
    if frame is None or sys.modules.get("rclpy") is not sys.modules[__name__]:
        return
    names = frame.f_code.co_names
    is_robolinks = "robolink" in names and "rclpy" not in names
    if is_robolinks or frame.f_globals.get("__name__", "").partition(".")[0] == "robolink":
        return
    import warnings

    home = {"ExternalShutdownException": "executors"}.get(name, _HOMES[name])
    warnings.warn(f"ROS 2 has no rclpy.{name}: write `from rclpy.{home} import {name}`", stacklevel=3)


def __getattr__(name: str) -> Any:
    if name in _NOT_RCLPYS:
        _warn_of_home(name, sys._getframe(1))
    if name in _HOMES:
        value = getattr(importlib.import_module(f"robolink.{_HOMES[name]}"), name)
    elif name in _ROOMS:
        value = importlib.import_module(f"robolink.{name}")
    elif name == "__version__":
        from importlib.metadata import version

        value = version("robolink")
    else:
        from robolink.exceptions import imported_as
        from robolink.text.suggestions import lacking

        raise lacking(imported_as(), name, lambda: [*__all__, *_ROOMS], sys._getframe(1))
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_ROOMS})


def _close_sessions() -> None:
    lifetime = sys.modules.get("robolink.transport.lifetime")
    if lifetime is not None:
        lifetime.close_all()


# At this import, so that what a program does at its exit (it stops the robot) comes before. Python has waited for the
# program's threads then, which may go on for long, and has not yet ended daemon threads. Twice, since a Ctrl-C may
# break into the very beginning of the first.
atexit.register(_close_sessions)
atexit.register(_close_sessions)
