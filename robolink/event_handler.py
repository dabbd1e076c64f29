"""Events of publishers and subscriptions: a match, lost messages, types that differ, deadlines and liveliness.

Deadlines and liveliness are watched at each end, by its own profile, as ROS 2 does over DDS: rmw_zenoh takes callbacks
for them since Lyrical and never calls them. No two profiles are incompatible, as under rmw_zenoh.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Container, Iterable, Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

import msgspec

from robolink.callback_groups import CallbackGroup
from robolink.exceptions import RobolinkError
from robolink.qos import QoSPolicyKind
from robolink.running.entity import NOTHING, Entity
from robolink.running.expectations import Expectation

if TYPE_CHECKING:
    from robolink.running.ports import Loop


class UnsupportedEventTypeError(RobolinkError, RuntimeError):
    """A callback was given for an event that this network does not have."""


class QoSPublisherEventType(Enum):
    """Events of a publisher, numbered as in rcl."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(Enum):
    """Events of a subscription, numbered as in rcl."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


Callback = Callable[[Any], Any]
EventType = QoSPublisherEventType | QoSSubscriptionEventType


class CountedInfo(msgspec.Struct, frozen=True):
    """Count of an event, and its change since the callback was last called."""

    total_count: int = 0
    """Number of times that it has happened."""
    total_count_change: int = 0
    """Number of times since the callback was last called."""


class MatchedInfo(CountedInfo, frozen=True):
    """Count of matching endpoints: all so far, and those that are there now."""

    current_count: int = 0
    """Number of matching endpoints that are there now."""
    current_count_change: int = 0
    """Change of that number since the callback was last called."""


class QoSMessageLostInfo(CountedInfo, frozen=True):
    """Count of messages that were published and not received."""


class IncompatibleTypeInfo(CountedInfo, frozen=True):
    """Count of endpoints of the same topic that use another type."""


class QoSRequestedDeadlineMissedInfo(CountedInfo, frozen=True):
    """Count of deadlines within which no message was received, since the first one."""


class QoSOfferedDeadlineMissedInfo(CountedInfo, frozen=True):
    """Count of deadlines within which no message was published, since the first one."""


class QoSLivelinessLostInfo(CountedInfo, frozen=True):
    """Count of leases that ended without a message or `assert_liveliness`."""


class QoSLivelinessChangedInfo(msgspec.Struct, frozen=True):
    """Counts of the publishers that are alive and that are not, and their changes."""

    alive_count: int = 0
    """Number of matched publishers that are alive."""
    not_alive_count: int = 0
    """Number of matched publishers that were alive, and have been silent for longer than the lease."""
    alive_count_change: int = 0
    """Change of `alive_count` since the callback was last called."""
    not_alive_count_change: int = 0
    """Change of `not_alive_count` since the callback was last called."""


class QoSRequestedIncompatibleQoSInfo(CountedInfo, frozen=True):
    """Does not happen on this network, where every profile suits every other; `last_policy_kind` stays INVALID."""

    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo
QoSPublisherMatchedInfo = MatchedInfo
QoSSubscriptionMatchedInfo = MatchedInfo

_INFO: dict[EventType, type[CountedInfo] | type[QoSLivelinessChangedInfo]] = {
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: QoSOfferedDeadlineMissedInfo,
    QoSPublisherEventType.RCL_PUBLISHER_LIVELINESS_LOST: QoSLivelinessLostInfo,
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: QoSOfferedIncompatibleQoSInfo,
    QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: IncompatibleTypeInfo,
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED: QoSPublisherMatchedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: QoSRequestedDeadlineMissedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: QoSLivelinessChangedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: QoSMessageLostInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: IncompatibleTypeInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: QoSSubscriptionMatchedInfo,
}
"""Type of the argument of each event's callback."""


class Parent(Protocol):
    """Owner of events: a publisher or a subscription."""

    @property
    def topic_name(self) -> str:
        """Fully qualified name of the topic."""


