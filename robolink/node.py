"""Node: the owner of publishers, subscriptions, services, clients, timers and parameters under one name."""

from __future__ import annotations

import _thread
import contextlib
import itertools
import weakref
from types import FunctionType
from typing import TYPE_CHECKING, Any, TypeVar

from robolink.arguments.command_line import Arguments, parse_arguments
from robolink.arguments.remapping import RemapKind, resolve_name
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.client import Client as Client
from robolink.clock import Clock, ROSClock
from robolink.context import Context
from robolink.event_handler import PublisherEventCallbacks as PublisherEventCallbacks
from robolink.event_handler import SubscriptionEventCallbacks as SubscriptionEventCallbacks
from robolink.exceptions import NodeNameNonExistentError as NodeNameNonExistentError
from robolink.exceptions import NotInitializedException
from robolink.executors import Executor as Executor
from robolink.expand_topic_name import expand_topic_name
from robolink.graph.endpoint import Owner
from robolink.graph.type_mismatch import Disagreements
from robolink.guard_condition import GuardCondition as GuardCondition
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.interfaces.rcl_interfaces.msg import Log, ParameterEvent
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor as ParameterDescriptor
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult as SetParametersResult
from robolink.logging import get_logger
from robolink.node_parts import rosout
from robolink.node_parts.creation import NodeCreation
from robolink.node_parts.parameters import NodeParameters
from robolink.parameter import Parameter
from robolink.parameter_service import ParameterService
from robolink.parameters.rules import WrittenParameter
from robolink.publisher import Publisher
from robolink.qos import (
    QoSProfile,
    as_profile,
    qos_profile_parameter_events,
    qos_profile_rosout_default,
)
from robolink.qos import qos_profile_services_default as qos_profile_services_default
from robolink.running.entity import Entity
from robolink.service import Service as Service
from robolink.subscription import Subscription as Subscription
from robolink.time_source import TimeSource
from robolink.timer import Rate as Rate
from robolink.timer import Timer as Timer
from robolink.type_description_service import TypeDescriptionService
from robolink.type_support import MsgT as MsgT
from robolink.utilities import get_default_context
from robolink.validate_namespace import validate_namespace
from robolink.validate_node_name import validate_node_name
from robolink.wire import NodeToken

if TYPE_CHECKING:
    from robolink.qos_overriding_options import QoSOverridingOptions

MsgType = TypeVar("MsgType")  # names that programs import from here
SrvType = TypeVar("SrvType")

_number = itertools.count(1).__next__

HIDDEN_NODE_PREFIX = "_"
"""First character of the names of nodes that tools do not list."""

# What Node has beyond rclpy's names is spelled `_so_`, as `enum` does it: a subclass is free to use any other name.


