"""Experimental parts of rclpy: the EventsExecutor, and nodes that run on asyncio's event loop.

Each name is imported when it is first used, so that a program without asyncio does not wait for it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from robolink.text.suggestions import lazily

if TYPE_CHECKING:
    from robolink.experimental.async_client import AsyncClient
    from robolink.experimental.async_clock import AsyncClock
    from robolink.experimental.async_node import AsyncNode
    from robolink.experimental.async_publisher import AsyncPublisher
    from robolink.experimental.async_service import AsyncService
    from robolink.experimental.async_subscription import AsyncSubscription
    from robolink.experimental.async_timer import AsyncTimer
    from robolink.experimental.events_executor import EventsExecutor

_HOMES = {
    "AsyncClient": "async_client",
    "AsyncClock": "async_clock",
    "AsyncNode": "async_node",
    "AsyncPublisher": "async_publisher",
    "AsyncService": "async_service",
    "AsyncSubscription": "async_subscription",
    "AsyncTimer": "async_timer",
    "EventsExecutor": "events_executor",
}
"""Each name and the module that it lives in."""

__all__ = [
    "AsyncClient",
    "AsyncClock",
    "AsyncNode",
    "AsyncPublisher",
    "AsyncService",
    "AsyncSubscription",
    "AsyncTimer",
    "EventsExecutor",
]

__getattr__, __dir__ = lazily(__name__, _HOMES, ())