class EventHandler(Entity):
    """Entity that calls `callback(info)` in an executor after an event, once however often it happened meanwhile.

    Args:
        callback_group: Group of the callback; None is none, so that it may run at any time.
        callback: Function of the event's info, such as a QoSPublisherMatchedInfo.
        event_type: Kind of the event.
        parent_impl: Publisher or subscription.

    Raises:
        UnsupportedEventTypeError: (a RuntimeError) for something that is not an event's type.
    """

    version = 0
    """Number that changes whenever an older time of the next look no longer holds."""

    _period = 1
    """A host asks: it is not a timer that is due as often as possible."""

    def __init__(
        self,
        *,
        callback_group: CallbackGroup | None,
        callback: Callback,
        event_type: EventType,
        parent_impl: Parent,
    ) -> None:
        if event_type not in _INFO:
            raise UnsupportedEventTypeError(
                f"expected a QoSPublisherEventType or QoSSubscriptionEventType, got {event_type!r:.80}"
            )
        super().__init__(callback_group)
        self.event_type = event_type
        self._callback = callback
        self.attach_late: Callable[[], Callable[[Entity], object] | None] = lambda: None
        """Function that returns the node's function which attaches this, for a default callback that is replaced."""
        self._lock = threading.Lock()
        self._status = MatchedInfo()
        self._happened = False
        self._expectation: Expectation | None = None
        self._steady: Callable[[], int] = int

    @property
    def callback(self) -> Callback:
        """Function that is called; another one may take its place at any time."""
        return self._callback

    @callback.setter
    def callback(self, callback: Callback) -> None:
        before, self._callback = self._callback, callback
        attach = self.attach_late()
        if before is _no_more_to_do and attach is not None:
            attach(self)

    def happen(self, total: int, current: int = 0) -> None:
        """Note that it has happened `total` times more, and that there are `current` more now; on any thread."""
        with self._lock:
            before = self._status
            self._status = MatchedInfo(
                before.total_count + total,
                before.total_count_change + total,
                before.current_count + current,
                before.current_count_change + current,
            )
            self._happened = not self._destroyed
        queue = self._queue_  # another thread may take it away meanwhile
        if queue is not None:
            queue.post(self)

    def expect(self, expectation: Expectation, steady: Callable[[], int]) -> None:
        """Report what becomes of this `expectation` from now on, by the clock `steady`, in nanoseconds."""
        self._expectation, self._steady = expectation, steady
        expectation.wake = self._look_soon

    def _look_soon(self) -> None:
        queue = self._queue_  # another thread may take it away meanwhile
        if queue is not None:
            queue.post(self)

    def attach(self, executor: Loop, has_turn: bool = False) -> None:
        """Belong to this executor; what happened before counts."""
        super().attach(executor, has_turn)
        if (self._happened or self._expectation is not None) and not has_turn:
            executor._queue_.post(self)

    def detach(self) -> None:
        """Belong to no executor."""
        super().detach()
        self.version += 1

    def take(self) -> Any:
        """Return the info of what has happened since the last time, or NOTHING."""
        if self._expectation is not None:
            return self._take_expected(self._expectation)
        with self._lock:
            if not self._happened:
                return NOTHING
            now, self._happened = self._status, False
            self._status = MatchedInfo(now.total_count, 0, now.current_count, 0)
        info = _INFO[self.event_type]
        return now if info is MatchedInfo else info(now.total_count, now.total_count_change)

    def _take_expected(self, expectation: Expectation) -> Any:
        if self._destroyed:
            return NOTHING
        now = self._steady()
        found, due = expectation.take(now)
        self.version += 1
        queue = self._queue_
        if queue is not None and due is not None:
            queue.schedule(self, due - now)
            if found is None:
                queue.wake()  # whoever looks just now has asked before when the next one is due
        return NOTHING if found is None else found

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        return self._callback(taken)

    def destroy(self) -> None:
        """End the handler: its callback is not called any more."""
        self._destroyed, self._happened = True, False
        self.detach()

    def __enter__(self) -> EventHandler:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


_OLDER_NAME = "QoSEventHandler is the older name of EventHandler: use that"


