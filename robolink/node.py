"""Node: the owner of publishers, subscriptions, services, clients, timers and parameters under one name."""

from __future__ import annotations

import _thread
import contextlib
import itertools
import weakref
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar, overload

from robolink.arguments.command_line import Arguments, parse_arguments
from robolink.arguments.remapping import RemapKind, resolve_name
from robolink.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from robolink.clock import Clock, ROSClock
from robolink.context import Context
from robolink.event_handler import PublisherEventCallbacks as PublisherEventCallbacks
from robolink.event_handler import SubscriptionEventCallbacks as SubscriptionEventCallbacks
from robolink.exceptions import NodeNameNonExistentError as NodeNameNonExistentError
from robolink.exceptions import NotInitializedException
from robolink.executors import Executor as Executor
from robolink.expand_topic_name import expand_topic_name
from robolink.graph.action_names import actions
from robolink.graph.endpoint import Disagreements, Owner
from robolink.graph.graph import Graph, NamesAndTypes, names_and_types
from robolink.impl.rcutils_logger import RcutilsLogger
from robolink.interfaces.rcl_interfaces.msg import ListParametersResult, Log, ParameterEvent, ParameterValue
from robolink.interfaces.rcl_interfaces.msg import ParameterDescriptor as ParameterDescriptor
from robolink.interfaces.rcl_interfaces.msg import SetParametersResult as SetParametersResult
from robolink.logging import get_logger
from robolink.node_parts import rosout
from robolink.node_parts.entities import EntityStore, destroy
from robolink.node_parts.graph_queries import endpoints_of_service, endpoints_of_topic, of_node
from robolink.node_parts.making import make_client, make_publisher, make_service, make_subscription
from robolink.node_parts.names import overrides_of, own_name
from robolink.node_parts.parameters import (
    OnSetCallback,
    Parameters,
    ParameterStore,
    PostSetCallback,
    PreSetCallback,
)
from robolink.parameter import AllowableParameterValue, AllowableParameterValueT, Parameter
from robolink.parameter_service import ParameterService
from robolink.parameters.rules import check_names
from robolink.publisher import Publisher
from robolink.qos import QoSProfile, as_profile, qos_profile_parameter_events, qos_profile_rosout_default
from robolink.qos import qos_profile_services_default as qos_profile_services_default
from robolink.running.destroyable import Destroyable
from robolink.running.entity import Entity
from robolink.service import Service as Service
from robolink.subscription import Subscription as Subscription
from robolink.task import Future
from robolink.text.suggestions import lazily
from robolink.time_source import TimeSource
from robolink.type_description_service import TypeDescriptionService
from robolink.type_support import MsgT as MsgT
from robolink.utilities import get_default_context
from robolink.wire import EndpointKind, NodeToken

if TYPE_CHECKING:
    from robolink.client import BaseClient
    from robolink.client import Client as Client
    from robolink.endpoint_info import ServiceEndpointInfo as ServiceEndpointInfo
    from robolink.endpoint_info import TopicEndpointInfo as TopicEndpointInfo
    from robolink.guard_condition import GuardCondition as GuardCondition
    from robolink.qos_overriding_options import QoSOverridingOptions
    from robolink.subscription_content_filter_options import ContentFilterOptions
    from robolink.timer import Rate as Rate
    from robolink.timer import Timer as Timer
    from robolink.waitable import Waitable as Waitable

__getattr__, __dir__ = lazily(  # what many nodes do without
    __name__,
    {
        "Client": "client",
        "GuardCondition": "guard_condition",
        "Rate": "timer",
        "ServiceEndpointInfo": "endpoint_info",
        "Timer": "timer",
        "TopicEndpointInfo": "endpoint_info",
        "Waitable": "waitable",
    },
    (),
    "robolink",
)
MsgType = TypeVar("MsgType")  # names that programs import from here
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")

_number = itertools.count(1).__next__

HIDDEN_NODE_PREFIX = "_"
"""First character of the names of nodes that tools do not list."""

# What Node has beyond rclpy's names is spelled `_so_`, as `enum` does it: a subclass is free to use any other name.


