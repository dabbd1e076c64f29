"""Subscriptions."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import Any, Generic, TypedDict, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.endpoint import Endpoint, Owner
from robolink.entity import Receiver
from robolink.exceptions import DecodeError, TransportError, WireError
from robolink.logging import get_logger
from robolink.message import Message, decoder, message_type
from robolink.qos import HistoryPolicy, QoSProfile, resolved
from robolink.wire import EndpointKind, unpack_attachment

MsgT = TypeVar("MsgT", bound=Message)


def takes_arguments(function: Callable[..., Any], count: int) -> bool:
    """Whether it can be called with `count` arguments; with any number when it does not tell."""
    import inspect

    try:
        inspect.signature(function).bind(*[None] * count)
    except TypeError:
        return False
    except ValueError:
        return True
    return True


class MessageInfo(TypedDict):
    """What is known about a message beside its content; times in nanoseconds since the epoch."""

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None


class Subscription(Receiver, Generic[MsgT]):
    """Receives messages of one type from one topic; made by `Node.create_subscription`."""

    straight = True

    class CallbackType(Enum):
        """What the callback takes."""

        MessageOnly = 0
        WithMessageInfo = 1

    def __init__(
        self,
        owner: Owner,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        callback_group: CallbackGroup,
        qos_profile: QoSProfile,
        raw: bool = False,
    ) -> None:
        depth = 0 if qos_profile.history is HistoryPolicy.KEEP_ALL else resolved(qos_profile).depth
        super().__init__(owner.context.inbox, depth, callback_group)
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self.raw = raw
        self.malformed = 0
        """How many payloads could not be decoded."""
        self.callback = callback
        self._decode: Callable[[bytes], Any] = bytes if raw else decoder(message_type(msg_type))
        self._endpoint = Endpoint(owner, EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile)
        self._read = self._endpoint.transport.read
        self._handle = self._endpoint.transport.subscribe(self._endpoint.key, qos_profile, self.sink)
        self._endpoint.announce()

    @property
    def callback(self) -> Callable[..., Any]:
        """What is called with each message, or with the message and its MessageInfo."""
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any]) -> None:
        self._callback_type = self.CallbackType.MessageOnly
        if not takes_arguments(callback, 1):
            if not takes_arguments(callback, 2):
                raise RuntimeError(
                    "Subscription.__init__(): callback should be either be callable with one argument"
                    " (to get only the message) or two (to get message and message info)"
                )
            self._callback_type = self.CallbackType.WithMessageInfo
        self._callback = callback
        self._with_info = self._callback_type is self.CallbackType.WithMessageInfo

    def execute(self, taken: Any) -> Any:
        """Decode what arrived and call the callback; what cannot be decoded is counted, and warned about once."""
        try:
            payload, attachment = self._read(taken)
            message = self._decode(payload)
            info = self._info(attachment) if self._with_info else None
        except (DecodeError, WireError, TransportError) as error:
            self._refuse(error)
            return None
        return self._callback(message) if info is None else self._callback(message, info)

    def _info(self, attachment: bytes) -> MessageInfo:
        sender = unpack_attachment(attachment)
        return MessageInfo(
            source_timestamp=sender.timestamp,
            received_timestamp=self._endpoint.context.time.now(),
            publication_sequence_number=sender.sequence,
            reception_sequence_number=None,
        )

    def _refuse(self, error: Exception) -> None:
        self.malformed += 1
        if self.malformed == 1:
            get_logger(self.logger_name).warning(
                f"{self.topic}: dropped a message that is no {self._endpoint.type_name}: {error}"
                " (the next ones are only counted)"
            )

    @property
    def dropped(self) -> int:
        """How many messages gave way to newer ones before they were taken."""
        return self.mailbox.dropped

    def get_publisher_count(self) -> int:
        """How many publishers of this topic and type there are."""
        found = self._endpoint.context.graph.endpoints(EndpointKind.PUBLISHER, name=self.topic)
        return sum(each.type_name == self._endpoint.type_name for each in found)

    @property
    def topic_name(self) -> str:
        """The topic's fully qualified name."""
        return self.topic

    @property
    def logger_name(self) -> str:
        """The name of the logger that belongs to the node."""
        return self._endpoint.logger_name

    def destroy(self) -> None:
        """Undeclare it. Safe to call twice."""
        self._handle.close()
        self._endpoint.close()
        self.detach()
        self.mailbox.waiting.clear()

    def __enter__(self) -> Subscription[MsgT]:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()