class Node(NodeParameters, NodeCreation):
    """Participant of a ROS system; subclass it, or use it as it is.

        class Talker(Node):
            def __init__(self) -> None:
                super().__init__("talker")
                self.publisher = self.create_publisher(String, "chatter", 10)
                self.create_timer(0.5, self.on_timer)

            def on_timer(self) -> None:
                self.publisher.publish(String(data="hello"))

    Its callbacks run while an executor spins it: `rclpy.spin(node)`, or `executor.add_node(node)` and
    `executor.spin()`. `destroy_node` ends it; so do the end of its context and of a `with` block.

    Args:
        node_name: Name without namespace: letters, digits and underscores. The ROS argument `-r __node:=name`
            replaces it.
        context: Context to live in, which must be initialized; None is the default one, that of `rclpy.init`.
        cli_args: Command line for this node alone, such as `["--ros-args", "-r", "chatter:=news"]`. It goes before
            the context's arguments. None adds nothing.
        namespace: Prefix of the node's name and of its relative topics, with or without the leading slash; None is
            the root. The ROS argument `-r __ns:=/name` replaces it.
        use_global_arguments: False ignores the context's ROS arguments (those of the program's command line).
        enable_rosout: True publishes what the node logs on /rosout, unless the arguments say
            `--disable-rosout-logs`.
        start_parameter_services: True starts the six services by which others read and set parameters
            (`~/get_parameters` ...).
        parameter_overrides: Values that go before the defaults with which the node declares its parameters, and
            before those of the command line and of parameter files.
        allow_undeclared_parameters: True lets parameters be set that were never declared; reading one that does not
            exist then returns one without a value.
        automatically_declare_parameters_from_overrides: True declares every override at once, with its own type.
        enable_logger_service: True starts the services that read and set the levels of loggers
            (`~/get_logger_levels`, `~/set_logger_levels`).
        rosout_qos_profile: Quality of service of what it logs on /rosout; a number is a depth.

    Raises:
        NotInitializedException: (a RuntimeError) if the context is not initialized, or has ended.
        InvalidNodeNameException: (a ValueError) if the name is against ROS 2's rules; InvalidNamespaceException for
            the namespace.
        InvalidROSArgsError: (a ValueError) if `cli_args` cannot be read; UnknownROSArgsError for flags that do not
            exist.
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
        rosout_qos_profile: QoSProfile | int = qos_profile_rosout_default,
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
                self._publish_logs_(as_profile(rosout_qos_profile))
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
        self._is_parked_ = False
        """True while that executor keeps the entities only for the next spin, and the node belongs to none."""
        self._number_ = _number()
        self._was_taken_ = False
        """True once it was spun though another executor has it, and that was warned of."""
        self._turns_: list[Entity] = []
        """Entities whose turn was still to come when the last executor removed this node, in order."""
        self._rosout_: Publisher[Log] | None = None  # none of the user's: `publishers` does not list it
        self._init_entities_()
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        self._clock = ROSClock(time_base=self._context.time)

    def _publish_logs_(self, qos_profile: QoSProfile) -> None:
        self._rosout_ = Publisher(self._owner_, Log, "/rosout", qos_profile)
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
        if not isinstance(namespace, (str, type(None))):
            raise TypeError(f"namespace: expected a str or None, got {namespace!r}")
        absolute = namespace if namespace and namespace.startswith("/") else f"/{namespace or ''}"
        validate_node_name(name)
        validate_namespace(absolute)
        new_name = self._arguments_.node_name(name)
        new_namespace = self._arguments_.namespace(absolute, new_name)
        validate_node_name(new_name)
        validate_namespace(new_namespace)
        return new_name, new_namespace

    def _announce_(self) -> None:
        context = self._context
        enclave = context.transport.enclave or self._arguments_.enclave or "/"
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
        """Return the node's name after remapping, without its namespace."""
        return self._name_

    def get_namespace(self) -> str:
        """Return the node's namespace after remapping, with its leading slash; '/' is the root."""
        return self._namespace_

    def get_fully_qualified_name(self) -> str:
        """Return namespace and name, such as `/arm/driver`."""
        return f"{self._namespace_.rstrip('/')}/{self._name_}"

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """Return the fully qualified name of a topic.

        Args:
            topic: Absolute (`/a`), relative (`a`) or private (`~/a`) name; `{node}` and `{ns}` are replaced.
            only_expand: True leaves out the remapping rules of the command line.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        if only_expand:
            return expand_topic_name(topic, self._name_, self._namespace_)
        return resolve_name(self._arguments_.remap_rules, RemapKind.TOPIC, topic, self._name_, self._namespace_)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """Return the fully qualified name of a service.

        Args:
            service: Absolute (`/a`), relative (`a`) or private (`~/a`) name; `{node}` and `{ns}` are replaced.
            only_expand: True leaves out the remapping rules of the command line.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        if only_expand:
            return expand_topic_name(service, self._name_, self._namespace_)
        return resolve_name(self._arguments_.remap_rules, RemapKind.SERVICE, service, self._name_, self._namespace_)

    # What it has

    @property
    def _used_in_(self) -> Context:
        return self._context

    @property
    def context(self) -> Context:
        """Context of the node."""
        return self._context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """Callback group of all that is created without one: mutually exclusive, one callback at a time."""
        return self._default_callback_group

    @property
    def executor(self) -> Executor | None:
        """Executor that runs the node's callbacks; None if it was added to none. Setting it moves the node."""
        return None if self._is_parked_ or self._executor_ is None else self._executor_()

    @executor.setter
    def executor(self, executor: Executor | None) -> None:
        current = self.executor
        if current is executor:
            return
        if current is not None:
            current.remove_node(self)
        self._belong_to_(executor if executor is not None and executor.add_node(self) else None)

    @property
    def _attached_to_(self) -> Executor | None:
        """The executor that the node's entities are attached to: also while it is parked there."""
        return None if self._executor_ is None else self._executor_()

    def _belong_to_(self, executor: Executor | None) -> None:
        """Note the executor that has this node from now on; None for none."""
        self._executor_ = None if executor is None else weakref.ref(executor)

    def get_clock(self) -> Clock:
        """Return the node's clock: a ROSClock, which follows /clock while the parameter `use_sim_time` is true."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """Return the logger with the node's full name, dots for slashes; its lines go to the console and /rosout."""
        return self._logger

    def _on_parameter_event_(self, event: ParameterEvent) -> None:
        self._parameter_events_.publish(event)

    def _overridden_(
        self, kind: type[Any], topic: str, qos: QoSProfile, options: QoSOverridingOptions | None
    ) -> QoSProfile:
        """Return the profile with the policies that parameters override, where options allow them."""
        if options is None:
            return qos
        from robolink.qos_overriding_options import overridden  # late: few nodes ask

        return overridden(kind, self, topic, qos, options)

    def destroy_node(self) -> None:
        """Destroy all that the node has, and leave the graph and the executor. Safe to call twice."""
        self._destroyed = True
        executor = self._attached_to_
        if executor is not None:
            executor.remove_node(self)
        self._context.given_parameters.look(self)
        rosout.keep_to_itself(self._logger.name)
        if self._rosout_ is not None:
            self._rosout_.destroy()
        self._destroy_entities_()
        self._announced_.close()
        self._context.untrack_node(self)

    def __del__(self) -> None:
        """Leave the graph, as in rclpy, once nobody refers to the node any more; not where runs are to repeat.

        That is in a thread of its own, since garbage is collected anywhere: this one may hold any lock.
        """
        context: Context | None = vars(self).get("_context")
        if context is None or self._destroyed or "_announced_" not in vars(self):
            return
        if not context.ok() or not context.transport.threaded:
            return
        with contextlib.suppress(RuntimeError):  # Python ends, or there are too many threads
            _thread.start_new_thread(Node.destroy_node, (self,))

    if not TYPE_CHECKING:  # or every attribute would be one of mypy's

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") and "_context" not in vars(self):
                text = f"{type(self).__name__} is not a node yet: call super().__init__('NAME') first"
                raise AttributeError(text, name="", obj=None)  # else Python would advise another name of ours
            return super().__getattribute__(name)  # which says what Python says

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _speak_as_node() -> None:
    """Name the public methods of Node's parts as Node's: errors, help and debuggers know no NodeCreation."""
    parts = [each for each in Node.__mro__ if each.__module__.startswith("robolink.node_parts.")]
    for part in parts:
        for name, method in vars(part).items():
            if isinstance(method, FunctionType) and not name.startswith("_"):
                method.__module__, method.__qualname__ = __name__, f"Node.{name}"


_speak_as_node()
