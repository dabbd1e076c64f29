"""Experimental parts of rclpy, under its names."""

from __future__ import annotations

from robolink.experimental.events_executor import EventsExecutor

__all__ = ["EventsExecutor"]
