"""Service introspection: what a service and its clients say to each other, told on SERVICE/_service_event."""

from __future__ import annotations

import contextlib
from enum import IntEnum

from robolink.clock import Clock
from robolink.endpoint import Endpoint
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


def introspect(
    now: Introspection | None,
    endpoint: Endpoint,
    srv_type: type[Service],
    clock: Clock,
    qos: QoSProfile,
    state: ServiceIntrospectionState,
) -> Introspection | None:
    """Give what is to tell of a service or client from now on, None for OFF; `now` is what has told until now.

    The quality of service is that of the first call, as in rcl. Raises TypeError for what is no state.
    """
    if not isinstance(state, ServiceIntrospectionState):
        raise TypeError(f"introspection_state: expected a ServiceIntrospectionState, got {state!r}")
    if state is ServiceIntrospectionState.OFF:
        if now is not None:
            now.close()
        return None
    told = now or Introspection(endpoint, srv_type, clock, qos)
    told.clock, told.contents = clock, state is ServiceIntrospectionState.CONTENTS
    return told
