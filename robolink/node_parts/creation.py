"""Creation of a node's publishers, subscriptions, services, clients, timers, guard conditions and rates."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.callback_groups import CallbackGroup
from robolink.client import Client
from robolink.clock import Clock, ROSClock
from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from robolink.guard_condition import GuardCondition
from robolink.message import Message
from robolink.node_parts.entities import NodeEntities
from robolink.node_parts.graph_questions import NodeGraph
from robolink.publisher import Publisher
from robolink.qos import QoSProfile, as_profile, qos_profile_services_default
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.timer import Rate, Timer, period_ns
from robolink.type_support import check_is_valid_msg_type, check_is_valid_srv_type

if TYPE_CHECKING:
    from robolink.context import Context
    from robolink.graph.endpoint import Owner
    from robolink.qos_overriding_options import QoSOverridingOptions
    from robolink.subscription_content_filter_options import ContentFilterOptions

MsgT = TypeVar("MsgT", bound=Message)


class NodeCreation(NodeEntities, NodeGraph):
    """The part of a node that creates its entities."""

    if TYPE_CHECKING:  # the node's
        _owner_: Owner
        _context: Context
        _clock: ROSClock
        _default_callback_group: CallbackGroup
        _rate_group: CallbackGroup

        def _overridden_(
            self, kind: type[Any], topic: str, qos: QoSProfile, options: QoSOverridingOptions | None
        ) -> QoSProfile: ...

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[MsgT]] = Publisher,
    ) -> Publisher[MsgT]:
        """Create a publisher of a topic.

        Args:
            msg_type: Message class of the topic, such as `std_msgs.msg.String`.
            topic: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            qos_profile: Quality of service; a number is the depth of a reliable, volatile KEEP_LAST profile.
            callback_group: Group of the event callbacks; None is the node's default group.
            event_callbacks: Callbacks for events, such as a subscription that appears; None only warns of
                subscriptions with another type.
            qos_overriding_options: Policies that parameters may change, `qos_overrides./topic.publisher.depth` for
                example; None allows none.
            publisher_class: Class to make, a Publisher or a subclass.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `msg_type` is not a message class.
            UnsupportedEventTypeError: (a RuntimeError) if there is a callback for an event that this network lacks.
            InvalidQosOverridesError: (a RuntimeError) if a parameter makes the profile invalid.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        name = self.resolve_topic_name(topic)
        check_is_valid_msg_type(msg_type)
        publisher = publisher_class(
            self._owner_,
            msg_type,
            name,
            self._overridden_(Publisher, name, as_profile(qos_profile), qos_overriding_options),
            event_callbacks=event_callbacks,
            callback_group=callback_group or self._default_callback_group,
        )
        publisher.topic = topic  # as written, as in rclpy; `topic_name` is the whole one
        self._keep_(publisher, self._publishers)
        self._attach_handlers_(publisher.event_handlers)
        return publisher

    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
    ) -> Subscription[MsgT]:
        """Create a subscription of a topic.

        Args:
            msg_type: Message class of the topic.
            topic: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            callback: Function, or coroutine function, called with each message; if it takes two arguments, with the
                message and its MessageInfo.
            qos_profile: Quality of service; a number is the depth of a reliable, volatile KEEP_LAST profile. The
                depth is how many messages wait for the callback before the oldest is dropped.
            callback_group: Group of the callback and of the event callbacks; None is the node's default group.
            event_callbacks: Callbacks for events, such as messages that were lost; None only warns of publishers
                with another type.
            qos_overriding_options: Policies that parameters may change; None allows none.
            raw: True calls back with the serialized message (bytes) instead.
            content_filter_options: Filter for messages. It has no effect here, as with rmw_zenoh: a warning says so,
                and `is_cft_enabled` is False.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `msg_type` is not a message class.
            RuntimeError: if the callback takes neither one argument nor two.
            UnsupportedEventTypeError: (a RuntimeError) if there is a callback for an event that this network lacks.
            InvalidQosOverridesError: (a RuntimeError) if a parameter makes the profile invalid.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        group = callback_group or self._default_callback_group
        name = self.resolve_topic_name(topic)
        check_is_valid_msg_type(msg_type)
        qos = self._overridden_(Subscription, name, as_profile(qos_profile), qos_overriding_options)
        made = Subscription(self._owner_, msg_type, name, callback, group, qos, raw, event_callbacks)
        made.topic = topic
        if content_filter_options is not None:
            made.warn_of_filter(content_filter_options.filter_expression)
        self._add_subscription_(made)
        return made

    def create_service(
        self,
        srv_type: type[Any],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Create a service: serve requests under a name.

        Args:
            srv_type: Service class, such as `std_srvs.srv.SetBool`.
            srv_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            callback: Function, or coroutine function, called as `callback(request, response)` with an empty response;
                it returns the response to send.
            qos_profile: Quality of service; by default reliable with a depth of 10.
            callback_group: Group of the callback; None is the node's default group.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `srv_type` is not a service class.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        group = callback_group or self._default_callback_group
        name = self.resolve_service_name(srv_name)
        check_is_valid_srv_type(srv_type)
        made = Service(self._owner_, srv_type, name, callback, group, qos_profile)
        made.srv_name = srv_name
        return self._add_(made, self._services)

    def create_client(
        self,
        srv_type: type[Any],
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Create a client, which calls a service.

        Args:
            srv_type: Service class, such as `std_srvs.srv.SetBool`.
            srv_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            qos_profile: Quality of service; by default reliable with a depth of 10.
            callback_group: Group of the client; None is the node's default group. An answer is taken even while
                another callback of the group runs, so that a callback may wait for it.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
            MessageError: (a ValueError) if `srv_type` is not a service class.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        group = callback_group or self._default_callback_group
        name = self.resolve_service_name(srv_name)
        check_is_valid_srv_type(srv_type)
        made = Client(self._owner_, srv_type, name, qos_profile, group)
        made.srv_name = srv_name
        return self._add_(made, self._clients)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Create a timer, which calls a function periodically.

        Args:
            timer_period_sec: Period in seconds, 0 or more; 0 calls as often as possible.
            callback: Function, or coroutine function, without arguments, or with one that is annotated as TimerInfo.
                None, as in rclpy, must be replaced (`timer.callback = ...`) before the first call is due.
            callback_group: Group of the callback; None is the node's default group.
            clock: Clock that the period is measured by; None is the node's clock.
            autostart: False makes the timer cancelled; `timer.reset()` starts it.

        Raises:
            ValueError: if the period is negative, infinite or not a number.
            TypeError: if the callback cannot be called.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        group = callback_group or self._default_callback_group
        period = period_ns(timer_period_sec)
        timer = Timer(callback, group, period, clock or self._clock, context=self._context, autostart=autostart)
        return self._add_(timer, self._timers)

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Create a guard condition, by which any thread has a callback run by the executor: `guard.trigger()`.

        Args:
            callback: Function, or coroutine function, without arguments.
            callback_group: Group of the callback; None is the node's default group.

        Raises:
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        group = callback_group or self._default_callback_group
        return self._add_(GuardCondition(callback, group, context=self._context), self._guards)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate, whose `sleep` waits for the rest of each period.

        Args:
            frequency: Ticks per second (Hz), above 0.
            clock: Clock that the period is measured by; None is the node's clock.

        Raises:
            ValueError: if the frequency is not above 0.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, _until_its_rate, callback_group=self._rate_group, clock=clock)
        return Rate(timer, context=self._context)


def _until_its_rate() -> None:
    """Do nothing when a rate's timer is due before there is the rate."""
