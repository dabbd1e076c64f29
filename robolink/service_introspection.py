"""Service introspection: the requests and responses of a service, published as events on SERVICE/_service_event."""

from __future__ import annotations

import contextlib
from enum import IntEnum
from typing import Any, cast

from robolink.clock import Clock
from robolink.context import Context
from robolink.exceptions import InvalidHandle
from robolink.graph.endpoint import Endpoint
from robolink.message import Message, Service
from robolink.publisher import Publisher
from robolink.qos import QoSProfile
from robolink.running.entity import Receiver
from robolink.type_support import in_brackets

SUFFIX = "/_service_event"
"""Suffix of a service's name in that of the topic of its events."""

REQUEST_SENT, REQUEST_RECEIVED, RESPONSE_SENT, RESPONSE_RECEIVED = range(4)
"""Kinds of events: the constants of ServiceEventInfo, a type that is made when somebody turns introspection on."""


class ServiceIntrospectionState(IntEnum):
    """Level of introspection: off, caller and time alone, or also the contents; the numbers are rcl's."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class Introspection:
    """Publisher of the events of one service or client.

    Args:
        endpoint: Service or client, as the graph knows it.
        srv_type: Service class.
        clock: Clock of the events' stamps.
        qos: Quality of service of the events.
    """

    def __init__(self, endpoint: Endpoint, srv_type: type[Service], clock: Clock, qos: QoSProfile) -> None:
        from robolink.interfaces.service_msgs.msg import ServiceEventInfo

        self.clock, self._info = clock, ServiceEventInfo
        self.contents = False
        """True if events contain requests and responses, too."""
        self._event = srv_type.Event
        self._publisher = Publisher(endpoint.owner, self._event, endpoint.name + SUFFIX, qos)

    def tell(self, event_type: int, message: Message, sequence_number: int, client_gid: bytes) -> None:
        """Publish that a request or response went out or came in.

        Args:
            event_type: Kind of the event, a constant of ServiceEventInfo.
            message: Request or response.
            sequence_number: Number of the call, in the order of its client's.
            client_gid: Global id of the client, 16 bytes.
        """
        info = self._info(
            event_type=event_type,
            stamp=self.clock.now().to_msg(),
            client_gid=client_gid,
            sequence_number=sequence_number,
        )
        part = "request" if event_type in (REQUEST_SENT, REQUEST_RECEIVED) else "response"
        event = self._event(info=info, **({part: [message]} if self.contents else {}))
        with contextlib.suppress(InvalidHandle):  # a coroutine may answer when its service is gone
            self._publisher.publish(event)

    def close(self) -> None:
        """End the events."""
        self._publisher.destroy()


class ServiceEnd(Receiver):
    """Base of services and clients: a service's type and name, and introspection."""

    __class_getitem__ = in_brackets(2)

    srv_type: type[Service]
    srv_name: str
    _service_name: str
    _endpoint: Endpoint

    introspection: Introspection | None = None
    """Publisher of events, from `configure_introspection` on."""

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish requests and responses as events on SERVICE/_service_event from now on, or no more.

        Args:
            clock: Clock of the events' stamps.
            service_event_qos_profile: Quality of service of the events; that of the first call holds, as in rcl.
            introspection_state: OFF, METADATA or CONTENTS.

        Raises:
            TypeError: if `introspection_state` is not a ServiceIntrospectionState.
        """
        if not isinstance(introspection_state, ServiceIntrospectionState):
            raise TypeError(f"introspection_state: expected a ServiceIntrospectionState, got {introspection_state!r}")
        now = self.introspection
        if introspection_state is not ServiceIntrospectionState.OFF:
            now = now or Introspection(self._endpoint, self.srv_type, clock, service_event_qos_profile)
            now.clock, now.contents = clock, introspection_state is ServiceIntrospectionState.CONTENTS
            self.introspection = now
        elif now is not None:
            self.introspection = None
            now.close()

    @property
    def context(self) -> Context:
        """Context of the node."""
        context: Context = cast("Any", self._endpoint.context)  # an endpoint knows a part of it
        return context

    @property
    def service_name(self) -> str:
        """Fully qualified name of the service."""
        return self._service_name

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        return self._endpoint.logger_name
