"""The node: it owns publishers, subscriptions, services, clients, timers and parameters, and decides nothing."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any, TypeVar

from robolink import rosout
from robolink.arguments import Arguments, parse_arguments
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.client import Client
from robolink.clock import Clock, ROSClock
from robolink.context import Context
from robolink.endpoint import Owner
from robolink.entity import Entity
from robolink.exceptions import NotInitializedException
from robolink.expand_topic_name import expand_topic_name
from robolink.guard_condition import GuardCondition
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.interfaces.rcl_interfaces.msg import Log, ParameterEvent
from robolink.logging import get_logger
from robolink.message import Message
from robolink.node_graph import NodeGraph
from robolink.node_parameters import NodeParameters
from robolink.parameter import Parameter
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
from robolink.timer import Rate, Timer
from robolink.utilities import get_default_context
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.wire import NodeToken, format_token

if TYPE_CHECKING:
    from robolink.executors import Executor

MsgT = TypeVar("MsgT", bound=Message)
EntityT = TypeVar("EntityT", bound=Entity)


class Node(NodeParameters, NodeGraph):
    """A participant of the system: subclass it, or take it as it is."""

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
            raise NotInitializedException("cannot create node")
        self._arguments = self._read_arguments(cli_args, use_global_arguments)
        self._name, self._namespace = self._resolve_own_name(node_name, namespace)
        self._executor: weakref.ReferenceType[Executor] | None = None
        self.queued: list[Entity] = []
        """What was ready when the last executor let go of this node, in order."""
        self._rosout: Publisher[Log] | None = None  # none of the user's: `publishers` does not list it
        self._publishers: list[Publisher[Any]] = []
        self._subscriptions: list[Subscription[Any]] = []
        self._clients: list[Client] = []
        self._services: list[Service] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        self._clock = ROSClock(time_base=self._context.time)
        self._announce()
        self._context.track_node(self)
        try:
            if enable_rosout and self._arguments.rosout_logs is not False:
                self._rosout = Publisher(self._owner, Log, "/rosout", qos_profile_rosout_default)
                rosout.publish_logs_of(self._logger.name, self._rosout)
            self._parameter_events = self.create_publisher(
                ParameterEvent, "/parameter_events", qos_profile_parameter_events
            )
            self._init_parameters(self._overrides(parameter_overrides), allow_undeclared_parameters)
            if automatically_declare_parameters_from_overrides:
                self._declare_from_overrides()
            self._time_source = TimeSource(node=self)
            self._time_source.attach_clock(self._clock)
        except BaseException:
            self.destroy_node()
            raise

    # Names

    def _read_arguments(self, cli_args: list[str] | None, use_global_arguments: bool) -> Arguments:
        base = self._context.arguments if use_global_arguments else Arguments()
        return base if cli_args is None else parse_arguments(cli_args).over(base)

    def _resolve_own_name(self, name: str, namespace: str | None) -> tuple[str, str]:
        absolute = "/" + (namespace or "").lstrip("/")
        validate_node_name(name)
        validate_namespace(absolute)
        new_name = self._arguments.node_name(name)
        new_namespace = self._arguments.namespace(absolute, new_name)
        validate_node_name(new_name)
        validate_namespace(new_namespace)
        return new_name, new_namespace

    def _announce(self) -> None:
        context, transport = self._context, self._context.transport
        owner = Owner(context, context.next_id(), self._arguments.enclave or "/", self._namespace, self._name)
        token = NodeToken(context.get_domain_id(), transport.session_id, *owner[1:])
        self._owner, self._announced = owner, transport.announce(format_token(token))

    def _overrides(self, given: list[Parameter[Any]] | None) -> dict[str, Parameter[Any]]:
        values = self._arguments.overrides_for(self.get_fully_qualified_name())
        overrides: dict[str, Parameter[Any]] = {name: Parameter(name, value=value) for name, value in values.items()}
        overrides.update({each.name: each for each in given or ()})
        return overrides

    def get_name(self) -> str:
        """The node's name, remapped."""
        return self._name

    def get_namespace(self) -> str:
        """The node's namespace, remapped, with its leading slash."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return f"{self._namespace.rstrip('/')}/{self._name}"

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Give the full name of a topic, remapped. Raises InvalidTopicNameException."""
        if only_expand:
            return expand_topic_name(topic, self._name, self._namespace)
        return resolve_name(self._arguments.remap_rules, RemapKind.TOPIC, topic, self._name, self._namespace)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Give the full name of a service, remapped. Raises InvalidServiceNameException."""
        if only_expand:
            return expand_topic_name(service, self._name, self._namespace)
        return resolve_name(self._arguments.remap_rules, RemapKind.SERVICE, service, self._name, self._namespace)

    # What it has

    @property
    def context(self) -> Context:
        """The context that it lives in."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of callbacks that were given none."""
        return self._default_callback_group

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Its publishers."""
        yield from self._publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Its subscriptions."""
        yield from self._subscriptions

    @property
    def clients(self) -> Iterator[Client]:
        """Its clients."""
        yield from self._clients

    @property
    def services(self) -> Iterator[Service]:
        """Its services."""
        yield from self._services

    @property
    def timers(self) -> Iterator[Timer]:
        """Its timers."""
        yield from self._timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Its guard conditions."""
        yield from self._guards

    def entities(self) -> list[Entity]:
        """All that an executor runs."""
        return [*self._subscriptions, *self._services, *self._clients, *self._timers, *self._guards]

    @property
    def executor(self) -> Executor | None:
        """The executor that it was added to."""
        return None if self._executor is None else self._executor()

    @executor.setter
    def executor(self, executor: Executor | None) -> None:
        current = self.executor
        if current is executor:
            return
        if current is not None:
            current.remove_node(self)
        self.belong_to(executor if executor is not None and executor.add_node(self) else None)

    def belong_to(self, executor: Executor | None) -> None:
        """Be told by an executor that it has this node from now on, or no longer."""
        self._executor = None if executor is None else weakref.ref(executor)

    def get_clock(self) -> Clock:
        """The clock of this node: it follows /clock under use_sim_time."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """The logger that carries the node's name."""
        return self._logger

    def _on_parameter_event(self, event: ParameterEvent) -> None:
        self._parameter_events.publish(event)

    # Making

    def _add(self, entity: EntityT, group: list[EntityT]) -> EntityT:
        group.append(entity)
        executor = self.executor
        if executor is not None:
            executor.attach(entity)
        return entity

    def create_publisher(
        self,
        msg_type: type[MsgT],
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        publisher_class: type[Publisher[MsgT]] = Publisher,
    ) -> Publisher[MsgT]:
        """Make a publisher. A number as QoS is the depth of a reliable, volatile KEEP_LAST profile."""
        publisher = publisher_class(self._owner, msg_type, self.resolve_topic_name(topic), _qos(qos_profile))
        self._publishers.append(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: type[MsgT],
        topic: str,
        callback: Callable[..., Any],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: Any = None,
        qos_overriding_options: Any = None,
        raw: bool = False,
    ) -> Subscription[MsgT]:
        """Make a subscription. `callback` takes the message, or the message and its MessageInfo; bytes if `raw`."""
        group = callback_group or self._default_callback_group
        name, qos = self.resolve_topic_name(topic), _qos(qos_profile)
        return self._add(Subscription(self._owner, msg_type, name, callback, group, qos, raw), self._subscriptions)

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
        return self._add(Service(self._owner, srv_type, name, callback, group, qos_profile), self._services)

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
        return self._add(Client(self._owner, srv_type, name, qos_profile, group), self._clients)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Make a timer that calls `callback` every `timer_period_sec` seconds of the node's clock."""
        group = callback_group or self._default_callback_group
        period = int(float(timer_period_sec) * 1e9)
        timer = Timer(callback, group, period, clock or self._clock, context=self._context, autostart=autostart)
        return self._add(timer, self._timers)

    def create_guard_condition(
        self, callback: Callable[[], Any], callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Make a guard condition: whoever triggers it has `callback` run by the executor."""
        group = callback_group or self._default_callback_group
        return self._add(GuardCondition(callback, group, context=self._context), self._guards)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Make a rate, `frequency` in Hz. Raises ValueError unless it is above 0."""
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, None, callback_group=self._rate_group, clock=clock)
        return Rate(timer, context=self._context)

    # Unmaking

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Undeclare a publisher; False when it is none of this node's."""
        return _destroy(publisher, self._publishers)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Undeclare a subscription; False when it is none of this node's."""
        return _destroy(subscription, self._subscriptions)

    def destroy_client(self, client: Client) -> bool:
        """Undeclare a client; False when it is none of this node's."""
        return _destroy(client, self._clients)

    def destroy_service(self, service: Service) -> bool:
        """Undeclare a service; False when it is none of this node's."""
        return _destroy(service, self._services)

    def destroy_timer(self, timer: Timer) -> bool:
        """End a timer; False when it is none of this node's."""
        return _destroy(timer, self._timers)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """End a guard condition; False when it is none of this node's."""
        return _destroy(guard, self._guards)

    def destroy_rate(self, rate: Rate) -> bool:
        """End a rate; False when it is none of this node's."""
        found = self.destroy_timer(rate._timer)
        rate.destroy()
        return found

    def destroy_node(self) -> None:
        """Undeclare all that it has, and itself. Safe to call twice."""
        executor = self.executor
        if executor is not None:
            executor.remove_node(self)
        rosout.keep_to_itself(self._logger.name)
        if self._rosout is not None:
            self._rosout.destroy()
        for owned in (self._publishers, self._subscriptions, self._clients, self._services, self._timers, self._guards):
            for entity in list(owned):
                _destroy(entity, owned)
        self._announced.close()
        self._context.untrack_node(self)

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _qos(profile: QoSProfile | int) -> QoSProfile:
    if isinstance(profile, QoSProfile):
        return profile
    if isinstance(profile, int) and not isinstance(profile, bool):
        if profile < 0:
            raise ValueError("history depth must be greater than or equal to zero")
        return QoSProfile(depth=profile)
    raise TypeError(f"Expected QoSProfile or int, but received {type(profile)!r}")


def _destroy(entity: Any, owned: list[Any]) -> bool:
    if entity not in owned:
        return False
    owned.remove(entity)
    entity.destroy()
    return True
