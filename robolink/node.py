"""The node: it owns publishers, subscriptions, services, clients, timers and parameters, and decides nothing."""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from robolink import rosout
from robolink.arguments import Arguments, parse_arguments
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.client import Client
from robolink.clock import Clock, ROSClock
from robolink.context import Context
from robolink.disagreement import Disagreements
from robolink.endpoint import Owner
from robolink.entity import Entity
from robolink.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from robolink.exceptions import NodeNameNonExistentError as NodeNameNonExistentError
from robolink.exceptions import NotInitializedException
from robolink.expand_topic_name import expand_topic_name
from robolink.guard_condition import GuardCondition
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.interfaces.rcl_interfaces.msg import Log, ParameterEvent
from robolink.logging import get_logger
from robolink.message import Message
from robolink.node_entities import NodeEntities
from robolink.node_graph import NodeGraph
from robolink.node_parameters import NodeParameters
from robolink.parameter import Parameter
from robolink.parameter_rules import WrittenParameter
from robolink.parameter_service import ParameterService
from robolink.publisher import Publisher
from robolink.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
    qos_profile_services_default,
)
from robolink.remapping import RemapKind, resolve_name
from robolink.service import Service
from robolink.subscription import Subscription
from robolink.time_source import TimeSource
from robolink.timer import Rate, Timer, period_ns
from robolink.type_description_service import TypeDescriptionService
from robolink.utilities import get_default_context
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.wire import NodeToken

if TYPE_CHECKING:
    from robolink.executors import Executor
    from robolink.qos_overriding_options import QoSOverridingOptions

MsgT = TypeVar("MsgT", bound=Message)
EntityT = TypeVar("EntityT", bound=Entity)
HIDDEN_NODE_PREFIX = "_"