class _OfStore:
    """Attribute of a node's parameter store, read through the node; a value that a subclass assigns hides it."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, node: BaseNode | None, owner: type[BaseNode]) -> Any:
        return self if node is None else getattr(node._parameter_store_, self._name)


class BaseNode(Destroyable):
    """Base of Node and AsyncNode: names, parameters, the graph, and the end.

    A kind of node has `create_publisher` and its sisters, which make entities of its own classes.

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
    """

    _runs_itself_ = False
    """True for a node that runs on an event loop of its own, and that no executor may spin."""

    if TYPE_CHECKING:
        create_publisher: Any
        create_subscription: Any
        create_service: Any

    PARAM_REL_TOL = 1e-6
    """Tolerance of a float towards an end or a step of its range, relative to its size."""

    # rclpy's private names for what the parts have, which programs read.
    _parameters = _OfStore("values")
    _descriptors = _OfStore("descriptors")

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
        base = self._context.arguments if use_global_arguments else Arguments()
        self._arguments_ = base if cli_args is None else parse_arguments(cli_args).over(base)
        self._name_, self._namespace_ = own_name(self._arguments_, node_name, namespace)
        self._init_own_()
        self._init_parameters_(parameter_overrides, allow_undeclared_parameters)
        self._announce_()
        self._context.track_node(self)
        try:
            if enable_rosout and self._arguments_.rosout_logs is not False:
                self._publish_logs_(as_profile(rosout_qos_profile))
            self._context.given_parameters.expect(self, self._arguments_.parameter_overrides)
            events = self.create_publisher(ParameterEvent, "/parameter_events", qos_profile_parameter_events)
            self._parameter_store_.events = events
            events._keeps_ = None  # or the node would be in a circle, and not go once nobody refers to it
            if automatically_declare_parameters_from_overrides:
                self.declare_parameters("", [(name, each.type_) for name, each in self._parameter_overrides.items()])
            self._time_source = TimeSource(node=self)
            self._time_source.attach_clock(self._clock)
            self._serve_(start_parameter_services, enable_logger_service)
        except BaseException:
            self.destroy_node()
            raise

    def _init_own_(self) -> None:
        self._executor_: weakref.ReferenceType[Any] | None = None
        self._is_parked_ = False
        """True while that executor keeps the entities only for the next spin, and the node belongs to none."""
        self._number_ = _number()
        self._was_taken_ = False
        """True once it was spun though another executor has it, and that was warned of."""
        self._turns_: list[Entity] = []
        """Entities whose turn was still to come when the last executor removed this node, in order."""
        self._rosout_: Publisher[Log] | None = None  # not one of the user's: `publishers` does not list it
        self._entity_store_ = store = EntityStore(self)
        self._publishers, self._subscriptions = store.publishers, store.subscriptions
        self._clients, self._services = store.clients, store.services
        self._timers, self._guards = store.timers, store.guards
        self._logger = get_logger(self.get_fully_qualified_name().strip("/").replace("/", "."))
        self._clock = self._make_clock_()

    def _make_clock_(self) -> ROSClock:
        return ROSClock(time_base=self._context.time)

    def _init_parameters_(self, given: list[Parameter[Any]] | None, allow_undeclared: bool) -> None:
        full_name = self.get_fully_qualified_name()
        overrides = overrides_of(self._arguments_, full_name, given or ())
        self._parameter_store_ = store = ParameterStore(
            full_name, self._clock, self._logger, overrides, allow_undeclared, self.PARAM_REL_TOL
        )
        self._parameter_overrides, self._declared_so_far_ = store.overrides, store.declared_so_far
        self._pre_set_parameters_callbacks, self._on_set_parameters_callbacks = store.pre_set, store.on_set
        self._post_set_parameters_callbacks = store.post_set

    def _announce_(self) -> None:
        context = self._context
        enclave = context.transport.enclave or self._arguments_.enclave or "/"
        identity = (context.next_id(), enclave, self._namespace_, self._name_)
        self._owner_ = Owner(context, *identity, Disagreements(self._logger.name))
        token = NodeToken(context.get_domain_id(), context.transport.session_id, *identity)
        self._announced_ = context.graph.announce(token)

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
    def _attached_to_(self) -> Any:
        """The executor (or pump) that the node's entities are attached to: also while it is parked there."""
        return None if self._executor_ is None else self._executor_()

    @property
    def _loop_(self) -> Any:
        """The executor (or pump) that runs the node's callbacks; None while none does."""
        return self._attached_to_

    def _wait_until_(self, holds: Callable[[], bool], timeout_sec: float | None) -> Any:
        """Wait until something holds of the graph; an AsyncNode returns what is to be awaited.

        Args:
            holds: Function that says so.
            timeout_sec: Longest wait in seconds; None waits until the context ends, 0 or less does not wait.
        """
        return self._context.wait_until(holds, timeout_sec)

    def _abandon_(self, future: Future[Any]) -> None:
        """Leave a `future` open whose call was ended with its client, as in rclpy; an AsyncNode cancels it."""

    def _belong_to_(self, executor: Any) -> None:
        """Note the executor that has this node from now on; None for none."""
        self._executor_ = None if executor is None else weakref.ref(executor)

    def get_clock(self) -> Clock:
        """Return the node's clock: a ROSClock, which follows /clock while the parameter `use_sim_time` is true."""
        return self._clock

    def get_logger(self) -> RcutilsLogger:
        """Return the logger with the node's full name, dots for slashes; its lines go to the console and /rosout."""
        return self._logger

    def _in_group_(self, group: CallbackGroup) -> dict[str, Any]:
        """Return the arguments by which this kind of node's `create_...` let a callback run in a group."""
        raise NotImplementedError

    def _group_of_part_(self) -> CallbackGroup:
        """Return the callback group of an action, or of another part of the node, that is given none."""
        raise NotImplementedError

    # Parameters: declaring

    @property
    def _allow_undeclared_parameters(self) -> bool:
        return self._parameter_store_.allows_undeclared

    @_allow_undeclared_parameters.setter
    def _allow_undeclared_parameters(self, is_allowed: bool) -> None:
        self._parameter_store_.allows_undeclared = is_allowed

    @overload
    def declare_parameter(
        self,
        name: str,
        value: Parameter.Type | ParameterValue | None = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]: ...

    @overload
    def declare_parameter(
        self,
        name: str,
        value: AllowableParameterValueT,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[AllowableParameterValueT]: ...

    def declare_parameter(
        self,
        name: str,
        value: AllowableParameterValue = None,
        descriptor: ParameterDescriptor | None = None,
        ignore_override: bool = False,
    ) -> Parameter[Any]:
        """Declare a parameter, and return it as it then is. The on-set and post-set callbacks run.

        Args:
            name: Name of the parameter; dots nest.
            value: Default value: bool, int, float, str, or a list of one of them; a `Parameter.Type` fixes the type
                without a value. The type of the parameter stays what it first is.
            descriptor: Description, range, `read_only`, and `dynamic_typing`, which lets the type change. None
                describes nothing.
            ignore_override: True takes the default value, even if a command line, a file or the node's constructor
                overrides it.

        Raises:
            ParameterAlreadyDeclaredException: if the parameter is declared.
            InvalidParameterException: (a ValueError) if the name is empty.
            InvalidParameterTypeException: (a TypeError) if the override is of another type.
            InvalidParameterValueException: (a ValueError) if a range or an on-set callback refuses the value.
            ValueError: if there is neither value nor type.
            TypeError: if the value is of no parameter's type.
        """
        if value is None and descriptor is None:
            return self._parameter_store_.declare([(name,)], "", ignore_override)[0]
        described = ParameterDescriptor() if descriptor is None else descriptor
        return self._parameter_store_.declare([(name, value, described)], "", ignore_override)[0]

    def declare_parameters(
        self,
        namespace: str,
        parameters: Sequence[tuple[str] | tuple[str, Any] | tuple[str, Any, ParameterDescriptor]],
        ignore_override: bool = False,
    ) -> Parameters:
        """Declare several parameters, and return them as they then are.

        All are checked before the first is declared. If a callback or a range then refuses one, those before it stay
        declared. Raises what `declare_parameter` raises.

        Args:
            namespace: Prefix of all names, without its dot; '' is none.
            parameters: Tuples (name, value) or (name, value, descriptor), as `declare_parameter` takes them.
            ignore_override: True takes the default values, even if they are overridden.
        """
        return self._parameter_store_.declare(parameters, namespace, ignore_override)

    def undeclare_parameter(self, name: str) -> None:
        """Remove the parameter `name`. As in rclpy, no callback is called and no event is sent.

        Raises:
            ParameterNotDeclaredException: if it is not declared.
            ParameterImmutableException: if it is read-only.
        """
        self._parameter_store_.undeclare(name)

    # Parameters: reading

    def has_parameter(self, name: str) -> bool:
        """True if the parameter `name` is declared."""
        return name in self._parameter_store_.values

    def get_parameter(self, name: str) -> Parameter[Any]:
        """Return the parameter `name` as it is now; one without value if undeclared ones are allowed.

        Raises:
            ParameterNotDeclaredException: if it is not declared, and undeclared ones are not allowed.
            ParameterUninitializedException: if it has a static type and no value yet.
        """
        store = self._parameter_store_
        return store.read(name, store.values)

    def get_parameters(self, names: list[str]) -> Parameters:
        """Return the parameters `names` as they are at one moment.

        Raises what `get_parameter` raises, and TypeError if a name is not a str.
        """
        check_names(names)
        store = self._parameter_store_
        values = store.values
        return [store.read(name, values) for name in names]

    def get_parameter_or(self, name: str, alternative_value: Parameter[Any] | None = None) -> Parameter[Any]:
        """Return a parameter, or an alternative if it is undeclared or has no value.

        Args:
            name: Name of the parameter.
            alternative_value: Parameter to return instead; None is one without value.
        """
        parameter = self._parameter_store_.values.get(name)
        if parameter is None or parameter.type_ is Parameter.Type.NOT_SET:
            return Parameter(name) if alternative_value is None else alternative_value
        return parameter

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter[Any]]:
        """Return the parameters below `prefix` by the rest of their names; '' returns all.

        `foo.ping` is `ping` below the prefix `foo`.
        """
        return self._parameter_store_.below(prefix)

    def get_parameter_type(self, name: str) -> Parameter.Type:
        """Return the type of the value of the parameter `name`, NOT_SET while it has none.

        Raises ParameterNotDeclaredException if it is not declared, and undeclared ones are not allowed.
        """
        return self._parameter_store_.type_of(name)

    def get_parameter_types(self, names: list[str]) -> list[Parameter.Type]:
        """Return the types of the parameters `names`. Raises what `get_parameter_type` raises, TypeError for no str."""
        check_names(names)
        return [self.get_parameter_type(name) for name in names]

    def list_parameters(self, prefixes: list[str], depth: int) -> ListParametersResult:
        """Return the names of parameters, and the prefixes of these names.

        Args:
            prefixes: Names of parameters, or what their names begin with (without the dot); none lists all.
            depth: Largest number of dots below a prefix; 0 is any number.

        Raises:
            TypeError: if the arguments are of another type.
            ValueError: if the depth is negative.
        """
        return self._parameter_store_.names(prefixes, depth)

    def describe_parameter(self, name: str) -> ParameterDescriptor:
        """Return the descriptor of the parameter `name`; an empty one if undeclared ones are allowed.

        Raises ParameterNotDeclaredException if it is not declared, and undeclared ones are not allowed.
        """
        return self._parameter_store_.describe(name)

    def describe_parameters(self, names: list[str]) -> list[ParameterDescriptor]:
        """Return the descriptors of the parameters `names`. Raises what `describe_parameter` raises."""
        return [self.describe_parameter(name) for name in names]

    # Parameters: setting

    def set_parameters(self, parameter_list: Parameters) -> list[SetParametersResult]:
        """Set parameters one after another, and return a result for each: successful or not, and the reason.

        Args:
            parameter_list: Parameters to set; one of the type NOT_SET undeclares a parameter whose type is dynamic.

        Raises:
            ParameterNotDeclaredException: at the first that is undeclared, if that is not allowed: those before it
                are set then, the rest is not.
        """
        return [self._parameter_store_.set_atomically([parameter]) for parameter in parameter_list]

    def set_parameters_atomically(self, parameter_list: Parameters) -> SetParametersResult:
        """Set all these parameters, or none, in one step with one event and one call of each callback.

        Args:
            parameter_list: Parameters to set; one of the type NOT_SET undeclares a parameter whose type is dynamic.

        Returns:
            A result: successful or not, and the reason.

        Raises:
            ParameterNotDeclaredException: if one is undeclared, and that is not allowed.
            InvalidParameterException: (a ValueError) if a name is empty.
        """
        return self._parameter_store_.set_atomically(parameter_list)

    def set_descriptor(
        self, name: str, descriptor: ParameterDescriptor, alternative_value: ParameterValue | None = None
    ) -> ParameterValue:
        """Replace the descriptor of a parameter. As in rclpy, no callback runs and no event is sent.

        Args:
            name: Name of the parameter.
            descriptor: New descriptor; the name in it does not count.
            alternative_value: Value for the parameter if its own does not fit the descriptor; None is none.

        Returns:
            The value that the parameter then has.

        Raises:
            ParameterNotDeclaredException: if it is not declared, and undeclared ones are not allowed.
            ParameterImmutableException: if it is read-only.
            InvalidParameterValueException: (a ValueError) if neither value fits.
        """
        return self._parameter_store_.set_descriptor(name, descriptor, alternative_value)

    def add_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Add a `callback` that returns the list of parameters to set in place of the given one, before all checks.

        The latest added is called first; their lists are joined. Declaring does not call it.
        """
        self._parameter_store_.pre_set.insert(0, callback)

    def add_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Add a `callback` that decides if parameters may be set or declared; the latest added is called first.

        It gets the list of parameters and returns a SetParametersResult, which refuses them by `successful=False` with
        the reason. Names that it does not know it should let pass: other parts of the node may know them.
        """
        self._parameter_store_.on_set.insert(0, callback)

    def add_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Add a `callback` for parameters that have been set or declared; the latest added is called first."""
        self._parameter_store_.post_set.insert(0, callback)

    def remove_pre_set_parameters_callback(self, callback: PreSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._parameter_store_.pre_set.remove(callback)

    def remove_on_set_parameters_callback(self, callback: OnSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._parameter_store_.on_set.remove(callback)

    def remove_post_set_parameters_callback(self, callback: PostSetCallback) -> None:
        """Remove a `callback`. Raises ValueError if it was not added."""
        self._parameter_store_.post_set.remove(callback)

    # Entities: listing and destroying

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """Publishers of the node."""
        yield from self._entity_store_.publishers

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """Subscriptions of the node."""
        yield from self._entity_store_.subscriptions

    @property
    def clients(self) -> Iterator[BaseClient]:
        """Clients of the node."""
        yield from self._entity_store_.clients

    @property
    def services(self) -> Iterator[Service]:
        """Services of the node."""
        yield from self._entity_store_.services

    @property
    def timers(self) -> Iterator[Timer]:
        """Timers of the node."""
        yield from self._entity_store_.timers

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """Guard conditions of the node."""
        yield from self._entity_store_.guards

    @property
    def waitables(self) -> Iterator[Waitable]:
        """Waitables of the node, each of several entities: its actions."""
        yield from self._entity_store_.waitables

    def add_waitable(self, waitable: Waitable) -> None:
        """Add a `waitable`: the node's executor runs its entities, and the node destroys it."""
        self._entity_store_.add_waitable(waitable)

    def remove_waitable(self, waitable: Waitable) -> None:
        """Remove a `waitable`, without destroying it."""
        self._entity_store_.remove_waitable(waitable)

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a `publisher`; False if it is none of this node's."""
        return destroy(publisher, self._entity_store_.publishers)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a `subscription`; False if it is none of this node's."""
        return destroy(subscription, self._entity_store_.subscriptions)

    def destroy_client(self, client: BaseClient) -> bool:
        """Destroy a `client`; False if it is none of this node's."""
        return destroy(client, self._entity_store_.clients)

    def destroy_service(self, service: Service) -> bool:
        """Destroy a `service`; False if it is none of this node's."""
        return destroy(service, self._entity_store_.services)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a `timer`; False if it is none of this node's."""
        return destroy(timer, self._entity_store_.timers)

    # The graph

    @property
    def _graph_(self) -> Graph:
        """The graph as it is known now. Raises InvalidHandle once the node has been destroyed."""
        self._check_("node")
        return self._context.graph

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """Return all topics, each with its types such as `std_msgs/msg/String`.

        `no_demangle` is rclpy's and changes nothing: names are not mangled on this wire.
        """
        return names_and_types(self._graph_.endpoints(EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION))

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Return all services that are served or called, each with its types."""
        # Those that are only called too, as rmw_zenoh's graph lists them.
        return names_and_types(self._graph_.endpoints(EndpointKind.SERVICE, EndpointKind.CLIENT))

    def get_node_names(self) -> list[str]:
        """Return the names of all nodes, without namespaces."""
        return [each.node_name for each in self._graph_.nodes()]

    def get_fully_qualified_node_names(self) -> list[str]:
        """Return the fully qualified names of all nodes."""
        return [each.full_node_name for each in self._graph_.nodes()]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return name and namespace of each node."""
        return [(each.node_name, each.namespace) for each in self._graph_.nodes()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return name, namespace and enclave of each node."""
        return [(each.node_name, each.namespace, each.enclave) for each in self._graph_.nodes()]

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node publishes, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.
            no_demangle: rclpy's; changes nothing, since names are not mangled on this wire.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return of_node(self._graph_, node_name, node_namespace, EndpointKind.PUBLISHER)

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node subscribes to, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.
            no_demangle: rclpy's; changes nothing, since names are not mangled on this wire.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return of_node(self._graph_, node_name, node_namespace, EndpointKind.SUBSCRIPTION)

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services that a node serves, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return of_node(self._graph_, node_name, node_namespace, EndpointKind.SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services that a node calls, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        return of_node(self._graph_, node_name, node_namespace, EndpointKind.CLIENT)

    def get_action_names_and_types(self) -> NamesAndTypes:
        """Return all actions that have a server or a client, each with its types."""
        return actions(self.get_service_names_and_types(), self.get_topic_names_and_types())

    def get_action_server_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the actions that a node serves, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        remote = node_name, node_namespace
        return actions(
            self.get_service_names_and_types_by_node(*remote), self.get_publisher_names_and_types_by_node(*remote)
        )

    def get_action_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the actions of which a node is a client, each with its types.

        Args:
            node_name: Name of the node, without namespace.
            node_namespace: Its namespace, '/' for the root.

        Raises:
            NodeNameNonExistentError: (a RuntimeError) if there is no such node.
        """
        remote = node_name, node_namespace
        return actions(
            self.get_client_names_and_types_by_node(*remote), self.get_subscriber_names_and_types_by_node(*remote)
        )

    def get_publishers_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return all publishers of a topic, each with its node, type, hash, gid and profile.

        Args:
            topic_name: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        name = topic_name if no_mangle else self.resolve_topic_name(topic_name)
        return endpoints_of_topic(self._graph_, name, EndpointKind.PUBLISHER)

    def get_subscriptions_info_by_topic(self, topic_name: str, no_mangle: bool = False) -> list[TopicEndpointInfo]:
        """Return all subscriptions of a topic, each with its node, type, hash, gid and profile.

        Args:
            topic_name: Name of the topic, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidTopicNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        name = topic_name if no_mangle else self.resolve_topic_name(topic_name)
        return endpoints_of_topic(self._graph_, name, EndpointKind.SUBSCRIPTION)

    def get_servers_info_by_service(self, service_name: str, no_mangle: bool = False) -> list[ServiceEndpointInfo]:
        """Return all servers of a service, each with its node, type, hash, gid and profile.

        Args:
            service_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        name = service_name if no_mangle else self.resolve_service_name(service_name)
        return endpoints_of_service(self._graph_, name, EndpointKind.SERVICE)

    def get_clients_info_by_service(self, service_name: str, no_mangle: bool = False) -> list[ServiceEndpointInfo]:
        """Return all clients of a service, each with its node, type, hash, gid and profile.

        Args:
            service_name: Name of the service, relative to the node's namespace unless it begins with a slash; remapped.
            no_mangle: True takes the name as it stands.

        Raises:
            InvalidServiceNameException: (a ValueError) if the name is against ROS 2's rules.
        """
        name = service_name if no_mangle else self.resolve_service_name(service_name)
        return endpoints_of_service(self._graph_, name, EndpointKind.CLIENT)

    def count_publishers(self, topic_name: str) -> int:
        """Return the number of publishers of the topic `topic_name`, of any type."""
        return self._graph_.count(EndpointKind.PUBLISHER, self.resolve_topic_name(topic_name))

    def count_subscribers(self, topic_name: str) -> int:
        """Return the number of subscriptions of the topic `topic_name`, of any type."""
        return self._graph_.count(EndpointKind.SUBSCRIPTION, self.resolve_topic_name(topic_name))

    def count_services(self, service_name: str) -> int:
        """Return the number of servers of the service `service_name`, of any type."""
        return self._graph_.count(EndpointKind.SERVICE, self.resolve_service_name(service_name))

    def count_clients(self, service_name: str) -> int:
        """Return the number of clients of the service `service_name`, of any type."""
        return self._graph_.count(EndpointKind.CLIENT, self.resolve_service_name(service_name))

    # The end

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
        self._entity_store_.destroy()
        self._announced_.close()
        self._context.untrack_node(self)

    def __del__(self) -> None:
        """Leave the graph, as in rclpy, once nobody refers to the node any more; not where runs are to repeat.

        That is in a thread of its own, since garbage is collected anywhere: this one may hold any lock.
        """
        context: Context | None = vars(self).get("_context")
        if context is None or self._destroyed or "_announced_" not in vars(self):
            return
        context.given_parameters.look(self)  # takes no lock; else what it declared would count as never declared
        if not context.ok() or not context.transport.threaded:
            return
        with contextlib.suppress(RuntimeError):  # Python ends, or there are too many threads
            _thread.start_new_thread(BaseNode.destroy_node, (self,))

    if not TYPE_CHECKING:  # or every attribute would be one of mypy's

        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") and "_context" not in vars(self):
                text = f"{type(self).__name__} is not a node yet: call super().__init__('NAME') first"
                raise AttributeError(text, name="", obj=None)  # else Python would advise another name of ours
            return super().__getattribute__(name)  # which says what Python says


class Node(BaseNode):
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

    def _init_own_(self) -> None:
        super()._init_own_()
        self._default_callback_group: CallbackGroup = MutuallyExclusiveCallbackGroup()
        self._rate_group = ReentrantCallbackGroup()

    def _in_group_(self, group: CallbackGroup) -> dict[str, Any]:
        return {"callback_group": group}

    def _group_of_part_(self) -> CallbackGroup:
        return self.default_callback_group

    @property
    def _loop_(self) -> Executor | None:
        return self.executor

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

    # Entities: creating

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
        group = callback_group or self._default_callback_group
        args = msg_type, topic, qos_profile, group, event_callbacks, qos_overriding_options
        return make_publisher(self, publisher_class, *args)

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
        more = raw, content_filter_options, event_callbacks, qos_overriding_options
        return make_subscription(self, Subscription, msg_type, topic, callback, qos_profile, group, *more)

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
        return make_service(self, Service, srv_type, srv_name, callback, qos_profile, group)

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
        from robolink.client import Client  # late, as timers are: many nodes have none

        group = callback_group or self._default_callback_group
        return make_client(self, Client, srv_type, srv_name, qos_profile, group)

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
        from robolink.timer import Timer, period_ns

        group = callback_group or self._default_callback_group
        period = period_ns(timer_period_sec)
        timer = Timer(callback, group, period, clock or self._clock, context=self._context, autostart=autostart)
        return self._entity_store_.add(timer, self._entity_store_.timers)

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
        from robolink.guard_condition import GuardCondition

        group = callback_group or self._default_callback_group
        return self._entity_store_.add(
            GuardCondition(callback, group, context=self._context), self._entity_store_.guards
        )

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate, whose `sleep` waits for the rest of each period.

        Args:
            frequency: Ticks per second (Hz), above 0.
            clock: Clock that the period is measured by; None is the node's clock.

        Raises:
            ValueError: if the frequency is not above 0.
            InvalidHandle: (a RuntimeError) if the node has been destroyed.
        """
        from robolink.timer import Rate

        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        timer = self.create_timer(1.0 / frequency, _until_its_rate, callback_group=self._rate_group, clock=clock)
        return Rate(timer, context=self._context)

    # Entities: destroying

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition, `guard`; False if it is none of this node's."""
        return destroy(guard, self._entity_store_.guards)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a `rate`; False if it is none of this node's."""
        found = self.destroy_timer(rate._timer)
        rate.destroy()
        return found

    # Waiting, and the end

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float) -> bool:
        """Wait until a node is in the graph, or the context ends.

        Args:
            fully_qualified_node_name: Namespace and name of the node; a missing leading slash is added.
            timeout: Longest wait in seconds; negative waits for ever, 0 does not wait.

        Returns:
            True if the node is there.
        """
        namespace, _, name = ("/" + fully_qualified_node_name.lstrip("/")).rpartition("/")
        graph = self._graph_
        limit = None if timeout < 0 else timeout
        return self._context.wait_until(lambda: graph.has_node(name, namespace or "/"), limit)

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _until_its_rate() -> None:
    """Do nothing when a rate's timer is due before there is the rate."""
