"""Publishers: the sending end of a topic."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.duration import Duration
from robolink.event_handler import (
    PublisherEventCallbacks,
    QoSLivelinessLostInfo,
    QoSOfferedDeadlineMissedInfo,
    QoSPublisherEventType,
    expect,
    tell_handlers,
    warns_of_types,
)
from robolink.graph.endpoint import Endpoint, Owner
from robolink.graph.liveliness import assertions, deadline_ns, is_manual, lease_ns
from robolink.message import Message, buffers_encoder, encoder, message_type
from robolink.qos import DurabilityPolicy, QoSProfile
from robolink.running.destroyable import Destroyable
from robolink.running.expectations import Deadline, Lease
from robolink.system.waits import fork_lock
from robolink.transport.history import Latch, latched_depth
from robolink.transport.pieces import LARGE, Pieces
from robolink.wire import NO_HASH, EndpointKind

if TYPE_CHECKING:
    from robolink.running.ports import ContextLike

MsgT = TypeVar("MsgT", bound=Message)
MsgType = TypeVar("MsgType")  # a name that programs import from here
_FOR_EVER = Duration(seconds=-1)


class Publisher(Destroyable, Generic[MsgT]):
    """Sends messages of one type on one topic; made by `Node.create_publisher`.

    Args:
        owner: Node that it belongs to, as the graph knows it.
        msg_type: Message class of the topic.
        topic: Fully qualified name of the topic.
        qos_profile: Quality of service.
        event_callbacks: Callbacks for events; None only warns of subscriptions with another type.
        callback_group: Group of the event callbacks; None is none, so that they may run at any time.
    """

    def __init__(
        self,
        owner: Owner,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile,
        event_callbacks: PublisherEventCallbacks | None = None,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.msg_type = msg_type
        self.topic = self._topic_name = topic
        self.qos_profile = qos_profile
        self._destroyed = False  # in the instance, where Python 3.11 finds it in a tenth of the time
        self._encode: Callable[[Any], Any] = encoder(message_type(msg_type))
        self._endpoint = Endpoint(owner, EndpointKind.PUBLISHER, topic, msg_type, qos_profile)
        callbacks = event_callbacks or PublisherEventCallbacks()
        self.event_handlers = callbacks.create_event_handlers(callback_group, self, topic)
        self._outlets = _Outlets(self._endpoint, qos_profile)
        self._put, self._attachment = self._outlets.put, self._endpoint.attachment
        self._put_numbered = self._outlets.put_numbered
        self._outlets.when_shared(_weakly(self._encode_in_pieces))
        self._tell_alive = assertions(self._endpoint) if is_manual(qos_profile) else None
        self._lease: Lease | None = None
        self._expect(owner.context.time.steady)
        self._send = self._outlets.sender(self._encode, self._attachment)
        """Function that encodes and sends, the short way; None where there is more to do."""
        self._endpoint.warns = warns_of_types(callbacks)
        self._keeps_: object = None
        """The node, which lives while anybody refers to the publisher; None for those that the node made for itself."""
        self._endpoint.on_disagreement = _weakly(self._on_disagreement)
        self._endpoint.on_other = _weakly(self._on_other)
        self._endpoint.speak_humble = _weakly(self._speak_humble)
        self._endpoint.announce()

    def publish(self, msg: MsgT | bytes) -> None:
        """Send a message to all subscriptions.

        Args:
            msg: Message of the topic's type, or its serialized bytes.

        Raises:
            EncodeError: (a TypeError and ValueError) if a field does not fit its type; the text names it.
            TypeError: if `msg` is of another type.
            InvalidHandle: (a RuntimeError) after `destroy`.
            TransportError: (a ConnectionError) if it has more than 1 GiB, or the context has ended.
        """
        if isinstance(msg, self.msg_type):
            send = self._send
            if send is not None:
                send(msg)
                return
            encode = self._encode  # for Python 3.11 a function in an attribute, no method: half the time to find it
            payload = encode(msg)
        elif isinstance(msg, (bytes, bytearray)):
            payload = bytes(msg)
        else:
            raise TypeError(_no_message(self.msg_type, msg))
        if self._destroyed:
            raise self._gone_(f"the publisher of {self.topic_name}")
        put_numbered = self._put_numbered
        if put_numbered is not None:
            put_numbered(payload, self._attachment)
            return
        # Locked, or a thread could be overtaken by another between its number and its place on the wire.
        with self._outlets.lock:
            self._put(payload, self._attachment())

    def _encode_in_pieces(self) -> None:
        """Encode in pieces from now on: messages are large, and go to shared memory."""
        buffers = buffers_encoder(message_type(self.msg_type))

        def encode(msg: Any) -> bytes | Pieces:
            made = Pieces(buffers(msg))
            return made if len(made) >= LARGE else bytes(made)

        with self._outlets.lock:
            self._encode = encode
            if self._send is not None:
                self._send = self._outlets.sender(encode, self._attachment)

    def _expect(self, steady: Callable[[], int]) -> None:
        """Let each message meet the deadline and renew the lease, where there are callbacks for what becomes of them.

        Both are noted as a message is numbered: publishers without such callbacks do nothing more than before.
        """
        self._steady, kind, qos = steady, QoSPublisherEventType, self.qos_profile
        deadline, lease = deadline_ns(qos), lease_ns(qos) if is_manual(qos) else None
        notes: list[Callable[[int], None]] = []
        if deadline is not None:
            expected = Deadline(deadline, QoSOfferedDeadlineMissedInfo)
            if expect(self.event_handlers, kind.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED, expected, steady):
                notes.append(expected.note)
        if lease is not None:
            held = Lease(lease, QoSLivelinessLostInfo)
            if expect(self.event_handlers, kind.RCL_PUBLISHER_LIVELINESS_LOST, held, steady):
                notes.append(held.note)
                self._lease = held
        if notes:
            self._attachment = _noting(self._attachment, notes, steady)

    @property
    def _used_in_(self) -> ContextLike | None:
        return self._endpoint.context

    def _speak_humble(self, key: str) -> None:
        self._outlets.add(key)
        with self._outlets.lock:  # else `_encode_in_pieces` could undo it
            self._send = None
        self._put, self._put_numbered = self._outlets.put, self._outlets.put_numbered

    def _on_other(self, came: bool) -> None:
        matched = {QoSPublisherEventType.RCL_PUBLISHER_MATCHED}
        tell_handlers(self.event_handlers, matched, total=int(came), current=1 if came else -1)

    def _on_disagreement(self) -> None:
        tell_handlers(self.event_handlers, {QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE}, total=1)

    @property
    def _is_heard_(self) -> bool:
        """True if anybody gets what is published: a subscription, or a recorder that is not a node."""
        return self._outlets.matched

    def get_subscription_count(self) -> int:
        """Return the number of subscriptions of this topic and type."""
        self._check_(f"publisher of {self.topic}")
        return self._endpoint.count_others()

    @property
    def gid(self) -> bytes:
        """Global id of the publisher, 16 bytes, as in `robolink topic info -v`."""
        return self._endpoint.gid

    @property
    def topic_name(self) -> str:
        """Fully qualified name of the topic."""
        return self._topic_name

    @property
    def logger_name(self) -> str:
        """Name of the node's logger."""
        return self._endpoint.logger_name

    def wait_for_all_acked(self, timeout: Duration = _FOR_EVER) -> bool:
        """Return True at once, for any `timeout`: there are no acknowledgements on this wire, as in rmw_zenoh."""
        self._check_(f"publisher of {self.topic}")
        return True

    def assert_liveliness(self) -> None:
        """Assert that this publisher is alive, if its liveliness is MANUAL_BY_TOPIC, to all subscriptions.

        Each message does so as well. With AUTOMATIC there is nothing to do: it is alive while it is there. A node of
        ROS 2 that uses rmw_zenoh does not hear of it, nor does one that uses DDS.

        Raises:
            InvalidHandle: (a RuntimeError) after `destroy`.
        """
        self._check_(f"publisher of {self.topic}")
        if self._lease is not None:
            self._lease.note(self._steady())
        if self._tell_alive is not None:
            self._tell_alive()

    def destroy(self) -> None:
        """End the publisher, and undeclare it. Safe to call twice."""
        if not self._destroyed:
            self._destroyed = True
            self._keeps_ = self._send = None
            for handler in self.event_handlers:
                handler.destroy()
            self._outlets.close()
            self._endpoint.close()

    def __enter__(self) -> Publisher[MsgT]:
        return self

    def __exit__(self, *_: Any) -> None:
        self.destroy()


