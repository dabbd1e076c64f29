"""Events of publishers and subscriptions: who is at the other end, messages that were lost, types that differ.

What can happen is what can happen under rmw_zenoh: there are no deadlines and no liveliness leases on this wire, and
no two profiles are incompatible.
"""

from __future__ import annotations

import threading
import warnings
from collections.abc import Callable, Container, Iterable, Mapping
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

import msgspec

from robolink.callback_groups import CallbackGroup
from robolink.entity import NOTHING, Entity
from robolink.exceptions import RobolinkError
from robolink.qos import QoSPolicyKind

if TYPE_CHECKING:
    from robolink.executors import Executor


class UnsupportedEventTypeError(RobolinkError, RuntimeError):
    """A callback was given for an event that this network does not have."""


class QoSPublisherEventType(Enum):
    """What can happen to a publisher, numbered as in rcl."""

    RCL_PUBLISHER_OFFERED_DEADLINE_MISSED = 0
    RCL_PUBLISHER_LIVELINESS_LOST = 1
    RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS = 2
    RCL_PUBLISHER_INCOMPATIBLE_TYPE = 3
    RCL_PUBLISHER_MATCHED = 4


class QoSSubscriptionEventType(Enum):
    """What can happen to a subscription, numbered as in rcl."""

    RCL_SUBSCRIPTION_REQUESTED_DEADLINE_MISSED = 0
    RCL_SUBSCRIPTION_LIVELINESS_CHANGED = 1
    RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS = 2
    RCL_SUBSCRIPTION_MESSAGE_LOST = 3
    RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE = 4
    RCL_SUBSCRIPTION_MATCHED = 5


Callback = Callable[[Any], Any]
EventType = QoSPublisherEventType | QoSSubscriptionEventType


class CountedInfo(msgspec.Struct, frozen=True):
    """How often something has happened, and how often since the callback was last called."""

    total_count: int = 0
    total_count_change: int = 0


class MatchedInfo(CountedInfo, frozen=True):
    """How many ends there have been at the other end, and how many there are now."""

    current_count: int = 0
    current_count_change: int = 0


class QoSMessageLostInfo(CountedInfo, frozen=True):
    """Messages that were published and not received."""


class IncompatibleTypeInfo(CountedInfo, frozen=True):
    """Ends of the same topic that use another type."""


class QoSRequestedDeadlineMissedInfo(CountedInfo, frozen=True):
    """Does not happen on this network."""


class QoSOfferedDeadlineMissedInfo(CountedInfo, frozen=True):
    """Does not happen on this network."""


class QoSLivelinessLostInfo(CountedInfo, frozen=True):
    """Does not happen on this network."""


class QoSLivelinessChangedInfo(msgspec.Struct, frozen=True):
    """Does not happen on this network."""

    alive_count: int = 0
    not_alive_count: int = 0
    alive_count_change: int = 0
    not_alive_count_change: int = 0


class QoSRequestedIncompatibleQoSInfo(CountedInfo, frozen=True):
    """Does not happen on this network, where every profile suits every other."""

    last_policy_kind: QoSPolicyKind = QoSPolicyKind.INVALID


QoSOfferedIncompatibleQoSInfo = QoSRequestedIncompatibleQoSInfo
QoSPublisherMatchedInfo = MatchedInfo
QoSSubscriptionMatchedInfo = MatchedInfo

_INFO: dict[EventType, type[CountedInfo]] = {
    QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: QoSOfferedIncompatibleQoSInfo,
    QoSPublisherEventType.RCL_PUBLISHER_INCOMPATIBLE_TYPE: IncompatibleTypeInfo,
    QoSPublisherEventType.RCL_PUBLISHER_MATCHED: QoSPublisherMatchedInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_REQUESTED_INCOMPATIBLE_QOS: QoSRequestedIncompatibleQoSInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MESSAGE_LOST: QoSMessageLostInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_INCOMPATIBLE_TYPE: IncompatibleTypeInfo,
    QoSSubscriptionEventType.RCL_SUBSCRIPTION_MATCHED: QoSSubscriptionMatchedInfo,
}
"""The events that there are, each with what its callback gets."""


class Parent(Protocol):
    """What events happen to: a publisher or a subscription."""

    @property
    def topic_name(self) -> str:
        """The topic's fully qualified name."""


