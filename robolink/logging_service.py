"""Services by which others read and set the levels of a process's loggers."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeAlias

from robolink import logging
from robolink.impl.logging_severity import LoggingSeverity
from robolink.interfaces.rcl_interfaces.msg import LoggerLevel, SetLoggerLevelsResult
from robolink.node_parts.request_limit import Refusal, look_at, no_room
from robolink.qos import qos_profile_services_default

if TYPE_CHECKING:
    from robolink.interfaces.rcl_interfaces import srv
    from robolink.node_parts.ports import ServingNode

    Get: TypeAlias = srv.GetLoggerLevels
    Set: TypeAlias = srv.SetLoggerLevels

NO_LEVEL = "Failed reason: Invalid logger level."
"""rclpy's own words: its tests compare them."""


class LoggingService:
    """Server of `~/get_logger_levels` and `~/set_logger_levels` of `node`, for all loggers of the process.

    A logger that has no level of its own is UNSET, also where there is none of that name.
    """

    def __init__(self, node: ServingNode) -> None:
        from robolink.interfaces.rcl_interfaces import srv  # late: few nodes serve this

        services: list[tuple[str, type[Any], Callable[[Any, Any], Any], Refusal]] = [
            ("get_logger_levels", srv.GetLoggerLevels, self._get, no_room),
            ("set_logger_levels", srv.SetLoggerLevels, self._set, lambda reason: {"results": [_refused(reason)]}),
        ]
        for name, srv_type, answer, refusal in services:
            service = node.create_service(srv_type, f"~/{name}", answer, qos_profile=qos_profile_services_default)
            service.look_first = functools.partial(look_at, srv_type, refusal)

    def _get(self, request: Get.Request, response: Get.Response) -> Get.Response:
        response.levels = [LoggerLevel(name=name, level=logging.get_logger_level(name)) for name in request.names]
        return response

    def _set(self, request: Set.Request, response: Set.Response) -> Set.Response:
        response.results = [_set_level(each) for each in request.levels]
        return response


def _refused(reason: str) -> SetLoggerLevelsResult:
    return SetLoggerLevelsResult(successful=False, reason=reason)


def _set_level(expected: LoggerLevel) -> SetLoggerLevelsResult:
    if expected.level not in LoggingSeverity.__members__.values():
        return _refused(NO_LEVEL)
    logging.set_logger_level(expected.name, expected.level, detailed_error=True)
    return SetLoggerLevelsResult(successful=True)
