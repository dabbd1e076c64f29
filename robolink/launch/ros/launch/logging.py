"""Loggers of launch files (`launch.logging`): robolink's own."""

from __future__ import annotations

from robolink.logging import get_logger

__all__ = [
    "get_logger",
]
