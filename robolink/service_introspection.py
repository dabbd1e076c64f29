"""Service introspection: what a service and its clients say to each other, told on SERVICE/_service_event by either."""

from __future__ import annotations

import contextlib
from enum import IntEnum

from robolink.clock import Clock
from robolink.endpoint import Endpoint
from robolink.entity import Receiver
from robolink.exceptions import InvalidHandle
from robolink.interfaces.service_msgs.msg import ServiceEventInfo
from robolink.message import Message, Service
from robolink.publisher import Publisher
from robolink.qos import QoSProfile

SUFFIX = "/_service_event"
"""What follows a service's name in that of the topic on which its events are."""

REQUESTS = (ServiceEventInfo.REQUEST_SENT, ServiceEventInfo.REQUEST_RECEIVED)


class ServiceIntrospectionState(IntEnum):
    """How much is told: nothing, who asked whom and when, or also what was said; the numbers are rcl's."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class Introspection:
    """Tells of what one service or client sends and receives."""

    def __init__(self, endpoint: Endpoint, srv_type: type[Service], clock: Clock, qos: QoSProfile) -> None:
        self.clock = clock
        self.contents = False
        """Whether requests and responses are told, too."""
        self._event = srv_type.Event
        self._publisher = Publisher(endpoint.owner, self._event, endpoint.name + SUFFIX, qos)

    def tell(self, event_type: int, message: Message, sequence_number: int, client_gid: bytes) -> None:
        """Publish that a request or response of a client's call went out or came in."""
        info = ServiceEventInfo(
            event_type=event_type,
            stamp=self.clock.now().to_msg(),
            client_gid=client_gid,
            sequence_number=sequence_number,
        )
        part = "request" if event_type in REQUESTS else "response"
        event = self._event(info=info, **({part: [message]} if self.contents else {}))
        with contextlib.suppress(InvalidHandle):  # a coroutine may answer when its service is gone
            self._publisher.publish(event)

    def close(self) -> None:
        """Tell nothing more."""
        self._publisher.destroy()


class ServiceEnd(Receiver):
    """What a service and a client are alike in: a service's type and name, and that they can tell what is said."""

    srv_type: type[Service]
    srv_name: str
    _endpoint: Endpoint

    introspection: Introspection | None = None
    """Tells of requests and responses, once `configure_introspection` has been asked for it."""

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Publish on SERVICE/_service_event, from now on, what is asked and what is answered; nothing for OFF.

        `clock` gives the stamps. The quality of service is that of the first call, as in rcl. Raises TypeError for
        what is no state.
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
    def service_name(self) -> str:
        """The service's fully qualified name."""
        return self.srv_name

    @property
    def logger_name(self) -> str:
        """The name of the logger that belongs to the node."""
        return self._endpoint.logger_name
