"""Types of topics and services with their schemas, looked up on threads of their own: a node may have to be asked."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any

from robolink.bag.topic import message_definition
from robolink.context import Context
from robolink.exceptions import RobolinkError
from robolink.interfaces.geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Twist, TwistStamped
from robolink.message import Service
from robolink.system import clocks
from robolink.type_lookup import type_of
from robolink.view.channels import Shown
from robolink.wire import EndpointToken

THREADS = 4
"""Number of look-ups at once; one may take 4.5 s where nodes do not answer."""

PATIENCE = 10.0
"""Time in seconds after which a look-up that failed is tried again."""

PUBLISHED = (Twist, TwistStamped, PoseStamped, PoseWithCovarianceStamped)
"""Types that the page publishes, also where nobody else does."""

Halves = tuple[Shown, ...]
"""Schemas of a message (one), or of a service (request, response)."""


def published() -> dict[str, str]:
    """Return the definitions (ros2msg) of what the page publishes, by the names of the types."""
    return {each.__ros_type__: message_definition(each) for each in PUBLISHED}


class Types:
    """Classes and schemas by type name and hash, remembered.

    Args:
        context: Context whose network is asked for types that are not installed.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._threads = ThreadPoolExecutor(THREADS, thread_name_prefix="robolink view types")
        self._shown: dict[tuple[str, str], Halves | str] = {}
        self._classes: dict[tuple[str, str], type[Any]] = {}
        self._failed: dict[tuple[str, str], float] = {}
        self._waiting: dict[tuple[str, str], list[Callable[[], object]]] = {}

    def get(self, end: EndpointToken) -> Halves | str | None:
        """Return the schemas of an endpoint's type, or why there are none; None if it was not looked up yet."""
        key = (end.type_name, end.type_hash)
        now = clocks.monotonic()
        if now - self._failed.get(key, now) >= PATIENCE:
            return None
        return self._shown.get(key)

    def class_of(self, end: EndpointToken) -> type[Any] | None:
        """Return the class of an endpoint's type, None if it is not known yet."""
        return self._classes.get((end.type_name, end.type_hash))

    def named(self, type_name: str) -> type[Any] | None:
        """Return a class of this name that was looked up, None if there is none."""
        return next((each for (name, _), each in self._classes.items() if name == type_name), None)

    def look_up(self, end: EndpointToken, loop: asyncio.AbstractEventLoop, then: Callable[[], object]) -> None:
        """Look a type up, and call `then` on the loop; those who ask meanwhile are called too."""
        key = (end.type_name, end.type_hash)
        if key in self._waiting:
            self._waiting[key].append(then)
            return
        self._waiting[key] = [then]
        found = self._threads.submit(self._find, end)
        found.add_done_callback(lambda done: _safely(loop, self._note, key, done))

    def _find(self, end: EndpointToken) -> tuple[type[Any], Halves]:
        cls = type_of(self._context, end)
        halves = (cls.Request, cls.Response) if issubclass(cls, Service) else (cls,)
        return cls, tuple(Shown(each.__ros_type__, message_definition(each)) for each in halves)

    def _note(self, key: tuple[str, str], done: Future[tuple[type[Any], Halves]]) -> None:
        error = done.exception() if not done.cancelled() else RobolinkError("ended")
        if error is None:
            self._classes[key], self._shown[key] = done.result()
            self._failed.pop(key, None)
        else:
            self._shown[key] = str(error) if isinstance(error, RobolinkError) else f"{key[0]}: {error!r}"
            self._failed[key] = clocks.monotonic()
        for then in self._waiting.pop(key):
            then()

    def close(self) -> None:
        """Look nothing up any more."""
        self._threads.shutdown(wait=False, cancel_futures=True)


def _safely(loop: asyncio.AbstractEventLoop, function: Callable[..., object], *arguments: Any) -> None:
    try:
        loop.call_soon_threadsafe(function, *arguments)
    except RuntimeError:  # the loop has ended
        return
