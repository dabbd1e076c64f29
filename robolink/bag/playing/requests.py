"""Calls of services whose requests a bag has recorded, as events of their introspection."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from robolink.bag.selection import service_of
from robolink.bag.topic import BagTopic
from robolink.client import Client
from robolink.exceptions import DecodeError, RobolinkError
from robolink.interfaces import find
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.message import decode
from robolink.node import Node

SOURCES = {
    "service_introspection": ServiceEventInfo.REQUEST_RECEIVED,
    "client_introspection": ServiceEventInfo.REQUEST_SENT,
}
"""Kind of the events whose requests are sent, by rosbag2's name of their source."""


class _Called(NamedTuple):
    client: Client
    event: type[Any]


class Requests:
    """Clients of a node for the services whose events bags have. Nobody waits for the responses.

    Args:
        node: Node that calls; somebody has to spin it.
        topics: Topics of bags; those that are no events of services are left alone.
        source: Which events count, a key of SOURCES.
        warn: Called with one line for each service that cannot be called, and once for each that is not there.
    """

    def __init__(self, node: Node, topics: Iterable[BagTopic], source: str, warn: Callable[[str], object]) -> None:
        self._kind, self._warn = SOURCES[source], warn
        self._called: dict[str, _Called] = {}
        self._missing: set[str] = set()
        for topic in topics:
            if topic.is_service_event:
                try:
                    kind = find(topic.type_name.removesuffix("_Event"), "srv")
                    client = node.create_client(kind, service_of(topic.name))
                    self._called[topic.name] = _Called(client, kind.Event)
                except RobolinkError as error:
                    warn(f"service '{service_of(topic.name)}' is not called: {error}")

    def send(self, topic: str, data: bytes | memoryview) -> None:
        """Call the service if this event has a request of the wanted kind; without the service, warn."""
        called = self._called.get(topic)
        if called is None:
            return
        try:
            event = decode(called.event, bytes(data))
        except DecodeError as error:
            self._warn(f"service '{service_of(topic)}': an event cannot be read: {error}")
            return
        if event.info.event_type != self._kind or not event.request:
            return
        if called.client.service_is_ready():
            called.client.call_async(event.request[0])
        elif topic not in self._missing:
            self._missing.add(topic)
            self._warn(f"service '{service_of(topic)}' is not there: its requests are left out")

    def destroy(self) -> None:
        """End the clients."""
        for each in self._called.values():
            each.client.destroy()