class QoSEventHandler(EventHandler):
    """Older name of EventHandler, which takes the same `kwargs`."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        warnings.warn(_OLDER_NAME, DeprecationWarning, stacklevel=2)
        super().__init_subclass__(**kwargs)

    def __init__(self, **kwargs: Any) -> None:
        warnings.warn(_OLDER_NAME, DeprecationWarning, stacklevel=2)
        super().__init__(**kwargs)


def expect(
    handlers: Iterable[EventHandler], kind: EventType, expectation: Expectation, steady: Callable[[], int]
) -> bool:
    """Let the handlers of a kind of event report what becomes of an expectation; False if there are none.

    Args:
        handlers: Handlers of a publisher or subscription.
        kind: Kind of the event.
        expectation: Deadline, lease or liveliness that is reported.
        steady: Clock that it goes by, in nanoseconds.
    """
    found = [handler for handler in handlers if handler.event_type is kind]
    for handler in found:
        handler.expect(expectation, steady)
    return bool(found)


def tell_handlers(handlers: Iterable[EventHandler], kinds: Container[EventType], total: int, current: int = 0) -> None:
    """Pass an event on to those handlers that are of its kind.

    Args:
        handlers: Handlers of a publisher or subscription.
        kinds: Kinds of the event.
        total: Number of times that it has happened.
        current: Change of the number of endpoints that are there now.
    """
    for handler in handlers:
        if handler.event_type in kinds:
            handler.happen(total, current)


def with_callbacks(handlers: Iterable[EventHandler]) -> list[EventHandler]:
    """Return those of the `handlers` that an executor has something to do for."""
    return [handler for handler in handlers if handler.callback is not _no_more_to_do]


class PublisherEventCallbacks:
    """Callbacks for a publisher's events, each a function of one argument; None ignores the event.

    Args:
        deadline: Function of a QoSOfferedDeadlineMissedInfo: nothing was published for longer than the profile's
            deadline.
        liveliness: Function of a QoSLivelinessLostInfo: with MANUAL_BY_TOPIC, nothing was published or asserted for
            longer than the lease. Never called with AUTOMATIC.
        incompatible_qos: Function of a QoSOfferedIncompatibleQoSInfo; never called, since all profiles can talk.
        incompatible_type: Function of an IncompatibleTypeInfo: a subscription has another type.
        matched: Function of a QoSPublisherMatchedInfo: a subscription has come or gone.
        use_default_callbacks: True warns of subscriptions with another type, unless there is a callback for it.
    """

    def __init__(
        self,
        *,
        deadline: Callback | None = None,
        liveliness: Callback | None = None,
        incompatible_qos: Callback | None = None,
        incompatible_type: Callback | None = None,
        matched: Callback | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.liveliness = liveliness
        self.incompatible_qos = incompatible_qos
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup | None, publisher: Parent, topic_name: str
    ) -> list[EventHandler]:
        """Make a handler for each callback.

        Args:
            callback_group: Group of the callbacks; None is none.
            publisher: Publisher whose events they are.
            topic_name: Fully qualified name of its topic; rclpy's, the publisher knows it.
        """
        kind = QoSPublisherEventType
        callbacks = {
            kind.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: self.deadline,
            kind.RCL_PUBLISHER_LIVELINESS_LOST: self.liveliness,
            kind.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: self.incompatible_qos,
            kind.RCL_PUBLISHER_INCOMPATIBLE_TYPE: self.incompatible_type,
            kind.RCL_PUBLISHER_MATCHED: self.matched,
        }
        # The first never comes: rmw_zenoh, and so this network, connects any two profiles.
        usual = {kind.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, kind.RCL_PUBLISHER_INCOMPATIBLE_TYPE}
        return _handlers(callbacks, usual if self.use_default_callbacks else set(), callback_group, publisher)


class SubscriptionEventCallbacks:
    """Callbacks for a subscription's events, each a function of one argument; None ignores the event.

    Args:
        deadline: Function of a QoSRequestedDeadlineMissedInfo: nothing was received for longer than the profile's
            deadline.
        incompatible_qos: Function of a QoSRequestedIncompatibleQoSInfo; never called, since all profiles can talk.
        liveliness: Function of a QoSLivelinessChangedInfo, if the profile has a lease: a publisher became alive, has
            been silent for longer than the lease, or has gone.
        message_lost: Function of a QoSMessageLostInfo: messages did not arrive.
        incompatible_type: Function of an IncompatibleTypeInfo: a publisher has another type.
        matched: Function of a QoSSubscriptionMatchedInfo: a publisher has come or gone.
        use_default_callbacks: True warns of publishers with another type, unless there is a callback for it.
    """

    def __init__(
        self,
        *,
        deadline: Callback | None = None,
        incompatible_qos: Callback | None = None,
        liveliness: Callback | None = None,
        message_lost: Callback | None = None,
        incompatible_type: Callback | None = None,
        matched: Callback | None = None,
        use_default_callbacks: bool = True,
    ) -> None:
        self.deadline = deadline
        self.incompatible_qos = incompatible_qos
        self.liveliness = liveliness
        self.message_lost = message_lost
        self.incompatible_type = incompatible_type
        self.matched = matched
        self.use_default_callbacks = use_default_callbacks

    def create_event_handlers(
        self, callback_group: CallbackGroup | None, subscription: Parent, topic_name: str
    ) -> list[EventHandler]:
        """Make a handler for each callback.

        Args:
            callback_group: Group of the callbacks; None is none.
            subscription: Subscription whose events they are.
            topic_name: Fully qualified name of its topic; rclpy's, the subscription knows it.
        """
        kind = QoSSubscriptionEventType
        callbacks = {
            kind.RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED: self.deadline,
            kind.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: self.incompatible_qos,
            kind.RCL_SUBSCRIPTION_LIVELINESS_CHANGED: self.liveliness,
            kind.RCL_SUBSCRIPTION_MESSAGE_LOST: self.message_lost,
            kind.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: self.incompatible_type,
            kind.RCL_SUBSCRIPTION_MATCHED: self.matched,
        }
        usual = {kind.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS, kind.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE}
        return _handlers(callbacks, usual if self.use_default_callbacks else set(), callback_group, subscription)


def warns_of_types(callbacks: PublisherEventCallbacks | SubscriptionEventCallbacks) -> bool:
    """True if an endpoint with another type is only to be warned about, by these `callbacks`."""
    return callbacks.use_default_callbacks and not callbacks.incompatible_type


def _handlers(
    callbacks: Mapping[Any, Callback | None], usual: Container[EventType], group: CallbackGroup | None, parent: Parent
) -> list[EventHandler]:
    return [
        EventHandler(callback_group=group, callback=callback or _no_more_to_do, event_type=kind, parent_impl=parent)
        for kind, callback in callbacks.items()
        if callback or kind in usual
    ]


def _no_more_to_do(info: Any) -> None:
    """Stand for a default callback: of another type the node has warned at once, also where nothing spins."""
