"""`rclpy_implementation`: what programs take from rclpy's C library, as far as it exists here under another name.

There is no C library. The errors, enums and functions below are robolink's own; for the rest, the handles of nodes,
wait sets and the like, there is nothing that could stand in, and asking for them says so.
"""

from __future__ import annotations

import importlib
from typing import Any

from robolink.exceptions import nearest

HOMES = {
    "ClockChange": "clock:ClockChange",
    "ClockType": "clock_type:ClockType",
    "InvalidHandle": "exceptions:InvalidHandle",
    "NodeNameNonExistentError": "exceptions:NodeNameNonExistentError",
    "RCLError": "exceptions:RobolinkError",
    "RCLInvalidROSArgsError": "arguments.command_line:InvalidROSArgsError",
    "RMWError": "exceptions:RobolinkError",
    "SignalHandlerOptions": "signals:SignalHandlerOptions",
    "TransitionCallbackReturnType": "lifecycle:TransitionCallbackReturn",
    "UnknownROSArgsError": "arguments.command_line:UnknownROSArgsError",
    "UnsupportedEventTypeError": "event_handler:UnsupportedEventTypeError",
    "get_current_signal_handlers_options": "signals:get_current_signal_handlers_options",
    "install_signal_handlers": "signals:install_signal_handlers",
    "rclpy_deserialize": "serialization:deserialize_message",
    "rclpy_get_rmw_implementation_identifier": "utilities:get_rmw_implementation_identifier",
    "rclpy_logging_get_logger_effective_level": "logging:get_logger_effective_level",
    "rclpy_logging_get_logger_level": "logging:get_logger_level",
    "rclpy_logging_get_logging_directory": "logging:get_logging_directory",
    "rclpy_logging_initialize": "logging:initialize",
    "rclpy_logging_set_logger_level": "logging:set_logger_level",
    "rclpy_logging_severity_level_from_string": "logging:get_logging_severity_from_string",
    "rclpy_logging_shutdown": "logging:shutdown",
    "rclpy_qos_check_compatible": "qos:qos_check_compatible",
    "rclpy_remove_ros_args": "utilities:remove_ros_args",
    "service_introspection": "service_introspection",
    "uninstall_signal_handlers": "signals:uninstall_signal_handlers",
}
"""Names of the C library, each with the module and attribute that stands for it."""

HANDLES = ("Client", "Context", "GuardCondition", "Node", "Publisher", "Service", "Subscription", "Timer", "WaitSet")
"""Classes of the C library that wrap rcl's; a Node's create_... methods make their counterparts."""


class _Implementation:
    """Stand-in for the C library: its attributes are those of `HOMES`. All others raise AttributeError, and say why."""

    def __getattr__(self, name: str) -> Any:
        home = HOMES.get(name)
        if home is None:
            hint = "; a Node and an Executor do what it is for" if name in HANDLES else nearest(name, HOMES)
            raise AttributeError(f"robolink has no C library, and nothing that stands for its '{name}'{hint}")
        # By name, when it is asked for: these modules are above this one.
        module, _, attribute = home.partition(":")
        found = importlib.import_module(f"robolink.{module}")
        return getattr(found, attribute) if attribute else found

    def __dir__(self) -> list[str]:
        return sorted(HOMES)

    def rclpy_serialize(self, message: Any, message_type: type[Any]) -> bytes:
        """Return a message of this type as CDR bytes. Raises TypeError for one of another type."""
        if not isinstance(message, message_type):
            raise TypeError(f"expected a {message_type!r}, got {message!r:.80}")
        made: bytes = importlib.import_module("robolink.serialization").serialize_message(message)
        return made


rclpy_implementation = _Implementation()
