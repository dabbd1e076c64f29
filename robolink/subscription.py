"""Subscriptions: the receiving end of a topic."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Callable
from enum import Enum
from types import CoroutineType
from typing import TYPE_CHECKING, Any, Generic, TypedDict, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.event_handler import (
    QoSLivelinessChangedInfo,
    QoSRequestedDeadlineMissedInfo,
    QoSSubscriptionEventType,
    SubscriptionEventCallbacks,
    expect,
    tell_handlers,
    warns_of_types,
)
from robolink.exceptions import DecodeError, OverwrittenError, RCLError, TransportError, WireError
from robolink.graph.endpoint import Endpoint, Owner
from robolink.graph.humble import Copies, CopyError, FromHumbleKey
from robolink.graph.liveliness import deadline_ns, lease_ns, watch_publishers
from robolink.logging import get_logger
from robolink.message import Message, decoder, message_type
from robolink.qos import QoSProfile
from robolink.running.backlog import Backlog, Gaps, Sequence
from robolink.running.entity import ANY_TIME, SUBSCRIPTION, Receiver
from robolink.running.execution import takes_arguments
from robolink.running.expectations import Deadline, Liveliness
from robolink.running.inbox import Inbox
from robolink.running.ready_queue import HELD, reserve
from robolink.system.terminal import shown
from robolink.text.callbacks import signature_of
from robolink.transport.base import Handle, Sample
from robolink.transport.history import ALL, stored_depth
from robolink.wire import EndpointKind, check_attachment, gid_in, is_attachment, unpack_attachment

if TYPE_CHECKING:
    from robolink.running.ports import Loop
    from robolink.subscription_content_filter_options import ContentFilterOptions

MsgT = TypeVar("MsgT", bound=Message)
MsgType = TypeVar("MsgType")  # a name that programs import from here

_LOST = {QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST}


_REFUSED = (CopyError, DecodeError, OverwrittenError, TransportError, WireError)
"""Errors of what arrives and cannot be opened."""


class MessageInfo(TypedDict):
    """Metadata of a message that was received.

    Args:
        source_timestamp: Time at which it was published, in nanoseconds since the epoch.
        received_timestamp: Time at which its callback was called, in nanoseconds since the epoch.
        publication_sequence_number: Number of the message, in the order of its publisher's.
        reception_sequence_number: None: this network has no such number.
        publisher_gid: Global id of the publisher: `implementation_identifier`, and 16 bytes of `data`.
    """

    source_timestamp: int
    received_timestamp: int
    publication_sequence_number: int | None
    reception_sequence_number: int | None
    publisher_gid: dict[str, str | bytes] | None


class Subscription(Receiver, Generic[MsgT]):
    """Receives messages of one type from one topic; made by `Node.create_subscription`.

    Args:
        owner: Node that it belongs to, as the graph knows it.
        msg_type: Message class of the topic.
        topic: Fully qualified name of the topic.
        callback: Function, or coroutine function, of the message, or of the message and its MessageInfo.
        callback_group: Group of the callback.
        qos_profile: Quality of service.
        raw: True calls back with the serialized message (bytes).
        event_callbacks: Callbacks for events; None only warns of publishers with another type.
    """

    rank = SUBSCRIPTION

    class CallbackType(Enum):
        """Arguments that the callback takes: the message alone, or with its MessageInfo."""

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
        depth = stored_depth(qos_profile)
        self._inbox, prepare = owner.context.inbox, self._look_over if depth == ALL else None
        super().__init__(self._inbox, depth, callback_group, prepare, owner.context.transport.threaded)
        self.msg_type = msg_type
        self.topic = self._topic_name = topic
        self.qos_profile = qos_profile
        self.raw = raw
        self.malformed = 0
        """Number of messages that could not be decoded."""
        self._overwritten, self._has_warned = 0, False
        self.on_loss: Callable[[Any], object] | None = None
        """Function of the executor's ready queue, if there is one; called for each message that is lost."""
        self.callback = callback
        self._decode: Callable[[bytes], Any] = bytes if raw else decoder(message_type(msg_type))
        self._endpoint = Endpoint(owner, EndpointKind.SUBSCRIPTION, topic, msg_type, qos_profile)
        transport = self._endpoint.transport
        self._read: Callable[[Any], Sample] = transport.read
        self._read_arrived = self._read
        callbacks = event_callbacks or SubscriptionEventCallbacks()
        self._sequence: Sequence | None = None
        # One without ROS 2's attachment is refused, as rmw_zenoh does: what works here works with a real robot.
        self._check: Callable[[bytes], object] = check_attachment
        if depth and (transport.threaded or callbacks.message_lost):  # others lose nothing on the way
            self._sequence = Sequence(self._make_gaps(), self.mailbox, self._on_gap)
            # As they are taken; rmw_zenoh counts at arrival and misses what gives way in the mailbox.
            self._check = self._sequence.check
        self._open: Callable[[Any], Any] | None = transport.opener(self._check, self._decode)
        """Function that turns what arrived into a message, the short way; None where `_read` does more."""
        self._humble_receiver: _HumbleReceiver | None = None
        self._handles: list[Handle] = []
        self._backlog: Backlog | None = None
        if depth == ALL:
            self._backlog = Backlog(topic, self._make_gaps(), owner.context.time.steady)
            self._open = self._open_stored
        self._listen_for_events(callbacks)
        self._notes: tuple[Callable[[Any], object], ...] = self._expect(owner.context.time.steady)
        self._endpoint.speak_humble = self._speak_humble
        for key in filter(None, (self._endpoint.key, self._endpoint.buffer_key)):
            self._handles.append(self._endpoint.transport.subscribe(key, qos_profile, self._noting(self.sink)))
        self._endpoint.announce()

    @property
    def callback(self) -> Callable[..., Any]:
        """Function that is called with each message, or with the message and its MessageInfo."""
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., Any]) -> None:
        self._callback_type = self.CallbackType.MessageOnly
        if not takes_arguments(callback, 1):
            if not takes_arguments(callback, 2):
                how = signature_of(callback, ("message",))
                name, advice = (callback.__name__, f": {how}") if how else (str(callback), "")
                raise RuntimeError(
                    f"{self.topic_name}: a callback takes the message, or the message and its MessageInfo;"
                    f" {shown(name)} takes neither one argument nor two{advice}"
                )
            self._callback_type = self.CallbackType.WithMessageInfo
        self._callback = callback
        self._with_info = self._callback_type is self.CallbackType.WithMessageInfo

    def _look_over(self, arrived: Any) -> Sample | FromHumbleKey | None:
        """Return the item that KEEP_ALL stores: plain bytes, since a sample of Zenoh's holds all of its batch.

        None for a message that was overwritten in shared memory.
        """
        backlog = self._backlog
        assert backlog is not None
        if type(arrived) is not FromHumbleKey:
            try:
                arrived = self._read_arrived(arrived)
            except OverwrittenError as error:
                self._check_order(backlog, error.attachment)
                self.lose(backlog.warnings.append)
                return None
        found: Sample | FromHumbleKey = arrived
        self._check_order(backlog, found.attachment)
        return found

    def _check_order(self, backlog: Backlog, attachment: bytes) -> None:
        try:  # this is run once a message: `contextlib.suppress` is three calls
            missing = backlog.add(attachment, self.mailbox.waiting)
        except WireError:  # told when it is taken
            return
        if missing > 0:
            self._on_gap(missing)

    def _on_gap(self, missing: int) -> None:
        tell_handlers(self.event_handlers, _LOST, total=missing)
        self._tell_loss()

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this executor; the node tells others what was dropped while there was none."""
        super().attach(executor, has_turn)
        if self.dropped:
            self._tell_loss()

    def overflowed(self) -> None:
        """Let the node tell others of the loss."""
        self._tell_loss()

    def _tell_loss(self) -> None:
        if self.on_loss is not None:
            self.on_loss(self._queue_)

    def lose(self, warn: Callable[[str], object] | None) -> None:
        """Count a message that was overwritten in shared memory; call `warn`, if there is one, about the first."""
        with self._parking.lock:  # callbacks of a reentrant group lose side by side
            self._overwritten += 1
        tell_handlers(self.event_handlers, _LOST, total=1)
        self._tell_loss()
        if warn is not None and not self._has_warned:
            self._has_warned = True
            warn(
                f"{self.topic_name}: dropped a message: {OverwrittenError()}"
                " (the next ones are only counted, in `Subscription.lost`)"
            )

    def turn(self) -> Any:
        """Take the oldest of what waits and execute it, as `Entity.turn` does, with the usual way written out."""
        waiting, opened = self.mailbox.waiting, self._open
        if len(waiting) != 1 or opened is None or self._with_info or not self.straight:
            return super().turn()
        group = self.gate
        acquire = group._acquire_
        if not (acquire(False) if acquire else reserve(group, self)):
            return HELD
        self.mailbox.listed = False
        outcome = None
        try:
            try:
                message = opened(waiting.popleft())
            except _REFUSED as error:
                self._drop(error)
                return None
            callback = self._callback  # for Python 3.11 a function in an attribute, no method
            outcome = callback(message)
        finally:
            if outcome is None or not isinstance(outcome, CoroutineType):
                release = group._release_
                if release:
                    release()
                else:
                    group.ending_execution(self)
        return outcome

    def execute(self, taken: Any) -> Any:
        """Decode what arrived and call the callback; what cannot be decoded is counted, and warned about once."""
        if self._backlog is not None and self._backlog.warnings:
            with contextlib.suppress(IndexError):  # another thread of a reentrant group was faster
                get_logger(self.logger_name).warning(self._backlog.warnings.popleft())
        try:
            if (opened := self._open) is not None and not self._with_info:
                message, info = opened(taken), None
            else:
                message, info = self._open_with_info(taken)
        except _REFUSED as error:
            self._drop(error)
            return None
        callback = self._callback  # for Python 3.11 a function in an attribute, no method
        return callback(message) if info is None else callback(message, info)

    def _drop(self, error: Exception) -> None:
        """Count what arrived and cannot be opened, and warn about the first; copies are expected."""
        if isinstance(error, OverwrittenError):
            with contextlib.suppress(WireError):  # unknown, then
                self._check(error.attachment)
            self.lose(get_logger(self.logger_name).warning)
        elif not isinstance(error, CopyError):
            self._refuse(error)

    def _open_stored(self, stored: Sample) -> Any:
        """Return the message of what `_look_over` has read."""
        payload, attachment = stored
        check_attachment(attachment)
        return self._decode(payload)

    def _open_with_info(self, taken: Any) -> tuple[Any, MessageInfo | None]:
        payload, attachment = self._read(taken)
        self._check(attachment)
        return self._decode(payload), self._info(attachment) if self._with_info else None

    def _info(self, attachment: bytes) -> MessageInfo:
        sender = unpack_attachment(attachment)
        return MessageInfo(
            source_timestamp=sender.timestamp,
            received_timestamp=self._endpoint.context.time.now(),
            publication_sequence_number=sender.sequence,
            reception_sequence_number=None,
            publisher_gid={"implementation_identifier": "rmw_zenoh_cpp", "data": sender.gid},
        )

    def _refuse(self, error: Exception) -> None:
        self.malformed += 1
        if self.malformed == 1:
            ros = (
                "whose attachment is not ROS 2's"
                if isinstance(error, WireError)
                else f"that is not a {self._endpoint.type_name}"
            )
            get_logger(self.logger_name).warning(
                f"{self.topic_name}: dropped a message {ros}: {error} (the next ones are only counted)"
            )

    @property
    def gid(self) -> bytes:
        """Global id of the subscription, 16 bytes, as in `robolink topic info -v`."""
        return self._endpoint.gid

    @property
    def dropped(self) -> int:
        """Number of messages that were dropped for newer ones before they were taken, since the depth was reached."""
        return self.mailbox.dropped

    @property
    def lost(self) -> int:
        """Number of messages that did not arrive.

        By gaps in the publishers' numbers, without what was `dropped`, and with what was overwritten in shared memory.
        """
        return self._overwritten + sum(each.lost for each in (self._backlog, self._sequence) if each is not None)

    def get_publisher_count(self) -> int:
        """Return the number of publishers of this topic and type."""
        self._check_(f"subscription of {self.topic}")
        return self._endpoint.count_others()

    # Events

    def _listen_for_events(self, callbacks: SubscriptionEventCallbacks) -> None:
        group = None if self.callback_group is ANY_TIME else self.callback_group
        self.event_handlers = callbacks.create_event_handlers(group, self, self.topic_name)
        self._endpoint.warns = warns_of_types(callbacks)
        self._endpoint.on_disagreement = self._on_disagreement
        self._endpoint.on_other = self._on_other

    def _on_other(self, came: bool) -> None:
        matched = {QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED}
        tell_handlers(self.event_handlers, matched, total=int(came), current=1 if came else -1)

    def _on_disagreement(self) -> None:
        tell_handlers(self.event_handlers, {QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE}, total=1)

    def _expect(self, steady: Callable[[], int]) -> tuple[Callable[[Any], object], ...]:
        """Watch deadline and liveliness, where there are callbacks for them.

        Returns:
            Functions that note what arrives.
        """
        kind, qos, transport = QoSSubscriptionEventType, self.qos_profile, self._endpoint.transport
        deadline, lease = deadline_ns(qos), lease_ns(qos)
        notes: list[Callable[[Any], object]] = []
        if deadline is not None:
            expected = Deadline(deadline, QoSRequestedDeadlineMissedInfo)
            if expect(self.event_handlers, kind.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED, expected, steady):
                notes.append(lambda arrived: expected.note(steady()))
        if lease is not None:
            liveliness = Liveliness(lease, QoSLivelinessChangedInfo)
            if expect(self.event_handlers, kind.RCL_SUBSCRIPTION_LIVELINESS_CHANGED, liveliness, steady):
                self._handles.append(watch_publishers(self._endpoint, liveliness, steady))
                notes.append(lambda arrived: liveliness.note(gid_in(transport.attachment(arrived)), steady()))
        return tuple(notes)

    def _noting(self, sink: Callable[[Any], object]) -> Callable[[Any], object]:
        """Return a sink that notes what arrives, where that is of use, as it arrives: a program may be busy then."""
        if not self._notes:
            return sink  # C from end to end
        notes = self._notes

        def note_and_sink(arrived: Any) -> None:
            for note in notes:
                note(arrived)
            sink(arrived)

        return note_and_sink

    def _make_gaps(self) -> Gaps:
        """Look for gaps of all senders, or of those that send to one key alone, where some may send to several."""
        return Gaps(self._sends_to_one_key) if self._endpoint.buffer_key else Gaps()

    def _sends_to_one_key(self, gid: bytes) -> bool:
        sender = self._endpoint.context.graph.endpoint_of(gid)
        return sender is not None and not sender.names_backends

    # Humble peers

    def _speak_humble(self, key: str) -> None:
        """Receive from Humble's key too from now on; what comes to both keys is taken once."""
        read, copies = self._read, Copies(self._endpoint.context.graph.endpoint_of)

        def read_once(taken: Any) -> Sample:
            sample = taken.sample if type(taken) is FromHumbleKey else read(taken)
            if is_attachment(sample.attachment):
                copies.check(sample.attachment)
            return sample

        self._read, self._open = read_once, None
        with self._parking.lock:  # held, too, where `redirect` is called
            self._humble_receiver = _HumbleReceiver(self, self._inbox, copies)
        sink = self._noting(self._humble_receiver.sink)
        self._handles.append(self._endpoint.transport.subscribe(key, self.qos_profile, sink))
        if self._destroyed:  # meanwhile
            self._close()

    def redirect(self, inbox: Inbox) -> None:
        """Redirect what comes from now on to this inbox."""
        super().redirect(inbox)
        self._inbox = inbox
        if self._humble_receiver is not None:
            inbox.take_over(self._humble_receiver.sink)

    @property
    def topic_name(self) -> str:
        """Fully qualified name of the topic."""
        return self._topic_name

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        return self._endpoint.logger_name

    @property
    def is_cft_enabled(self) -> bool:
        """False: content filters have no effect on this network, as with rmw_zenoh."""
        return False

    def set_content_filter(self, filter_expression: str, expression_parameters: list[str]) -> None:
        """Raise RCLError, as with rmw_zenoh: filters have no effect on this network.

        Args:
            filter_expression: Expression over the message's fields.
            expression_parameters: Texts that replace the parameters of the expression.
        """
        raise RCLError(f"{self.topic_name}: this network has no content filters: look at each message in the callback")

    def get_content_filter(self) -> ContentFilterOptions:
        """Raise RCLError, as with rmw_zenoh: filters have no effect on this network."""
        raise RCLError(f"{self.topic_name}: this network has no content filters")

    def warn_of_filter(self, filter_expression: str) -> None:
        """Log that the filter `filter_expression`, which the program gave, has no effect."""
        logger = get_logger(self.logger_name)
        logger.warning(f"{self.topic_name}: the content filter '{filter_expression}' has no effect on this network")

    def destroy(self) -> None:
        """End the subscription, and undeclare it. Safe to call twice."""
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


class _HumbleReceiver:
    """Target of the samples that arrive on Humble's key for a subscription."""

    straight = False

    def __init__(self, subscription: Subscription[Any], inbox: Inbox, copies: Copies) -> None:
        self._subscription, self._copies = subscription, copies
        self._read = subscription._endpoint.transport.read
        self.sink: functools.partial[Any] = inbox.sink(self)

    def deliver(self, arrived: Any) -> None:
        """Pass a sample on, but no copy: copies would drive other messages out of the mailbox."""
        try:
            sample = self._read(arrived)
        except OverwrittenError:
            self._subscription.lose(None)  # a lock is held here, under which nothing is logged
            return
        if not self._copies.comes_twice(sample.attachment):
            self._subscription.deliver(FromHumbleKey(sample))