class EventHandler(Entity):
    """Has an executor call `callback(info)` after something happened, once however often it did meanwhile.

    Raises UnsupportedEventTypeError (a RuntimeError) for an event that this network does not have.
    """

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
                f"{parent_impl.topic_name}: there are no events of type {event_type.name} on this network, nor"
                " under rmw_zenoh: give no callback for it"
            )
        super().__init__(callback_group)
        self.event_type = event_type
        self._callback = callback
        self.attach_late: Callable[[], Callable[[Entity], object] | None] = lambda: None
        """Gives the node's function that has an executor run this, when a default callback is replaced."""
        self._lock = threading.Lock()
        self._status = MatchedInfo()
        self._happened = False

    @property
    def callback(self) -> Callback:
        """What is called; another one may take its place at any time."""
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
        executor = self.executor  # another thread may take it away meanwhile
        if executor is not None:
            executor.post(self)

    def attach(self, executor: Executor, queued: int = 0) -> None:
        """Belong to this executor; what happened before counts."""
        super().attach(executor, queued)
        if self._happened and not queued:
            executor.post(self)

    def take(self) -> Any:
        """Give what has happened since the last time."""
        with self._lock:
            if not self._happened:
                return NOTHING
            now, self._happened = self._status, False
            self._status = MatchedInfo(now.total_count, 0, now.current_count, 0)
        info = _INFO[self.event_type]
        return now if info is MatchedInfo else info(now.total_count, now.total_count_change)

    def execute(self, taken: Any) -> Any:
        """Call the callback."""
        return self._callback(taken)

    def destroy(self) -> None:
        """Call no more."""
        self._destroyed, self._happened = True, False
        self.detach()

    def __enter__(self) -> EventHandler:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


_OLDER_NAME = "QoSEventHandler is the older name of EventHandler: use that"


class QoSEventHandler(EventHandler):
    """The older name of EventHandler."""

    def __init_subclass__(cls, **kwargs: Any) -> None:
        warnings.warn(_OLDER_NAME, DeprecationWarning, stacklevel=2)
        super().__init_subclass__(**kwargs)

    def __init__(self, **kwargs: Any) -> None:
        warnings.warn(_OLDER_NAME, DeprecationWarning, stacklevel=2)
        super().__init__(**kwargs)


def tell_handlers(handlers: Iterable[EventHandler], kinds: Container[EventType], total: int, current: int = 0) -> None:
    """Tell the handlers of these kinds that it has happened."""
    for handler in handlers:
        if handler.event_type in kinds:
            handler.happen(total, current)


def with_callbacks(handlers: Iterable[EventHandler]) -> list[EventHandler]:
    """Give those that an executor has something to do for."""
    return [handler for handler in handlers if handler.callback is not _no_more_to_do]


class PublisherEventCallbacks:
    """The callbacks for a publisher's events, each called with one argument: what has happened.

    `matched` gets a QoSPublisherMatchedInfo, `incompatible_type` an IncompatibleTypeInfo. `incompatible_qos` is never
    called, and `deadline` and `liveliness` are refused by `create_publisher` with an UnsupportedEventTypeError. With
    default callbacks the node warns of subscriptions with another type.
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
        """Make a handler for each callback. Raises UnsupportedEventTypeError for an event that does not exist."""
        kind = QoSPublisherEventType
        callbacks = {
            kind.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED: self.deadline,
            kind.RCL_PUBLISHER_LIVELINESS_LOST: self.liveliness,
            kind.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS: self.incompatible_qos,
            kind.RCL_PUBLISHER_INCOMPATIBLE_TYPE: self.incompatible_type,
            kind.RCL_PUBLISHER_MATCHED: self.matched,
        }
        usual = {kind.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS, kind.RCL_PUBLISHER_INCOMPATIBLE_TYPE}
        return _handlers(callbacks, usual if self.use_default_callbacks else set(), callback_group, publisher)


class SubscriptionEventCallbacks:
    """The callbacks for a subscription's events, each called with one argument: what has happened.

    `matched` gets a QoSSubscriptionMatchedInfo, `message_lost` a QoSMessageLostInfo, `incompatible_type` an
    IncompatibleTypeInfo. `incompatible_qos` is never called, and `deadline` and `liveliness` are refused by
    `create_subscription` with an UnsupportedEventTypeError. With default callbacks the node warns of publishers with
    another type.
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
        """Make a handler for each callback. Raises UnsupportedEventTypeError for an event that does not exist."""
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
    """Whether an end with another type is only to be warned about."""
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