def _weakly(method: Callable[..., object]) -> Callable[..., object]:
    """Return a function that calls a bound method while its object is there: the graph would keep it for ever."""
    reference = weakref.WeakMethod(method)

    def call(*arguments: object) -> object:
        found = reference()
        return None if found is None else found(*arguments)

    return call


def _noting(
    attachment: Callable[[], bytes], notes: list[Callable[[int], None]], steady: Callable[[], int]
) -> Callable[[], bytes]:
    """Return a function that makes the attachment of a message, and notes its time."""

    def noted() -> bytes:
        now = steady()
        for note in notes:
            note(now)
        return attachment()

    return noted


class _Outlets:
    """Keys that a publisher sends to: its own, and Humble's as well once a Humble peer has come."""

    def __init__(self, endpoint: Endpoint, qos: QoSProfile) -> None:
        self._transport, self._qos = endpoint.transport, qos
        first = self._transport.advertise(endpoint.key, qos)
        self._all = [first]
        self._closed = False
        self.lock = fork_lock()  # re-entrant: a signal handler that logs interrupts whoever publishes a log
        """Held where something is numbered and put, so that all is sent in the order of its numbers, as in ROS 2."""
        self._latch: Latch[tuple[bytes, bytes]] | None = None
        self.put: Callable[[bytes, bytes], None] = first.put
        """Send a payload with its attachment; another function after `add`."""
        self.put_numbered: Callable[[bytes, Callable[[], bytes]], bytes] | None = None
        """Send a payload, and number it under a lock of the transport's own; None where `lock` is to be held."""
        if qos.durability is DurabilityPolicy.TRANSIENT_LOCAL and endpoint.type_hash != NO_HASH:
            # What late joiners get is retained here too: a Humble peer may come when it has all been published.
            self._latch = Latch(latched_depth(qos))
            self.put = self._put_and_retain
        else:
            self.put_numbered = getattr(first, "put_numbered", None)

    def when_shared(self, begin: Callable[..., object]) -> None:
        """Call `begin` once payloads go to shared memory, if the transport takes them in pieces."""
        if self._latch is None and hasattr(self._all[0], "on_shared"):
            self._all[0].on_shared = begin

    @property
    def matched(self) -> bool:
        """True if anybody listens to one of the keys."""
        return any(outlet.matched for outlet in self._all)

    def sender(self, encode: Callable[[Any], Any], attachment: Callable[[], bytes]) -> Callable[[Any], None] | None:
        """Return a function that encodes and sends a message, if the one outlet has its own way; not after `add`."""
        make = getattr(self._all[0], "sender", None)
        return None if make is None or self._latch is not None else make(encode, attachment, self.lock)

    def add(self, key: str) -> None:
        """Send to this key too from now on, and at once what late joiners get."""
        outlet = self._transport.advertise(key, self._qos)
        with self.lock:
            for payload, attachment in () if self._latch is None else self._latch.last():
                outlet.put(payload, attachment)
            self._all = [*self._all, outlet]
            if self._latch is None:
                self.put, self.put_numbered = self._put_to_all, None
        if self._closed:  # meanwhile
            outlet.close()

    def _put_to_all(self, payload: bytes, attachment: bytes) -> None:
        for outlet in self._all:
            outlet.put(payload, attachment)

    def _put_and_retain(self, payload: bytes, attachment: bytes) -> None:
        assert self._latch is not None
        self._put_to_all(payload, attachment)  # first, since it may be refused
        self._latch.retain((payload, attachment))

    def close(self) -> None:
        """Send nothing any more."""
        self._closed = True
        for outlet in self._all:
            outlet.close()


def _no_message(expected: type, given: object) -> str:
    advice = f"; a message is made with (): {expected.__name__}()" if given is expected else ""
    return f"Expected {expected}, got {type(given)}{advice}"
