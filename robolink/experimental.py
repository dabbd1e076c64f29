"""Experimental executors of rclpy, under its names."""

from __future__ import annotations

from robolink.executors import SingleThreadedExecutor


class EventsExecutor(SingleThreadedExecutor):
    """Executor that runs callbacks in one thread as their events come: robolink's SingleThreadedExecutor does so."""


__all__ = ["EventsExecutor"]