class Node(NodeParameters, NodeGraph, NodeEntities):
    """A participant of the system: subclass it, or take it as it is.

    What it has beyond rclpy's names is spelled `_so_`, as `enum` does it: a subclass is free to use any other name.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: list[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: list[Parameter[Any]] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        self._context = get_default_context() if context is None else context
        if not self._context.ok():
            raise NotInitializedException("cannot create node", ended_by=self._context.ended_by)
        self._arguments_ = self._read_arguments_(cli_args, use_global_arguments)
        self._name_, self._namespace_ = self._resolve_own_name_(node_name, namespace)
        self._init_own_()
        self._init_parameters_(self._overrides_(parameter_overrides), allow_undeclared_parameters)
        self._announce_()
        self._context.track_node(self)
        try:
            if enable_rosout and self._arguments_.rosout_logs is not False:
                self._publish_logs_()
            self._context.given_parameters.expect(self, self._arguments_.parameter_overrides)
            self._parameter_events_ = self.create_publisher(
                ParameterEvent, "/parameter_events", qos_profile_parameter_events
            )
            if automatically_declare_parameters_from_overrides:
                self._declare_from_overrides_()
            self._time_source = TimeSource(node=self)
            self._time_source.attach_clock(self._clock)
            self._serve_(start_parameter_services, enable_logger_service)
        except BaseException:
            self.destroy_node()
            raise

    def _init_own_(self) -> None:
        self._executor_: weakref.ReferenceType[Executor] | None = None
        self._queued_: list[Entity] = []
        """What was ready when the last executor let go of this node, in order."""
        self._rosout_: Publisher[Log] | None = None  # none of the user's: `publishers` does not list it
        self._init_entities_()
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        self._clock = ROSClock(time_base=self._context.time)

    def _publish_logs_(self) -> None:
        self._rosout_ = Publisher(self._owner_, Log, "/rosout", qos_profile_rosout_default)
        rosout.publish_logs_of(self._logger.name, self._rosout_)

    def _serve_(self, parameters: bool, logger_levels: bool) -> None:
        if parameters:
            self._parameter_service = ParameterService(self)
        if logger_levels:
            from robolink.logging_service import LoggingService

            self._logger_service = LoggingService(self)
        self._type_description_service = TypeDescriptionService(self)

    # Names

    def _read_arguments_(self, cli_args: list[str] | None, use_global_arguments: bool) -> Arguments:
        base = self._context.arguments if use_global_arguments else Arguments()
        return base if cli_args is None else parse_arguments(cli_args).over(base)

    def _resolve_own_name_(self, name: str, namespace: str | None) -> tuple[str, str]:
        absolute = "/" + (namespace or "").lstrip("/")
        validate_node_name(name)
        validate_namespace(absolute)
        new_name = self._arguments_.node_name(name)
        new_namespace = self._arguments_.namespace(absolute, new_name)
        validate_node_name(new_name)
        validate_namespace(new_namespace)
        return new_name, new_namespace

    def _announce_(self) -> None:
        context = self._context
        enclave = self._arguments_.enclave or "/"
        identity = (context.next_id(), enclave, self._namespace_, self._name_)
        self._owner_ = Owner(context, *identity, Disagreements(self._logger.name))
        token = NodeToken(context.get_domain_id(), context.transport.session_id, *identity)
        self._announced_ = context.graph.announce(token)

    def _overrides_(self, given: list[Parameter[Any]] | None) -> dict[str, Parameter[Any]]:
        values = self._arguments_.overrides_for(self.get_fully_qualified_name())
        overrides: dict[str, Parameter[Any]] = {
            name: WrittenParameter(name, value=value) for name, value in values.items()
        }
        overrides.update({each.name: each for each in given or ()})
        return overrides

    def get_name(self) -> str:
        """The node's name, remapped."""
        return self._name_

    def get_namespace(self) -> str:
        """The node's namespace, remapped, with its leading slash."""
        return self._namespace_

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self._namespace_.rstrip('/')}/{self._name_}"

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Give the full name of a topic, remapped. Raises InvalidTopicNameException."""
        if only_expand:
            return expand_topic_name(topic, self._name_, self._namespace_)
        return resolve_name(self._arguments_.remap_rules, RemapKind.TOPIC, topic, self._name_, self._namespace_)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Give the full name of a service, remapped. Raises InvalidServiceNameException."""
        if only_expand:
            return expand_topic_name(service, self._name_, self._namespace_)
        return resolve_name(self._arguments_.remap_rules, RemapKind.SERVICE, service, self._name_, self._namespace_)

    # What it has

    @property
    def _used_in_(self) -> Context:
        return self._context

    @property
    def context(self) -> Context:
        """The context that it lives in."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of callbacks that were given none."""
        return self._default_callback_group

    @property
    def executor(self) -> Executor | None:
        """The executor that it was added to."""
        return None if self._executor_ is None else self._executor_()

    @executor.setter
    def executor(self, executor: Executor | None) -> None:
        current = self.executor
        if current is executor:
            return
        if current is not None:
            current.remove_node(self)
        self._belong_to_(executor if executor is not None and executor.add_node(self) else None)

    def _belong_to_(self, executor: Executor | None) -> None:
        """Be told by an executor that it has this node from now on, or no longer."""
        self._executor_ = None if executor is None else weakref.ref(executor)

    def get_clock(self) -> Clock:
        """The clock of this node: it follows /clock under use_sim_time."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """The logger that carries the node's name."""
        return self._logger

    def _on_parameter_event_(self, event: ParameterEvent) -> None:
        self._parameter_events_.publish(event)

    # Making

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
        """Make a publisher. A number as QoS is the depth of a reliable, volatile KEEP_LAST profile.

        The callback group is that of the event callbacks. `qos_overriding_options` say which policies parameters may
        change. Raises UnsupportedEventTypeError (a RuntimeError) for an event that this network does not have, and
        InvalidQosOverridesError (a RuntimeError) for a parameter that gives no profile.
        """
        name = self.resolve_topic_name(topic)
        publisher = publisher_class(
            self._owner_,
            msg_type,
            name,
            self._overridden_(Publisher, name, _qos(qos_profile), qos_overriding_options),
            event_callbacks=event_callbacks,
            callback_group=callback_group or self._default_callback_group,
        )
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
    ) -> Subscription[MsgT]:
        """Make a subscription. `callback` takes the message, or the message and its MessageInfo; bytes if `raw`.

        `qos_overriding_options` say which policies parameters may change. Raises UnsupportedEventTypeError (a
        RuntimeError) for an event that this network does not have, and InvalidQosOverridesError (a RuntimeError) for a
        parameter that gives no profile.
        """
        group = callback_group or self._default_callback_group
        name = self.resolve_topic_name(topic)
        qos = self._overridden_(Subscription, name, _qos(qos_profile), qos_overriding_options)
        made = Subscription(self._owner_, msg_type, name, callback, group, qos, raw, event_callbacks)
        self._add_subscription_(made)
        return made

    def _overridden_(
        self, kind: type[Any], topic: str, qos: QoSProfile, options: QoSOverridingOptions | None
    ) -> QoSProfile:
        """Give the profile with what parameters say of it, where options ask for such parameters."""
        if options is None:
            return qos
        from robolink.qos_overriding_options import overridden  # late: few nodes ask

        return overridden(kind, self, topic, qos, options)

    def create_service(
        self,
        srv_type: type[Any],
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Service:
        """Make a service. ``callback(request, response)`` returns the response."""
        group = callback_group or self._default_callback_group
        name = self.resolve_service_name(srv_name)
        return self._add_(Service(self._owner_, srv_type, name, callback, group, qos_profile), self._services)

    def create_client(
        self,
        srv_type: type[Any],
        srv_name: str,
        *,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> Client:
        """Make a client."""
        group = callback_group or self._default_callback_group
        name = self.resolve_service_name(srv_name)
        return self._add_(Client(self._owner_, srv_type, name, qos_profile, group), self._clients)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Make a timer that calls `callback` every `timer_period_sec` seconds of the node's clock.

        Raises ValueError for a period that is none, TypeError for what cannot be called.
        """
        group = callback_group or self._default_callback_group
        period = period_ns(timer_period_sec)
        timer = Timer(callback, group, period, clock or self._clock, context=self._context, autostart=autostart)
        return self._add_(timer, self._timers)

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Make a guard condition: whoever triggers it has `callback` run by the executor."""
        group = callback_group or self._default_callback_group
        return self._add_(GuardCondition(callback, group, context=self._context), self._guards)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Make a rate, `frequency` in Hz. Raises ValueError unless it is above 0."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, _until_its_rate, callback_group=self._rate_group, clock=clock)
        return Rate(timer, context=self._context)

    def destroy_node(self) -> None:
        """Undeclare all that it has, and itself. Safe to call twice."""
        self._destroyed = True
        executor = self.executor
        if executor is not None:
            executor.remove_node(self)
        self._context.given_parameters.look(self)
        rosout.keep_to_itself(self._logger.name)
        if self._rosout_ is not None:
            self._rosout_.destroy()
        self._destroy_entities_()
        self._announced_.close()
        self._context.untrack_node(self)

    if not TYPE_CHECKING:  # or every attribute would be one of mypy's

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") and "_context" not in vars(self):
                text = f"{type(self).__name__} is no node yet: call super().__init__('NAME') first"
                raise AttributeError(text, name="", obj=None)  # else Python would advise another name of ours
            return super().__getattribute__(name)  # which says what Python says

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _until_its_rate() -> None:
    """Do nothing when a rate's timer is due before there is the rate."""


def _qos(profile: QoSProfile | int) -> QoSProfile:
    if isinstance(profile, QoSProfile):
        return profile
    if isinstance(profile, int) and not isinstance(profile, bool):
        if profile < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=profile)
    raise TypeError(f"Expected QoSProfile or int, but received {type(profile)!r}")
