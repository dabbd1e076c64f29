"""Subscriptions."""

from __future__ import annotations

import contextlib
import functools
import threading
from collections.abc import Callable
from enum import Enum
from typing import Any, Generic, TypedDict, TypeVar

from robolink.backlog import Backlog, Gaps
from robolink.callback_groups import CallbackGroup
from robolink.endpoint import Endpoint, Owner
from robolink.entity import ANY_TIME, Receiver
from robolink.event_handler import (
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
    tell_handlers,
    warns_of_types,
)
from robolink.exceptions import DecodeError, TransportError, WireError, shown
from robolink.humble import Copies, CopyError, FromHumbleKey
from robolink.inbox import Inbox
from robolink.logging import get_logger
from robolink.message import Message, decoder, message_type
from robolink.qos import HistoryPolicy, QoSProfile, resolved
from robolink.transport.base import Handle, Sample
from robolink.wire import ATTACHMENT_BYTES, EndpointKind, unpack_attachment

MsgT = TypeVar("MsgT", bound=Message)

_LOST = {QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST}


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
        event_callbacks: SubscriptionEventCallbacks | None = None,
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
        self._read: Callable[[Any], Sample] = self._endpoint.transport.read
        self._humble_door: _HumbleDoor | None = None
        self._inbox = owner.context.inbox
        self._handles: list[Handle] = []
        self._backlog: Backlog | None = None
        if depth == 0:
            self._backlog, self.straight = Backlog(topic, self._make_gaps(), owner.context.time.steady), False
        self._listen_for_events(event_callbacks or SubscriptionEventCallbacks())
        self._endpoint.speak_humble = self._speak_humble
        for key in filter(None, (self._endpoint.key, self._endpoint.buffer_key)):
            self._handles.append(self._endpoint.transport.subscribe(key, qos_profile, self.sink))
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
                    f"{self.topic}: a callback takes the message, or the message and its MessageInfo;"
                    f" {shown(str(callback))} takes neither one argument nor two"
                )
            self._callback_type = self.CallbackType.WithMessageInfo
        self._callback = callback
        self._with_info = self._callback_type is self.CallbackType.WithMessageInfo

    def deliver(self, arrived: Any) -> None:
        """Keep what arrived; with KEEP_ALL as plain bytes, since one that came from Zenoh holds all of its batch."""
        if self._backlog is not None:
            if type(arrived) is not FromHumbleKey:
                arrived = self._endpoint.transport.read(arrived)
            with contextlib.suppress(WireError):  # told when it is taken
                missing = self._backlog.add(arrived.attachment, self.mailbox.waiting)
                if missing > 0:
                    tell_handlers(self.event_handlers, _LOST, total=missing)
        super().deliver(arrived)

    def execute(self, taken: Any) -> Any:
        """Decode what arrived and call the callback; what cannot be decoded is counted, and warned about once."""
        if self._backlog is not None and self._backlog.warnings:
            with contextlib.suppress(IndexError):  # another thread of a reentrant group was faster
                get_logger(self.logger_name).warning(self._backlog.warnings.popleft())
        try:
            payload, attachment = self._read(taken)
            if len(attachment) != ATTACHMENT_BYTES or attachment[16] != 16:
                unpack_attachment(attachment)  # it says what is wrong
            message = self._decode(payload)
            info = self._info(attachment) if self._with_info else None
        except CopyError:
            return None
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
            ros = (
                "whose attachment is not ROS 2's"
                if isinstance(error, WireError)
                else f"that is no {self._endpoint.type_name}"
            )
            get_logger(self.logger_name).warning(
                f"{self.topic}: dropped a message {ros}: {error} (the next ones are only counted)"
            )

    @property
    def dropped(self) -> int:
        """How many messages gave way to newer ones before they were taken."""
        return self.mailbox.dropped

    @property
    def lost(self) -> int:
        """How many messages did not arrive; counted for KEEP_ALL alone."""
        return self._backlog.lost if self._backlog is not None else 0

    def get_publisher_count(self) -> int:
        """How many publishers of this topic and type there are."""
        return self._endpoint.count_others()

    # Events

    def _listen_for_events(self, callbacks: SubscriptionEventCallbacks) -> None:
        group = None if self.callback_group is ANY_TIME else self.callback_group
        self.event_handlers = callbacks.create_event_handlers(group, self, self.topic)
        self._endpoint.warns = warns_of_types(callbacks)
        self._endpoint.on_disagreement = self._on_disagreement
        self._endpoint.on_other = self._on_other
        if callbacks.message_lost and self._backlog is None:
            self._count_lost()

    def _on_other(self, came: bool) -> None:
        matched = {QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED}
        tell_handlers(self.event_handlers, matched, total=int(came), current=1 if came else -1)

    def _on_disagreement(self) -> None:
        tell_handlers(self.event_handlers, {QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE}, total=1)

    def _make_gaps(self) -> Gaps:
        """Look for gaps of all senders, or of those that send to one key alone, where some may send to several."""
        return Gaps(self._sends_to_one_key) if self._endpoint.buffer_key else Gaps()

    def _sends_to_one_key(self, gid: bytes) -> bool:
        sender = self._endpoint.context.graph.endpoint_of(gid)
        return sender is not None and not sender.names_backends

    def _count_lost(self) -> None:
        """Look for gaps between the numbers of the messages that are taken."""
        read, gaps = self._read, self._make_gaps()
        lock = threading.Lock()  # callbacks of a reentrant group run side by side

        def read_and_count(taken: Any) -> Sample:
            sample = read(taken)
            with lock:
                missing = gaps.before(unpack_attachment(sample.attachment))
            if missing > 0:
                tell_handlers(self.event_handlers, _LOST, total=missing)
            return sample

        self._read = read_and_count

    # Humble peers

    def _speak_humble(self, key: str) -> None:
        """Receive from Humble's key too from now on; what comes to both keys is taken once."""
        read, copies = self._read, Copies(self._endpoint.context.graph.endpoint_of)

        def read_once(taken: Any) -> Sample:
            sample = taken.sample if type(taken) is FromHumbleKey else read(taken)
            if len(sample.attachment) == ATTACHMENT_BYTES:
                copies.check(sample.attachment)
            return sample

        self._read = read_once
        with self._parking.lock:  # held, too, where `redirect` is called
            self._humble_door = _HumbleDoor(self, self._inbox, copies)
        self._handles.append(self._endpoint.transport.subscribe(key, self.qos_profile, self._humble_door.sink))
        if self._destroyed:  # meanwhile
            self._close()

    def redirect(self, inbox: Inbox) -> None:
        """Have what comes from now on arrive in this inbox."""
        super().redirect(inbox)
        self._inbox = inbox
        if self._humble_door is not None:
            inbox.take_over(self._humble_door.sink)

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
        self._destroyed = True
        self._close()
        for handler in self.event_handlers:
            handler.destroy()
        self.detach()
        self.mailbox.waiting.clear()

    def _close(self) -> None:
        for handle in self._handles:
            handle.close()
        self._endpoint.close()

    def __enter__(self) -> Subscription[MsgT]:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()


class _HumbleDoor:
    """Where samples of Humble's key arrive for a subscription."""

    straight = False

    def __init__(self, subscription: Subscription[Any], inbox: Inbox, copies: Copies) -> None:
        self._subscription, self._copies = subscription, copies
        self._read = subscription._endpoint.transport.read
        self.sink: functools.partial[Any] = inbox.sink(self)

    def deliver(self, arrived: Any) -> None:
        """Hand it on, but no copies: they would drive other messages out of the mailbox."""
        sample = self._read(arrived)
        if not self._copies.comes_twice(sample.attachment):
            self._subscription.deliver(FromHumbleKey(sample))
