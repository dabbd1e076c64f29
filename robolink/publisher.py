"""Publishers."""

from __future__ import annotations

from typing import Any, Generic, TypeVar

from robolink.duration import Duration
from robolink.endpoint import Endpoint, Owner
from robolink.exceptions import InvalidHandle
from robolink.message import Message, encoder, message_type
from robolink.qos import QoSProfile
from robolink.wire import EndpointKind

MsgT = TypeVar("MsgT", bound=Message)


class Publisher(Generic[MsgT]):
    """Publishes messages of one type on one topic; made by `Node.create_publisher`."""

    def __init__(self, owner: Owner, msg_type: type[MsgT], topic: str, qos_profile: QoSProfile) -> None:
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self._encode = encoder(message_type(msg_type))
        self._endpoint = Endpoint(owner, EndpointKind.PUBLISHER, topic, msg_type, qos_profile)
        self._outlet = self._endpoint.transport.advertise(self._endpoint.key, qos_profile)
        self._put, self._attachment = self._outlet.put, self._endpoint.attachment
        self._endpoint.announce()
        self._destroyed = False

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message, or one that is serialized already, to all subscriptions.

        Raises EncodeError (a TypeError and ValueError) that names the field which does not fit, TypeError for a
        message of another type, InvalidHandle after `destroy`.
        """
        if type(msg) is self.msg_type:
            payload = self._encode(msg)
        elif isinstance(msg, (bytes, bytearray)):
            payload = bytes(msg)
        else:
            raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
        if self._destroyed:
            raise InvalidHandle(f"the publisher of {self.topic} has been destroyed")
        self._put(payload, self._attachment())

    def get_subscription_count(self) -> int:
        """How many subscriptions of this topic and type there are."""
        graph = self._endpoint.context.graph
        found = graph.endpoints(EndpointKind.SUBSCRIPTION, name=self.topic)
        return sum(each.type_name == self._endpoint.type_name for each in found)

    @property
    def topic_name(self) -> str:
        """The topic's fully qualified name."""
        return self.topic

    @property
    def logger_name(self) -> str:
        """The name of the logger that belongs to the node."""
        return self._endpoint.logger_name

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Say that everything has been sent: there are no acknowledgements on this wire, as in rmw_zenoh."""
        return True

    def assert_liveliness(self) -> None:
        """Do nothing: the process's liveliness token says that it is alive."""

    def destroy(self) -> None:
        """Undeclare it. Safe to call twice."""
        if not self._destroyed:
            self._destroyed = True
            self._outlet.close()
            self._endpoint.close()

    def __enter__(self) -> Publisher[MsgT]:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()
